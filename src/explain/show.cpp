#include "explain/show.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "base/tiny.h"
#include "base/two_pi.h"
#include "explain/constants.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "optimise/unit_cube.h"
#include "servodx/log.h"
#include "signals/signal.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

using namespace explain_constants::shown;

struct Piece {  // one log's part of a channel
  std::vector<double> time, residual, command;
  std::vector<std::pair<std::string, std::vector<double>>> inputs;
  std::vector<std::pair<std::string, std::vector<double>>> variables;  // "name|unit"
  std::vector<double> since_reversal, since_jump;                      // [s]
};

double step_of(const Piece& p) { return (p.time.back() - p.time.front()) / static_cast<double>(p.time.size() - 1); }

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) d[k] = a[k] - b[k];
  return d;
}

// Time since `happens` was last true; long before the first time.
template <class F>
std::vector<double> since(const std::vector<double>& time, F happens) {
  std::vector<double> out(time.size(), 1e9);
  double last = -1e9;
  for (std::size_t k = 1; k < time.size(); ++k) {
    if (happens(k)) last = time[k];
    out[k] = time[k] - last;
  }
  return out;
}

std::vector<double> without_mean(std::vector<double> x) {
  double sum = 0, n = 0;
  for (double v : x)
    if (std::isfinite(v)) sum += v, ++n;
  for (double& v : x) v = std::isfinite(v) ? v - sum / std::max(1.0, n) : 0.0;
  return x;
}

// Cross- and auto-spectra of half-overlapping Hann windows, summed over all pieces.
struct Welch {
  static constexpr int length = spectrum_samples;
  std::vector<double> xx = std::vector<double>(length / 2, 0), yy = xx;
  std::vector<std::complex<double>> xy = std::vector<std::complex<double>>(length / 2);
  double windows = 0, dt = 1e-3;
  void add(const std::vector<double>& x, const std::vector<double>& y, double step) {
    dt = step;
    for (std::size_t first = 0; first + length <= x.size(); first += length / 2, ++windows)
      for (int f = 0; f < length / 2; ++f) {
        std::complex<double> a, b;
        const std::complex<double> turn = std::polar(1.0, -two_pi * f / length);
        std::complex<double> w = 1;
        for (int k = 0; k < length; ++k, w *= turn) {
          const double hann = 0.5 - 0.5 * std::cos(two_pi * (k + 0.5) / length);
          a += hann * x[first + static_cast<std::size_t>(k)] * w;
          b += hann * y[first + static_cast<std::size_t>(k)] * w;
        }
        const auto i = static_cast<std::size_t>(f);
        xx[i] += std::norm(a), yy[i] += std::norm(b), xy[i] += a * std::conj(b);
      }
  }
  double frequency(int f) const { return f / (length * dt); }
};

InputCorrelation correlate(const std::string& name, const std::vector<Piece>& pieces, std::size_t input) {
  InputCorrelation best{name, 0, 0, 0};
  double n = 0;
  std::vector<double> sum(lags + 1, 0);
  double rr = 0, uu = 0, dt = 1e-3;
  for (const Piece& p : pieces) {
    if (input >= p.inputs.size()) continue;
    const std::vector<double> r = without_mean(p.residual), u = without_mean(p.inputs[input].second);
    n += static_cast<double>(r.size());
    for (std::size_t k = 0; k < r.size(); ++k) rr += r[k] * r[k], uu += u[k] * u[k];
    for (int lag = 0; lag <= lags; ++lag)
      for (std::size_t k = static_cast<std::size_t>(lag); k < r.size(); ++k)
        sum[static_cast<std::size_t>(lag)] += r[k] * u[k - static_cast<std::size_t>(lag)];
    dt = step_of(p);
  }
  best.band = white_band / std::sqrt(std::max(1.0, n));
  if (rr <= 0 || uu <= 0) return best;
  for (int lag = 0; lag <= lags; ++lag) {
    const double c = sum[static_cast<std::size_t>(lag)] / std::sqrt(rr * uu);
    if (std::abs(c) > std::abs(best.correlation)) best.correlation = c, best.lag = lag * dt;
  }
  return best;
}

ResidualMap map_of(const std::string& name, const std::vector<Piece>& pieces, std::size_t variable, double noise) {
  ResidualMap out{name.substr(0, name.find('|')), name.substr(name.find('|') + 1), {}};
  std::vector<std::pair<double, double>> points;  // variable, residual
  double total = 0;
  for (const Piece& p : pieces) {
    if (variable >= p.variables.size()) continue;
    const auto& v = p.variables[variable].second;
    for (std::size_t k = 0; k < v.size(); ++k)
      if (std::isfinite(v[k]) && std::isfinite(p.residual[k])) {
        points.push_back({v[k], p.residual[k]});
        total += std::max(0.0, p.residual[k] * p.residual[k] - noise * noise);
      }
  }
  std::sort(points.begin(), points.end());
  for (std::size_t b = 0; b < map_parts && points.size() >= map_parts; ++b) {
    const std::size_t from = b * points.size() / map_parts, to = (b + 1) * points.size() / map_parts;
    MapBin bin{points[from].first, points[to - 1].first};
    for (std::size_t k = from; k < to; ++k) {
      const double r = points[k].second;
      bin.mean += r, bin.rms += r * r, bin.excess += std::max(0.0, r * r - noise * noise);
    }
    const auto n = static_cast<double>(to - from);
    bin.mean /= n, bin.rms = std::sqrt(bin.rms / n);
    bin.time = n / static_cast<double>(points.size());
    bin.excess = total > 0 ? bin.excess / total : 0;
    out.bins.push_back(bin);
  }
  return out;
}

ExcessPlace place_of_excess(const std::vector<Piece>& pieces, const std::vector<ResidualMap>& maps, double noise) {
  double total = 0, n = 0, at_reversal = 0, t_reversal = 0, at_jump = 0, t_jump = 0;
  for (const Piece& p : pieces)
    for (std::size_t k = 0; k < p.residual.size(); ++k) {
      if (!std::isfinite(p.residual[k])) continue;
      const double e = std::max(0.0, p.residual[k] * p.residual[k] - noise * noise);
      total += e, ++n;
      if (p.since_reversal[k] < near_event) at_reversal += e, ++t_reversal;
      if (p.since_jump[k] < near_event) at_jump += e, ++t_jump;
    }
  if (total <= 0 || n == 0) return {};
  using Kind = ExcessPlace::Kind;
  std::vector<ExcessPlace> places = {{Kind::near_reversal, {}, at_reversal / total, t_reversal / n},
                                     {Kind::near_jump, {}, at_jump / total, t_jump / n}};
  for (const ResidualMap& m : maps) {
    if (m.bins.empty()) continue;
    for (const auto& [bin, kind] :
         {std::pair{m.bins.front(), Kind::lowest_part}, std::pair{m.bins.back(), Kind::highest_part}})
      if (bin.time > 0) places.push_back({kind, m.variable, bin.excess, bin.time});
  }
  return where_most_gathers(places);
}

std::vector<double> rate_of_change(const std::vector<double>& x, const std::vector<double>& time) {
  std::vector<double> out(time.size(), 0.0);
  for (std::size_t k = 1; k < out.size(); ++k) out[k] = (x[k] - x[k - 1]) / (time[k] - time[k - 1]);
  return out;
}

// A log's part of a channel, by what drove the valve and where the simulation stood. Reversals are the piston's, or the
// spool's where no piston was simulated, or the command's.
Piece piece_of(const Scenario& s, const Trajectory& run, std::vector<double> residual) {
  const auto simulated = [&](Signal which) -> const std::vector<double>* {
    const auto& signal = run.signals[static_cast<std::size_t>(simulated_index(which))];
    return signal.empty() ? nullptr : &signal;
  };
  const auto *piston = simulated(Signal::piston_position), *spool = simulated(Signal::spool_position),
             *a = simulated(Signal::pressure_a), *b = simulated(Signal::pressure_b);
  Piece p;
  p.time = s.time;
  p.residual = std::move(residual);
  p.command = s.command;
  p.inputs.push_back({"command", s.command});
  if (!s.supply_pressure.empty())
    p.inputs.push_back({std::string(info(Signal::supply_pressure).name), s.supply_pressure});
  if (!s.load_force.empty()) p.inputs.push_back({"load_force", s.load_force});
  const std::vector<double> velocity = rate_of_change(piston ? *piston : spool ? *spool : s.command, s.time);
  if (piston)
    p.variables.push_back({"piston_position|m", *piston}), p.variables.push_back({"piston_velocity|m/s", velocity});
  if (spool) p.variables.push_back({"spool_position|m", *spool});
  if (a && b) p.variables.push_back({"load_pressure|Pa", difference(*a, *b)});
  p.variables.push_back({"command|A", s.command});
  p.since_reversal = since(s.time, [&](std::size_t k) { return velocity[k] * velocity[k - 1] < 0; });
  p.since_jump =
      since(s.time, [&](std::size_t k) { return std::abs(s.command[k] - s.command[k - 1]) > jump * s.rated_current; });
  return p;
}

// A channel of all logs.
struct Pooled {
  std::string signal, unit;  // unit of the log
  double noise = 0;          // [SI] the largest
  std::vector<Piece> pieces;
};
Pooled& pool_of(std::vector<Pooled>& all, const std::string& signal, const std::string& unit) {
  for (Pooled& p : all)
    if (p.signal == signal) return p;
  return all.emplace_back(Pooled{signal, unit, 0, {}});
}

// How large the residual is, and how it goes with what it was before.
struct Whiteness {
  std::vector<double> correlation = std::vector<double>(lags + 1, 0);  // lag by lag, a sum over all samples
  double square = 0, n = 0;                                            // sum, and samples
  double memory = 0;                                                   // [s] mean of the pieces
};
Whiteness whiteness_of(const std::vector<Piece>& pieces) {
  Whiteness out;
  for (const Piece& p : pieces) {
    const std::vector<double> r = without_mean(p.residual);
    for (double v : p.residual)
      if (std::isfinite(v)) out.square += v * v, ++out.n;
    for (std::size_t lag = 0; lag < out.correlation.size(); ++lag)
      for (std::size_t k = lag; k < r.size(); ++k) out.correlation[lag] += r[k] * r[k - lag];
    out.memory += step_of(p) / effective_fraction(r) / static_cast<double>(pieces.size());
  }
  return out;
}
// Share of the lags outside the band of white noise.
double share_beyond_band(const Whiteness& of) {
  double share = 0;
  for (std::size_t lag = 1; lag < of.correlation.size(); ++lag)
    share += std::abs(of.correlation[lag] / of.correlation[0]) > white_band / std::sqrt(of.n) ? 1.0 / lags : 0;
  return share;
}

// Of the residual with the command.
Welch spectra_of(const std::vector<Piece>& pieces) {
  Welch out;
  for (const Piece& p : pieces) out.add(without_mean(p.residual), without_mean(p.command), step_of(p));
  return out;
}
void add_spectra(ShownChannel& to, const Welch& welch) {
  for (int f = 1; f < Welch::length / 2 && welch.windows > 0; ++f) {
    const auto k = static_cast<std::size_t>(f);
    // Hann: mean square 3/8; one-sided density.
    to.spectrum.push_back(
        {welch.frequency(f), std::sqrt(2 * welch.dt * welch.xx[k] / (welch.windows * Welch::length * 0.375))});
    to.coherence.push_back({welch.frequency(f), std::norm(welch.xy[k]) / std::max(tiny, welch.xx[k] * welch.yy[k])});
  }
}

ShownChannel channel_of(const Pooled& channel) {
  const std::vector<Piece>& pieces = channel.pieces;
  const Whiteness white = whiteness_of(pieces);
  ShownChannel out;
  out.signal = channel.signal, out.unit = channel.unit;
  out.noise = channel.noise;
  out.rms = std::sqrt(white.square / std::max(1.0, white.n));
  out.memory = white.memory;
  out.beyond_band = share_beyond_band(white);
  for (std::size_t u = 0; u < pieces.front().inputs.size(); ++u)
    out.inputs.push_back(correlate(pieces.front().inputs[u].first, pieces, u));
  add_spectra(out, spectra_of(pieces));
  for (std::size_t v = 0; v < pieces.front().variables.size(); ++v)
    out.maps.push_back(map_of(pieces.front().variables[v].first, pieces, v, out.noise));
  out.excess = place_of_excess(pieces, out.maps, out.noise);
  return out;
}

}  // namespace

ExcessPlace where_most_gathers(const std::vector<ExcessPlace>& places) {
  const auto lift = [](const ExcessPlace& p) {
    return p.share > least_told && p.time > 0 ? p.share * std::log(p.share / p.time) : 0;
  };
  const auto best = std::max_element(places.begin(), places.end(),
                                     [&](const ExcessPlace& a, const ExcessPlace& b) { return lift(a) < lift(b); });
  if (best == places.end() || lift(*best) < least_lift) return {ExcessPlace::Kind::spread};
  return *best;
}

std::vector<ShownChannel> show(const ValveSubject& subject, const std::vector<Log>& logs, const Point& point) {
  const auto problem = subject.problem({});
  const std::vector<Trajectory> runs = problem->trajectories(point);
  std::vector<Pooled> channels;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    const LogData& data = subject.logs()[l];
    if (!runs[l].ok) continue;
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      const FitChannel& f = data.channels[c];
      Pooled& to = pool_of(channels, std::string(info(f.signal).name), logs[l].channels[index(f.signal)].unit);
      to.noise = std::max(to.noise, f.noise);
      to.pieces.push_back(
          piece_of(data.scenario, runs[l], problem->raw_residual(static_cast<int>(l), static_cast<int>(c), runs[l])));
    }
  }
  std::vector<ShownChannel> out;
  for (const Pooled& c : channels) out.push_back(channel_of(c));
  return out;
}

}  // namespace servodx
