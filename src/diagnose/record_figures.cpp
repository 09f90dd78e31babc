#include "diagnose/record_figures.h"

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
  const double gain = (n * std::log(all / n + tiny) - least) / k::fall_to_gain;
  return change > 0 && gain > k::change_gain ? std::optional<double>(command.time[at[change]]) : std::nullopt;
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
  out.push_back({.kind = FigureKind::driver_gain,
                 .signal = Signal::coil_current,
                 .value = std::max(k::least_left, least.gain),
                 .since = driver_since(command, current, best),
                 .before = std::max(k::least_left, best.gain)});
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
