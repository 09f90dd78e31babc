#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "base/error.h"
#include "base/require_setting.h"
#include "base/tiny.h"
#include "servodx/join.h"
#include "servodx/log.h"
#include "signals/constants.h"
#include "signals/signal.h"
#include "signals/usual_step.h"

namespace servodx {
namespace {

using namespace signals_constants;

// A series that can be asked at any time; missing samples are bridged.
class Series {
 public:
  Series(const std::vector<double>& time, const std::vector<double>& value) {
    for (std::size_t k = 0; k < time.size(); ++k)
      if (!std::isnan(value[k])) t_.push_back(time[k]), x_.push_back(value[k]);
  }
  double begin() const { return t_.front(); }
  double end() const { return t_.back(); }
  double at(double t) const {
    const std::size_t k = interval(t);
    return x_[k] + (x_[k + 1] - x_[k]) * (t - t_[k]) / (t_[k + 1] - t_[k]);
  }
  const std::vector<double>& time() const { return t_; }
  const std::vector<double>& value() const { return x_; }

 private:
  std::size_t interval(double t) const {
    const auto it = std::upper_bound(t_.begin(), t_.end(), t);
    const auto k = std::max<long>(it - t_.begin() - 1, 0);
    return std::min(static_cast<std::size_t>(k), t_.size() - 2);
  }
  std::vector<double> t_, x_;
};

// Increments on an even grid: what two recordings of one signal share whatever their bias.
std::vector<double> increments(const Series& s, double from, double to, double step) {
  std::vector<double> d;
  double last = s.at(from);
  for (double t = from + step; t <= to; t += step) {
    const double x = s.at(t);
    d.push_back(x - last);
    last = x;
  }
  return d;
}

struct Lag {
  long samples = 0;
  double correlation = -1;  // normalised over the overlap
  double rival = -1;        // the best apart from it
  long rival_samples = 0;
};

// The shift of `piece` along `whole` that fits best, within [from, to] samples.
Lag best_lag(const std::vector<double>& whole, const std::vector<double>& piece, long from, long to, long apart) {
  const long n = static_cast<long>(whole.size()), m = static_cast<long>(piece.size());
  from = std::max(from, 0L), to = std::min(to, n - m);
  Lag best;
  if (from > to || m < 16) return best;
  long size = 1;
  while (size < n + m) size *= 2;
  std::vector<double> a(size, 0.0), b(size, 0.0), c;
  std::copy(whole.begin(), whole.end(), a.begin());
  std::copy(piece.begin(), piece.end(), b.begin());
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> fa, fb;
  fft.fwd(fa, a);
  fft.fwd(fb, b);
  for (std::size_t k = 0; k < fa.size(); ++k) fa[k] *= std::conj(fb[k]);
  fft.inv(c, fa);
  std::vector<double> energy(n + 1, 0.0);
  for (long k = 0; k < n; ++k) energy[k + 1] = energy[k] + whole[k] * whole[k];
  double own = 0;
  for (double x : piece) own += x * x;
  const auto score = [&](long lag) {
    const double there = energy[lag + m] - energy[lag];
    return there > 1e-3 * own && own > 0 ? c[lag] / std::sqrt(there * own) : -1.0;
  };
  for (long lag = from; lag <= to; ++lag)
    if (const double s = score(lag); s > best.correlation) best.samples = lag, best.correlation = s;
  for (long lag = from; lag <= to; ++lag)
    if (std::abs(lag - best.samples) > apart)
      if (const double s = score(lag); s > best.rival) best.rival = s, best.rival_samples = lag;
  return best;
}

struct Piece {
  double at;      // [s] second's clock, middle
  double offset;  // [s] first's time less second's there
};

// Least squares of the first's samples within [from, to] of its clock. `delay` and `skew` are about the time `middle`
// of the second's clock: t1 = t2 + delay + skew (t2 - middle). Free: delay, gain, bias, and the skew where asked for.
struct Alignment {
  double delay = 0, skew = 0, correlation = 0;
};
Alignment align(const Series& first, const Series& second, double from, double to, double middle, Alignment a,
                bool free_skew) {
  const double h = 0.5 * usual_step(second.time());
  const auto& t = first.time();
  const auto begin = std::lower_bound(t.begin(), t.end(), from) - t.begin();
  const auto end = std::upper_bound(t.begin(), t.end(), to) - t.begin();
  for (int iteration = 0; iteration < 12; ++iteration) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0, n = 0;
    for (long k = begin; k < end; ++k) {
      const double t2 = middle + (t[k] - a.delay - middle) / (1 + a.skew);
      if (t2 < second.begin() + h || t2 > second.end() - h) continue;
      const double x = second.at(t2), slope = (second.at(t2 + h) - second.at(t2 - h)) / (2 * h);
      const Eigen::Vector4d row(1, x, -slope, free_skew ? -slope * (t2 - middle) : 0.0);
      const double y = first.value()[k];
      normal += row * row.transpose();
      right += row * y;
      sx += x, sy += y, sxx += x * x, syy += y * y, sxy += x * y, ++n;
    }
    if (n < 16 || !(sxx - sx * sx / n > 0) || !(syy - sy * sy / n > 0)) return a;
    a.correlation = (sxy - sx * sy / n) / std::sqrt((sxx - sx * sx / n) * (syy - sy * sy / n));
    if (!free_skew) normal(3, 3) = 1;
    const Eigen::Vector4d scale = normal.diagonal().cwiseSqrt().cwiseMax(tiny);
    const Eigen::Matrix4d scaled = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
    const Eigen::Vector4d solution =
        scale.cwiseInverse().asDiagonal() * scaled.ldlt().solve(scale.cwiseInverse().asDiagonal() * right);
    const double gain = solution[1];
    if (!(std::abs(gain) > 0)) return a;
    // Steps of half a sample at most: the slope is that of a straight line between samples.
    const double step = std::clamp(solution[2] / gain, -h, h);
    const double turn = std::clamp(solution[3] / gain, -0.1 * largest_skew, 0.1 * largest_skew);
    a.delay += step;
    a.skew += turn;
    if (std::abs(step) < 1e-9 && std::abs(turn) < 1e-10) break;
  }
  return a;
}

[[noreturn]] void refuse(const Log& second, const std::string& rule, const std::string& mend) {
  throw InputError({second.path, 0, ""}, rule, mend);
}

// The second recorder's pieces, overlapping, and the increments of the first that they are looked for in.
struct Pieces {
  double length = 0, step = 0;                // [s] of a piece; of the even grid
  double whole_from = 0;                      // [s] first's clock, where `whole` begins
  std::vector<double> whole;                  // increments of the first
  std::vector<double> starts;                 // [s] second's clock
  std::vector<std::vector<double>> contents;  // increments, a piece each
  std::size_t liveliest = 0;

  double middle(std::size_t k) const { return starts[k] + 0.5 * length; }
  long lag_of(double offset, std::size_t k) const { return std::lround((starts[k] + offset - whole_from) / step); }
  double offset_of(long lag, std::size_t k) const { return whole_from + static_cast<double>(lag) * step - starts[k]; }
};

Pieces cut_into_pieces(const Series& first, const Series& second, double step) {
  Pieces p;
  p.step = step;
  p.length = std::min(piece_time, 0.5 * std::min(first.end() - first.begin(), second.end() - second.begin()));
  p.whole_from = first.begin();
  p.whole = increments(first, first.begin(), first.end(), step);
  const double span = second.end() - second.begin() - p.length;
  const int count = std::clamp(static_cast<int>(span / (0.5 * p.length)) + 1, 2, most_pieces);
  for (int k = 0; k < count; ++k) p.starts.push_back(second.begin() + span * k / (count - 1));
  double most = -1;
  for (std::size_t k = 0; k < p.starts.size(); ++k) {
    p.contents.push_back(increments(second, p.starts[k], p.starts[k] + p.length, step));
    double energy = 0;
    for (double x : p.contents.back()) energy += x * x;
    // Not at the ends, where the first may not have run.
    const bool inner = k > 0 && k + 1 < p.starts.size();
    if (energy * (inner ? 1.0 : 0.5) > most) most = energy * (inner ? 1.0 : 0.5), p.liveliest = k;
  }
  return p;
}

// Where the liveliest piece lies in the whole, looked for everywhere, or near where the caller says. [samples]
long place_liveliest(const Pieces& p, const std::string& name, const Log& two, const JoinOptions& options) {
  const long apart = std::max(4L, std::lround(0.05 / p.step));
  long from = 0, to = static_cast<long>(p.whole.size());
  if (options.near) {
    const double at = *options.near, width = options.near_within;
    from = p.lag_of(at - width, p.liveliest), to = p.lag_of(at + width, p.liveliest);
  }
  const Lag lag = best_lag(p.whole, p.contents[p.liveliest], from, to, apart);
  if (lag.correlation < least_correlation)
    refuse(two,
           fmt::format("the two recordings of '{}' are not alike: correlation {:.2f} at best", name, lag.correlation),
           "name another shared signal with --by, or check that both are of one test");
  if (lag.rival > rival * lag.correlation)
    refuse(two,
           fmt::format("'{}' repeats itself: offsets of {:.4g} s and {:.4g} s fit alike", name,
                       p.offset_of(lag.samples, p.liveliest), p.offset_of(lag.rival_samples, p.liveliest)),
           "give the offset roughly with --near, or name another shared signal with --by");
  return lag.samples;
}

// From the liveliest outwards, each piece near where its neighbour was.
std::vector<Piece> follow_outwards(const Pieces& p, long liveliest_lag) {
  std::vector<Piece> found;
  const auto track = [&](std::size_t k, double offset) {
    const long expected = p.lag_of(offset, k);
    const long reach = std::lround(largest_skew * p.length / p.step) + 3;
    const Lag l = best_lag(p.whole, p.contents[k], expected - reach, expected + reach, 1L << 40);
    if (l.correlation < least_correlation) return offset;
    found.push_back({p.middle(k), p.offset_of(l.samples, k)});
    return found.back().offset;
  };
  double offset = track(p.liveliest, p.offset_of(liveliest_lag, p.liveliest));
  for (std::size_t k = p.liveliest + 1; k < p.starts.size(); ++k) offset = track(k, offset);
  offset = p.offset_of(liveliest_lag, p.liveliest);
  for (std::size_t k = p.liveliest; k-- > 0;) offset = track(k, offset);
  return found;
}

double mean_time(const std::vector<Piece>& pieces) {
  double middle = 0;
  for (const Piece& p : pieces) middle += p.at / static_cast<double>(pieces.size());
  return middle;
}

// A straight line through the pieces' offsets, about their mean time.
Alignment line_through(const std::vector<Piece>& found, double middle) {
  double sum = 0, sum_tt = 0, sum_to = 0;
  for (const Piece& p : found)
    sum += p.offset, sum_tt += std::pow(p.at - middle, 2), sum_to += (p.at - middle) * p.offset;
  return {sum / static_cast<double>(found.size()), found.size() > 2 ? sum_to / sum_tt : 0.0, 0};
}

// Each piece alone, by its own delay, less what the common line says of it: their scatter is the error.
std::vector<Piece> scatter_about(const Series& first, const Series& second, const std::vector<Piece>& found,
                                 double middle, double length, const Alignment& common) {
  std::vector<Piece> apart;
  for (const Piece& p : found) {
    Alignment own{common.delay + common.skew * (p.at - middle), common.skew, 0};
    const double at = p.at + own.delay;
    own = align(first, second, at - 0.5 * length, at + 0.5 * length, p.at, own, false);
    if (own.correlation > least_correlation)
      apart.push_back({p.at, own.delay - common.delay - common.skew * (p.at - middle)});
  }
  return apart;
}

ClockFit clock_of(const Alignment& a, double middle, const std::vector<Piece>& apart, Signal by) {
  double scatter = 0, spread = 0;
  for (const Piece& p : apart) scatter += p.offset * p.offset, spread += std::pow(p.at - middle, 2);
  // Pieces overlap by half, so half of them are independent; two numbers are fitted.
  const double independent = 0.5 * static_cast<double>(apart.size());
  ClockFit clock;
  clock.by = by;
  clock.pieces = static_cast<int>(apart.size());
  clock.skew = a.skew;
  clock.offset = a.delay - a.skew * middle;
  const double variance =
      independent > 2 ? scatter / static_cast<double>(apart.size()) * independent / (independent - 2) : std::nan("");
  clock.offset_error = std::sqrt(variance / independent);
  clock.skew_error = spread > 0 ? std::sqrt(variance / (0.5 * spread)) : std::nan("");
  clock.correlation = a.correlation;
  return clock;
}

ClockFit fit_clock(const Log& one, const Log& two, Signal by, const JoinOptions& options) {
  const Series first(one.time, one[by]), second(two.time, two[by]);
  const Pieces pieces = cut_into_pieces(first, second, std::max(usual_step(one.time), usual_step(two.time)));
  const long lag = place_liveliest(pieces, std::string(name_of(by)), two, options);
  const std::vector<Piece> found = follow_outwards(pieces, lag);
  const double middle = mean_time(found);
  const auto align_all = [&](const Alignment& from) {
    return align(first, second, first.begin(), first.end(), middle, from, true);
  };
  Alignment a = align_all(line_through(found, middle));
  const std::vector<Piece> apart = scatter_about(first, second, found, middle, pieces.length, a);
  if (static_cast<int>(apart.size()) < fewest_pieces && found.size() > 1) a = align_all({a.delay, a.skew, 0});
  return clock_of(a, middle, apart, by);
}

bool is_demand(Signal s) { return s == Signal::command || s == Signal::setpoint; }

}  // namespace

void JoinOptions::validate() const {
  require_setting(by != Signal::time, "--by", "each recorder has a time of its own",
                  "name another signal that both recorded");
  require_setting(std::isfinite(near.value_or(0)), "--near", fmt::format("{} s is no offset", near.value_or(0)),
                  "give it in seconds: 1.5");
  require_setting(std::isfinite(near_within) && near_within > 0, "JoinOptions.near_within",
                  fmt::format("{} s is no distance", near_within),
                  fmt::format("{} is the default", JoinOptions{}.near_within));
}

Log join_recorders(const Log& first, const Log& second, const JoinOptions& options, ClockFit& clock) {
  options.validate();
  std::vector<Signal> shared;
  for (const SignalInfo& signal : signal_list)
    if (signal.signal != Signal::time && first.has(signal.signal) && second.has(signal.signal))
      shared.push_back(signal.signal);
  if (shared.empty())
    refuse(second, "shares no signal with " + first.path,
           "record one signal on both, such as the command, and map it in [columns] of the rig file");
  if (options.by && std::find(shared.begin(), shared.end(), *options.by) == shared.end())
    refuse(second, fmt::format("'{}' is not in both logs", info(*options.by).name),
           "name with --by a signal that both recorded");
  if (options.by) shared = {*options.by};
  std::optional<InputError> why;
  std::optional<ClockFit> best;
  for (Signal by : shared) {
    try {
      const ClockFit fit = fit_clock(first, second, by, options);
      const auto worse = [&] { return std::isnan(best->offset_error) || fit.offset_error < best->offset_error; };
      if (!best || worse()) best = fit;
    } catch (const InputError& error) {
      if (!why) why = error;
    }
  }
  if (!best) throw *why;
  clock = *best;

  // The second's times on the first's clock.
  std::vector<double> mapped;
  for (double t : second.time) mapped.push_back(clock.offset + (1 + clock.skew) * t);
  const double usual = usual_step(mapped);
  const auto& t = first.time;
  const auto begin = std::lower_bound(t.begin(), t.end(), mapped.front()) - t.begin();
  const auto end = std::upper_bound(t.begin(), t.end(), mapped.back()) - t.begin();
  Log out = first;
  const auto cut = [&](std::vector<double>& x) {
    if (!x.empty()) x = std::vector<double>(x.begin() + begin, x.begin() + end);
  };
  cut(out.time);
  for (Channel& c : out.channels) cut(c.value);
  for (const SignalInfo& signal : signal_list) {
    const Signal s = signal.signal;
    if (s == Signal::time || first.has(s) || !second.has(s)) continue;
    Channel& channel = out.channels[index(s)] = second.channels[index(s)];
    const std::vector<double>& x = second[s];
    channel.value.assign(out.time.size(), std::nan(""));
    channel.missing = 0;
    std::size_t j = 0;
    for (std::size_t k = 0; k < out.time.size(); ++k) {
      while (j + 2 < mapped.size() && mapped[j + 1] <= out.time[k]) ++j;
      const double width = mapped[j + 1] - mapped[j], part = (out.time[k] - mapped[j]) / width;
      if (width > far_apart * usual)
        channel.value[k] = part <= 0 ? x[j] : part >= 1 ? x[j + 1] : std::nan("");
      else
        channel.value[k] = is_demand(s) ? (part >= 1 ? x[j + 1] : x[j]) : x[j] + part * (x[j + 1] - x[j]);
      channel.missing += std::isnan(channel.value[k]);
    }
  }
  out.notes.insert(out.notes.end(), second.notes.begin(), second.notes.end());
  return out;
}

}  // namespace servodx
