#include "diagnose/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/constants.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

double square_of(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x)
    if (std::isfinite(v)) sum += v * v;
  return sum;
}

std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

// Of the moves of a channel that shows noise alone.
double square_of_noise(const FitChannel& c, std::size_t samples, std::size_t blocks) {
  if (samples == 0) return 0;
  const double n = static_cast<double>(blocks);
  return 2 * c.noise * c.noise * n * n / static_cast<double>(samples);
}

}  // namespace

Blocks means_of(const std::vector<double>& time, const std::vector<double>& x, bool of_size) {
  Blocks out;
  const double length = std::max(k::block, (time.back() - time.front()) / k::most_blocks);
  for (std::size_t from = 0; from < time.size();) {
    double sum = 0;
    std::size_t to = from, n = 0;
    for (; to < time.size() && time[to] < time[from] + length; ++to)
      if (std::isfinite(x[to])) sum += of_size ? std::abs(x[to]) : x[to], ++n;
    out.time.push_back(time[from]);
    out.value.push_back(n > 0 ? sum / static_cast<double>(n) : std::numeric_limits<double>::quiet_NaN());
    from = to;
  }
  return out;
}

std::vector<double> moves(const std::vector<double>& time, const std::vector<double>& x) {
  const Blocks blocks = means_of(time, x);
  std::vector<double> out;
  for (std::size_t i = 1; i < blocks.value.size(); ++i) out.push_back(blocks.value[i] - blocks.value[i - 1]);
  return out;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double n = 0, sa = 0, sb = 0, aa = 0, ab = 0, bb = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i]))
      ++n, sa += a[i], sb += b[i], aa += a[i] * a[i], ab += a[i] * b[i], bb += b[i] * b[i];
  const double va = aa - sa * sa / n, vb = bb - sb * sb / n;
  return va > 0 && vb > 0 ? (ab - sa * sb / n) / std::sqrt(va * vb) : 0.0;
}

std::vector<MotionLeft> motion_left(const LogData& log, const Trajectory& healthy, const Trajectory& simulated) {
  std::vector<MotionLeft> out;
  const std::vector<double>& time = log.scenario.time;
  for (const FitChannel& c : log.channels) {
    const auto at = static_cast<std::size_t>(c.simulated);
    if (!healthy.ok || !simulated.ok) {
      out.push_back({c.signal, 1});
      continue;
    }
    const std::vector<double> measured = moves(time, c.measured);
    const std::vector<double> would = moves(time, c.shown(healthy.signals[at]));
    const std::vector<double> does = moves(time, c.shown(simulated.signals[at]));
    const double noise = square_of_noise(c, time.size(), measured.size());
    const double own = square_of(measured), all = own + square_of(would) - noise;
    if (all < k::beyond_noise * noise || !(all > 0)) continue;
    const double still = std::max(0.0, own - noise) / all;
    const double part = std::max(0.0, square_of(difference(measured, does)) - noise) / all;
    const bool says_nothing = still > k::moves_by_itself && part > k::no_better_than_still * still;
    out.push_back({c.signal, says_nothing ? std::max(1.0, part) : part});
  }
  return out;
}

double mean_left(const std::vector<MotionLeft>& left, double none) {
  if (left.empty()) return none;
  double sum = 0;
  for (const MotionLeft& each : left) sum += each.part;
  return sum / static_cast<double>(left.size());
}

}  // namespace servodx
