#include "prognose/preflight.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/two_pi.h"
#include "prognose/constants.h"

namespace servodx {

using namespace prognose_constants;

namespace {

std::optional<Preflight::Step> find_step(const std::vector<double>& u, std::size_t rest, double level, double rated) {
  if (rest == 0 || rest + 3 >= u.size()) return {};
  const std::size_t from = rest;
  const double size = u[from + 1] - level;  // a sample later: an edge may be caught half way
  if (std::abs(size) < least_jump * rated) return {};
  std::size_t back = from + 1;
  while (back < u.size() && std::abs(u[back] - level - size) < held_within * std::abs(size)) ++back;
  if (back + edge_samples >= u.size() || back - from < shortest_hold) return {};
  if (std::abs(u[back + edge_samples] - level) > taken_back * std::abs(size)) return {};
  return Preflight::Step{from, back, size};
}

struct Turn {
  double time;
  double value;
};

// Turning points by hysteresis; a flat top counts at its middle.
std::vector<Turn> turning_points(const std::vector<double>& t, const std::vector<double>& u, std::size_t from,
                                 double swing) {
  std::vector<Turn> turns;
  double top = u[from], first = t[from], last = t[from];
  int direction = 0;
  double low = u[from], high = u[from];
  for (std::size_t k = from; k < u.size(); ++k) {
    if (direction == 0) {
      low = std::min(low, u[k]), high = std::max(high, u[k]);
      if (high - low < swing) continue;
      direction = u[k] == high ? 1 : -1;
      top = u[k], first = last = t[k];
      continue;
    }
    const double ahead = direction * (u[k] - top);
    if (ahead > 0) {
      top = u[k], first = last = t[k];
    } else if (ahead == 0) {
      last = t[k];
    } else if (-ahead >= swing) {
      turns.push_back({0.5 * (first + last), top});
      direction = -direction;
      top = u[k], first = last = t[k];
    }
  }
  return turns;
}

std::size_t sample_at(const std::vector<double>& t, double time) {
  return static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), time - 1e-9) - t.begin());
}

std::optional<Preflight::Sine> sine_of(const std::vector<double>& t, const std::vector<double>& u, double first_turn,
                                       double last_turn, std::size_t half_periods) {
  const double guess = static_cast<double>(half_periods) / (2 * (last_turn - first_turn));
  const double quarter = 0.25 / guess;
  const std::size_t from = sample_at(t, std::max(t.front(), first_turn - quarter)),
                    to = sample_at(t, last_turn + quarter);
  // The frequency that leaves least, by golden section.
  const auto left = [&](double f) { return fit_sine(t, u, from, to, f, t[from]).residual; };
  double a = lowest_frequency * guess, b = highest_frequency * guess;
  constexpr double golden = 0.6180339887498949;
  for (int k = 0; k < golden_sections; ++k) {
    const double c = b - golden * (b - a), d = a + golden * (b - a);
    (left(c) < left(d) ? b : a) = left(c) < left(d) ? d : c;
  }
  const double f = 0.5 * (a + b);
  const SineFit fit = fit_sine(t, u, from, to, f, t[from]);
  const double amplitude = std::hypot(fit.sine, fit.cosine);
  if (!fit.ok || fit.residual > purity * amplitude / std::numbers::sqrt2) return {};
  // First rising zero of the sinusoid at or after `from`, a few samples of grace.
  double start = t[from] - std::atan2(fit.cosine, fit.sine) / (two_pi * f);
  while (start < t[from] - period_grace / f) start += 1 / f;
  const double end = std::min(t.back(), last_turn + quarter + period_grace / f);
  const int cycles = static_cast<int>(std::floor((end - start) * f + period_grace));
  if (cycles < least_cycles) return {};
  return Preflight::Sine{f, amplitude, start, cycles};
}

}  // namespace

SineFit fit_sine(const std::vector<double>& time, const std::vector<double>& y, std::size_t from, std::size_t to,
                 double frequency, double t0) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  double square = 0;
  long n = 0;
  const double w = two_pi * frequency;
  for (std::size_t k = from; k < to; ++k) {
    if (std::isnan(y[k])) continue;
    const double s = time[k] - t0;
    const Eigen::Vector4d row(1, s * frequency, std::sin(w * s), std::cos(w * s));
    normal += row * row.transpose();
    right += row * y[k];
    square += y[k] * y[k];
    ++n;
  }
  SineFit out;
  if (n < least_of_sine) return out;
  const Eigen::Vector4d x = normal.ldlt().solve(right);
  out = {x[0],
         x[1] * frequency,
         x[2],
         x[3],
         std::sqrt(std::max(0.0, square - x.dot(right)) / static_cast<double>(n)),
         x.allFinite()};
  return out;
}

Preflight find_preflight(const LogData& log) {
  const std::vector<double>&t = log.scenario.time, &u = log.scenario.command;
  const double rated = log.scenario.rated_current;
  Preflight found;
  while (found.rest < u.size() && std::abs(u[found.rest] - u.front()) <= rest_band * rated) ++found.rest;
  for (std::size_t k = 0; k < found.rest; ++k) found.rest_current += u[k] / static_cast<double>(found.rest);
  found.step = find_step(u, found.rest, found.rest_current, rated);

  const std::size_t from = found.step ? found.step->back + 3 : 0;
  if (from + 16 >= u.size()) return found;
  const std::vector<Turn> turns = turning_points(t, u, from, least_swing * rated);
  for (std::size_t i = 0; i + 1 < turns.size();) {
    const double half = turns[i + 1].time - turns[i].time;
    std::size_t j = i + 1;
    while (j + 1 < turns.size() && std::abs(turns[j + 1].time - turns[j].time - half) < equal_periods * half) ++j;
    // Between two tones lies a half period of neither, which may pass for one of either.
    for (const auto& [first, last] : {std::pair(i, j), std::pair(i, j - 1), std::pair(i + 1, j)})
      if (last >= first + 3)
        if (const auto sine = sine_of(t, u, turns[first].time, turns[last].time, last - first)) {
          found.sines.push_back(*sine);
          j = last;
          break;
        }
    i = j;
  }
  return found;
}

}  // namespace servodx
