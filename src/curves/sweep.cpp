#include "curves/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "curves/constants.h"
#include "servodx/log.h"
#include "signals/drive_of.h"

namespace servodx::curves {
namespace {

using namespace curves_constants;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::optional<Sweeps> sweeps_of(const Log& log, double rated) {
  const Signal drive = drive_of(log);
  Sweeps s;
  s.current = log[drive];
  double last = nan;
  for (double& c : s.current) last = c = std::isnan(c) ? last : c;
  for (std::size_t k = s.current.size(); k-- > 0;) last = s.current[k] = std::isnan(s.current[k]) ? last : s.current[k];
  s.resolution = log.channels[index(drive)].resolution;
  const auto [low, high] = std::minmax_element(s.current.begin(), s.current.end());
  s.low = *low, s.high = *high;
  if (s.high - s.low < least_range * rated) return std::nullopt;

  // Zigzag: a branch ends at the extreme from which the command came back by more than `turn`.
  s.direction.assign(s.current.size(), 0);
  std::size_t extreme = 0, begin = 0;
  int direction = 0;
  double travelled = 0;
  for (std::size_t k = 1; k < s.current.size(); ++k) {
    const double back = s.current[k] - s.current[extreme];
    if (direction == 0) {
      if (std::fabs(back) > turn * rated) direction = back > 0 ? 1 : -1, extreme = k;
    } else if (back * direction >= 0) {
      extreme = k;
    } else if (std::fabs(back) > turn * rated) {
      for (std::size_t j = begin; j < extreme; ++j) s.direction[j] = direction;
      travelled += std::fabs(s.current[extreme] - s.current[begin]);
      begin = extreme;
      s.reversals.push_back(extreme);
      direction = -direction;
      extreme = k;
    }
  }
  for (std::size_t j = begin; j < s.current.size(); ++j) s.direction[j] = direction;
  travelled += std::fabs(s.current.back() - s.current[begin]);
  s.rate = travelled / (log.time.back() - log.time.front());
  if (direction == 0 || s.rate > fastest_sweep * rated) return std::nullopt;

  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (std::size_t k = 1; k < s.reversals.size(); ++k) {
    const double branch = log.time[s.reversals[k]] - log.time[s.reversals[k - 1]];
    shortest = std::min(shortest, branch), longest = std::max(longest, branch);
  }
  s.periodic = longest <= alike_branches * shortest;

  // Steps of the command's own resolution where that is coarse, so that no step is empty by rounding.
  s.step = s.resolution > 0.8 * curve_step * rated ? s.resolution : curve_step * rated;
  std::vector<char> visited(static_cast<std::size_t>((s.high - s.low) / s.step) + 2, 0);
  for (double c : s.current) visited[static_cast<std::size_t>(std::lround((c - s.low) / s.step))] = 1;
  const auto count = static_cast<double>(std::count(visited.begin(), visited.end(), 1));
  if (count < covered * (s.high - s.low) / s.step) return std::nullopt;
  return s;
}

SweepCurve curve_of(const Sweeps& s, Signal signal, const std::vector<double>& output) {
  SweepCurve curve{signal, {}, {}, {}, {}};
  const long first = std::lround(s.low / s.step), last = std::lround(s.high / s.step);
  const auto n = static_cast<std::size_t>(last - first + 1);
  std::vector<double> sum[2] = {std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  std::vector<long> count[2] = {std::vector<long>(n, 0), std::vector<long>(n, 0)};
  // Where whole branches are left without it, the first is how the valve came from rest.
  const std::size_t begin = s.reversals.size() >= 3 ? s.reversals.front() : 0;
  for (std::size_t k = begin; k < output.size(); ++k) {
    if (std::isnan(output[k])) continue;
    const auto at = static_cast<std::size_t>(std::lround(s.current[k] / s.step) - first);
    const int branch = s.direction[k] > 0 ? 0 : 1;
    sum[branch][at] += output[k];
    ++count[branch][at];
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double up = count[0][k] ? sum[0][k] / static_cast<double>(count[0][k]) : nan;
    const double down = count[1][k] ? sum[1][k] / static_cast<double>(count[1][k]) : nan;
    curve.current.push_back(static_cast<double>(first + static_cast<long>(k)) * s.step);
    curve.up.push_back(up);
    curve.down.push_back(down);
    curve.mean.push_back(std::isnan(up) ? down : std::isnan(down) ? up : 0.5 * (up + down));
  }
  return curve;
}

Line line_through(std::span<const double> x, std::span<const double> y, double low, double high) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (std::isnan(y[k]) || x[k] < low || x[k] > high) continue;
    ++n, sx += x[k], sy += y[k], sxx += x[k] * x[k], sxy += x[k] * y[k];
  }
  const double spread = n * sxx - sx * sx;
  if (n < 3 || spread <= 0) return {nan, nan};
  const double slope = (n * sxy - sx * sy) / spread;
  return {slope, (sy - slope * sx) / n};
}

double crossing(std::span<const double> x, std::span<const double> y, double level) {
  std::size_t last = x.size();
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (std::isnan(y[k])) continue;
    if (last < x.size() && (y[last] - level) * (y[k] - level) <= 0 && y[k] != y[last])
      return x[last] + (x[k] - x[last]) * (level - y[last]) / (y[k] - y[last]);
    last = k;
  }
  return nan;
}

}  // namespace servodx::curves
