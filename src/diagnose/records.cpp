#include "diagnose/records.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/tiny.h"
#include "diagnose/constants.h"
#include "diagnose/motion.h"
#include "parameters/list.h"
#include "signals/noise.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double range_of(const std::vector<double>& x, std::size_t from, std::size_t to) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = from; i < to; ++i)
    if (std::isfinite(x[i])) low = std::min(low, x[i]), high = std::max(high, x[i]);
  return high > low ? high - low : 0.0;
}

// Flow drawn from the supply, of about the most that the valve passes: by the piston's speed and the area that is
// filled where the piston is recorded, else by the drive.
std::vector<double> demand_of(const Log& log, const LogData& data, const ParameterVector& base) {
  if (log.has(Signal::piston_position)) {
    const Blocks piston = means_of(log.time, log[Signal::piston_position], false);
    const double most = base[row::port_width] * base[row::spool_stop] *
                        std::sqrt(base[row::supply_pressure] / data.scenario.oil.density);
    std::vector<double> out(piston.value.size(), 0.0);
    for (std::size_t i = 1; i + 1 < out.size(); ++i) {
      const double speed = (piston.value[i + 1] - piston.value[i - 1]) / (piston.time[i + 1] - piston.time[i - 1]);
      out[i] = (speed > 0 ? speed * base[row::piston_area_a] : -speed * base[row::piston_area_b]) / most;
    }
    return out;
  }
  std::vector<double> out = means_of(log.time, data.scenario.command, true).value;
  for (double& x : out) x /= data.scenario.rated_current;
  return out;
}

// A level that falls in proportion to the demand and from some time on goes elsewhere, at once and further in
// proportion to time: a valve that closes, a pump that stops beside an accumulator. Least squares.
struct Levels {
  double scale = none;                                       // [Pa] of what follows
  Eigen::Vector4d at = Eigen::Vector4d::Zero();              // first level, step, further by the end, fall at all flow
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();  // by what is left, as far as that is independent
  double cost = HUGE_VAL;
  std::size_t split = 0;
  double first() const { return at[0]; }
  double last() const { return at[0] + at[1] + at[2]; }
  // One standard deviation of a figure that grows with the four as `by`.
  double error(const Eigen::Vector4d& by) const { return std::sqrt(std::max(0.0, by.dot(covariance * by))); }
};

Eigen::Vector4d terms_of(const Blocks& pressure, const std::vector<double>& demand, std::size_t i, std::size_t split) {
  const double since = pressure.time[split], after = i >= split ? 1.0 : 0.0;
  return {1, after, after * (pressure.time[i] - since) / (pressure.time.back() - since), -demand[i]};
}

Levels levels_at(const Blocks& pressure, const std::vector<double>& demand, std::size_t split, bool falls) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  double square = 0;
  Levels out{.scale = pressure.value.front(), .split = split};  // numbers of order one
  for (std::size_t i = 0; i < pressure.value.size(); ++i) {
    const double y = pressure.value[i] / out.scale;
    if (!std::isfinite(y) || !std::isfinite(demand[i])) continue;
    Eigen::Vector4d row = terms_of(pressure, demand, i, split);
    if (!falls) row[3] = 0;
    normal += row * row.transpose(), right += row * y, square += y * y;
  }
  out.at = normal.completeOrthogonalDecomposition().solve(right);
  if (falls && out.at[3] < 0) return levels_at(pressure, demand, split, false);
  out.cost = square - right.dot(out.at);
  out.covariance = (normal + k::least_told * normal.trace() * Eigen::Matrix4d::Identity()).inverse();
  return out;
}

// What a law leaves that is no line of the demand, a pump at its limit, hangs together from block to block: a step
// takes of it what it can, and is no surer than so few independent blocks make it.
double variance_left(const Blocks& pressure, const std::vector<double>& demand, const Levels& l) {
  double square = 0, with_next = 0, last = none, n = 0;
  for (std::size_t i = 0; i < pressure.value.size(); ++i) {
    const double left = pressure.value[i] / l.scale - terms_of(pressure, demand, i, l.split).dot(l.at);
    if (!std::isfinite(left)) continue;
    square += left * left, ++n;
    if (std::isfinite(last)) with_next += left * last;
    last = left;
  }
  const double alike = std::clamp(with_next / std::max(square, tiny), 0.0, k::most_alike);
  return square / std::max(1.0, n - 4) * (1 + alike) / (1 - alike);
}

std::optional<Levels> levels_of(const Blocks& pressure, const std::vector<double>& demand) {
  Levels best;
  const std::size_t n = pressure.value.size(), margin = std::max(k::fewest_blocks, n / k::shortest_one_in);
  if (!std::isfinite(pressure.value.front())) return {};
  for (std::size_t split = margin; split + margin <= n; ++split)
    if (Levels l = levels_at(pressure, demand, split, true); l.cost < best.cost) best = std::move(l);
  if (!(best.first() > 0)) return {};
  best.covariance *= variance_left(pressure, demand, best);
  return best;
}

void add_supply(const Log& log, const LogData& data, const ParameterVector& base, std::vector<RecordFigure>& out) {
  if (!log.has(Signal::supply_pressure)) return;
  const Blocks pressure = means_of(log.time, log[Signal::supply_pressure], false);
  const std::vector<double> demand = demand_of(log, data, base);
  const std::optional<Levels> l = levels_of(pressure, demand);
  if (!l) return;
  const auto add = [&](FigureKind kind, double value, const Eigen::Vector4d& by) {
    out.push_back({.kind = kind, .value = value, .error = l->error(by)});
  };
  const double first = l->first(), last = std::max(k::least_left * first, l->last());
  add(FigureKind::supply_level, l->scale * first, {1 / first, 0, 0, 0});
  add(FigureKind::supply_step, last / first, {1 / last - 1 / first, 1 / last, 1 / last, 0});
  out.back().since = pressure.time[l->split];
  const double most = *std::max_element(demand.begin(), demand.end());
  if (!(most > k::least_demand)) return;
  const double left = std::max(k::least_left, 1 - most * l->at[3] / first);
  add(FigureKind::supply_left, left, {most * l->at[3] / (first * first * left), 0, 0, -most / (first * left)});
}

struct Line {
  double gain = none, offset = 0, left = 0, drive = 0;  // of current over command; rms of the rest and of the command
};
Line line_through(const std::vector<double>& x, const std::vector<double>& y, std::size_t from, std::size_t to) {
  double n = 0, sx = 0, sy = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t i = from; i < to; ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i]))
      ++n, sx += x[i], sy += y[i], xx += x[i] * x[i], xy += x[i] * y[i], yy += y[i] * y[i];
  Line l;
  const double within = xx - sx * sx / n;
  if (n < k::fewest_blocks || !(within > 0)) return l;
  l.gain = (xy - sx * sy / n) / within;
  l.offset = (sy - l.gain * sx) / n;
  l.left = std::sqrt(std::max(0.0, (yy - sy * sy / n) - l.gain * (xy - sx * sy / n)) / n);
  l.drive = std::sqrt(within / n);
  return l;
}

// When the current leaves the line of its best part; empty: it does not.
std::optional<double> driver_since(const Blocks& command, const Blocks& current, const Line& best) {
  std::vector<double> square;
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < command.value.size(); ++i) {
    const double off = current.value[i] - best.offset - best.gain * command.value[i];
    if (std::isfinite(off)) square.push_back(off * off), at.push_back(i);
  }
  std::size_t change = 0;
  double least = HUGE_VAL, before = 0, all = 0;
  for (const double s : square) all += s;
  const auto n = static_cast<double>(square.size());
  for (std::size_t i = 1; i < square.size(); ++i) {
    before += square[i - 1];
    const double m = static_cast<double>(i), after = all - before;
    const double cost = m * std::log(before / m + tiny) + (n - m) * std::log(after / (n - m) + tiny);
    if (after / (n - m) > k::variance_step * before / m && cost < least) least = cost, change = i;
  }
  return change > 0 ? std::optional<double>(command.time[at[change]]) : std::nullopt;
}

void add_driver(const Log& log, const LogData& data, std::vector<RecordFigure>& out) {
  if (!log.has(Signal::command) || !log.has(Signal::coil_current)) return;
  const Blocks command = means_of(log.time, log[Signal::command], false);
  const Blocks current = means_of(log.time, log[Signal::coil_current], false);
  const std::size_t n = command.value.size();
  const Line whole = line_through(command.value, current.value, 0, n);
  if (!(whole.drive > k::least_drive * data.scenario.rated_current)) return;
  Line least = whole, best = whole;
  for (std::size_t w = 0; w < k::parts; ++w) {
    const Line l = line_through(command.value, current.value, w * n / k::parts, (w + 1) * n / k::parts);
    if (!(l.drive > k::worth_a_part * whole.drive)) continue;
    if (l.gain < least.gain) least = l;
    if (l.gain > best.gain) best = l;
  }
  out.push_back({FigureKind::driver_gain, Signal::coil_current, std::max(k::least_left, least.gain),
                 driver_since(command, current, best)});
  out.push_back({FigureKind::driver_offset, Signal::coil_current,
                 std::max(k::least_left, 1 + whole.offset / data.scenario.rated_current)});
  out.push_back({FigureKind::driver_left, Signal::coil_current, std::max(k::least_residue, whole.left / whole.drive)});
}

// Of the noisier half: a sensor that scatters for less than half of a log does so for most of one. A quarter of a
// lively log is not enough for its median to pass over the motion.
double noise_of_halves(const FitChannel& c) {
  const auto middle = c.measured.begin() + static_cast<long>(c.measured.size() / 2);
  return std::max({c.noise, noise_of({c.measured.begin(), middle}, 0), noise_of({middle, c.measured.end()}, 0)});
}

struct Run {
  std::size_t from = 0, to = 0;
};
Run longest_still(const std::vector<double>& x) {
  Run best;
  for (std::size_t from = 0; from < x.size();) {
    std::size_t to = from + 1;
    while (to < x.size() && x[to] == x[from]) ++to;
    if (to - from > best.to - best.from) best = {from, to};
    from = to;
  }
  return best;
}

double least_step(const std::vector<double>& x) {
  double least = HUGE_VAL;
  for (std::size_t i = 1; i < x.size(); ++i)
    if (const double step = std::abs(x[i] - x[i - 1]); step > 0) least = std::min(least, step);
  return least;
}

// How often it goes up, down and up again from sample to sample, or the other way: by noise, not by the staircase that
// a slow motion makes of a recorder's steps.
std::size_t zigzags(const std::vector<double>& x) {
  std::size_t count = 0;
  for (std::size_t k = 3; k < x.size(); ++k) {
    const double first = x[k - 2] - x[k - 3], next = x[k - 1] - x[k - 2], last = x[k] - x[k - 1];
    count += first * next < 0 && next * last < 0;
  }
  return count;
}

// Alive, it repeats no value for as long, however still what it measures: elsewhere its noise is as large as its steps.
// Half as large is enough where the noise is seen to zigzag: a staircase alone reads as half a step of noise too.
bool has_lost_its_noise(const std::vector<double>& x, Run still) {
  std::vector<double> elsewhere = x;
  elsewhere.erase(elsewhere.begin() + static_cast<long>(still.from), elsewhere.begin() + static_cast<long>(still.to));
  const double noise = noise_of(elsewhere, 0) / least_step(elsewhere);
  if (noise >= 1) return true;
  return noise >= k::noise_in_steps &&
         zigzags(elsewhere) * (still.to - still.from) >= k::zigzags_due * elsewhere.size();
}

// One value for a good part of the log, while the command moves as it does elsewhere and the simulation's sensor would;
// less of the latter does where its noise is gone.
bool is_frozen(const FitChannel& c, const LogData& data, const std::vector<double>& simulated) {
  const Run still = longest_still(c.measured);
  const std::size_t n = c.measured.size();
  if (still.to - still.from < std::max<std::size_t>(k::fewest_still, n / k::still_one_in)) return false;
  const double asked = range_of(data.scenario.command, still.from, still.to);
  const double would = range_of(simulated, still.from, still.to);
  return asked > k::moves_as_elsewhere * range_of(data.scenario.command, 0, n) && would > k::beyond_noise * c.noise &&
         (would > k::moves_as_elsewhere * range_of(simulated, 0, n) || has_lost_its_noise(c.measured, still));
}

// At its lowest or highest value, again and again, where the simulation goes far beyond. A spool at its stop is where
// the simulation's stops as well; a piston drifts, and says nothing here.
bool is_clipped(const FitChannel& c, const std::vector<double>& simulated) {
  if (c.signal == Signal::piston_position) return false;
  const auto [low, high] = std::minmax_element(c.measured.begin(), c.measured.end(), [](double a, double b) {
    return std::isfinite(a) && (!std::isfinite(b) || a < b);
  });
  const double least = k::clipped_beyond * range_of(c.measured, 0, c.measured.size());
  std::size_t beyond = 0, at_limit = 0;
  for (std::size_t from = 0; from < c.measured.size();) {
    std::size_t to = from + 1;
    while (to < c.measured.size() && c.measured[to] == c.measured[from]) ++to;
    const double at = c.measured[from];
    for (std::size_t i = from; i < to && to - from >= k::survey_of_log::clipped_run; ++i) {
      at_limit += at == *low || at == *high;
      beyond += (at == *high && simulated[i] > at + least) || (at == *low && simulated[i] < at - least);
    }
    from = to;
  }
  const auto part = [](std::size_t n, std::size_t of) { return static_cast<double>(n) / static_cast<double>(of); };
  return part(at_limit, c.measured.size()) > k::clipped_part && part(beyond, at_limit) > k::clipped_while_beyond;
}

struct Followed {
  const FitChannel* channel;
  const std::vector<double>* simulated;
  std::vector<double> moves, would_move;
  double own;  // correlation of the two
};

// The channels that the simulation moves beyond their noise.
std::vector<Followed> followed(const LogData& data, const Trajectory& healthy) {
  std::vector<Followed> out;
  for (const FitChannel& c : data.channels) {
    const std::vector<double>& y = healthy.signals[static_cast<std::size_t>(c.simulated)];
    if (y.empty() || range_of(y, 0, y.size()) < k::beyond_noise * c.noise) continue;
    Followed f{&c, &y, moves(data.scenario.time, c.measured), moves(data.scenario.time, y), 0};
    f.own = correlation(f.moves, f.would_move);
    out.push_back(std::move(f));
  }
  return out;
}

bool is_port(const Followed& f) {
  return f.channel->signal == Signal::pressure_a || f.channel->signal == Signal::pressure_b;
}

double square_between(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i])) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

// Each chamber's sensor moves as the other chamber would.
bool are_swapped(const std::vector<Followed>& moving) {
  std::vector<const Followed*> ports;
  for (const Followed& f : moving)
    if (is_port(f)) ports.push_back(&f);
  if (ports.size() != 2) return false;
  const Followed &a = *ports[0], &b = *ports[1];
  const double own = square_between(a.moves, a.would_move) + square_between(b.moves, b.would_move);
  return square_between(a.moves, b.would_move) + square_between(b.moves, a.would_move) < k::swapped_leaves * own;
}

bool is_exchange(const BrokenSensor& b) { return b.finding == SensorFinding::swapped_ports; }

}  // namespace

std::vector<RecordFigure> record_figures(const Log& log, const LogData& data, const ParameterVector& base) {
  std::vector<RecordFigure> out;
  add_supply(log, data, base, out);
  add_driver(log, data, out);
  for (const FitChannel& c : data.channels)
    if (c.noise > 0) out.push_back({FigureKind::sensor_noise, c.signal, noise_of_halves(c)});
  return out;
}

std::vector<RecordFigure> driver_figures(const Log& log, const LogData& data) {
  std::vector<RecordFigure> out;
  add_driver(log, data, out);
  return out;
}

std::vector<BrokenSensor> broken_sensors(const LogData& data, const Trajectory& healthy) {
  if (!healthy.ok) return {};
  const std::vector<Followed> moving = followed(data, healthy);
  const auto follows = [](const Followed& f) { return f.own > k::follows; };
  if (std::none_of(moving.begin(), moving.end(), follows)) return {};  // then it is no one sensor
  const bool swapped = are_swapped(moving);
  std::vector<BrokenSensor> out;
  std::size_t against = 0;
  for (const Followed& f : moving) {
    if (is_frozen(*f.channel, data, *f.simulated))
      out.push_back({SensorFinding::frozen, f.channel->signal});
    else if (swapped && is_port(f))
      out.push_back({SensorFinding::swapped_ports, f.channel->signal});
    else if (f.own > k::follows && is_clipped(*f.channel, *f.simulated))
      out.push_back({SensorFinding::clipped, f.channel->signal});
    else if (f.own < -k::follows)
      out.push_back({SensorFinding::turned, f.channel->signal}), ++against;
  }
  // Two that move against the simulation at once: the command's sign, or the rig file's, and no sensor.
  if (against + swapped > 1)
    std::erase_if(out, [](const BrokenSensor& b) {
      return b.finding == SensorFinding::turned || b.finding == SensorFinding::swapped_ports;
    });
  return out;
}

bool names_exchanged_ports(const std::vector<BrokenSensor>& found) {
  return std::any_of(found.begin(), found.end(), &is_exchange);
}

std::vector<BrokenSensor> beside_flow(std::vector<BrokenSensor> found, Chambers by_flow) {
  if (by_flow == Chambers::as_they_stand) std::erase_if(found, &is_exchange);
  return found;
}

Record record_of(FigureKind kind) {
  switch (kind) {
    case FigureKind::supply_level:
    case FigureKind::supply_step:
    case FigureKind::supply_left:
      return Record::supply;
    case FigureKind::driver_gain:
    case FigureKind::driver_offset:
    case FigureKind::driver_left:
      return Record::driver;
    case FigureKind::sensor_noise:
      return Record::sensor;
  }
  return Record::sensor;
}

}  // namespace servodx
