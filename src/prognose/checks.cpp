#include "prognose/checks.h"

#include <algorithm>
#include <cmath>

#include "prognose/constants.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// Linear between samples; NaN where one of the two is missing.
double at(const std::vector<double>& time, const std::vector<double>& y, double t) {
  const auto after = std::upper_bound(time.begin(), time.end(), t);
  if (after == time.begin()) return y.front();
  if (after == time.end()) return y.back();
  const auto k = static_cast<std::size_t>(after - time.begin());
  return y[k - 1] + (y[k] - y[k - 1]) * (t - time[k - 1]) / (time[k] - time[k - 1]);
}

// Time that a sample stands for.
double weight(const std::vector<double>& t, std::size_t k) {
  const double before = k > 0 ? t[k] - t[k - 1] : 0.0, after = k + 1 < t.size() ? t[k + 1] - t[k] : 0.0;
  return 0.5 * (before + after);
}

}  // namespace

MeanError mean_error(const std::vector<double>& time, const std::vector<double>& measured,
                     const std::vector<double>& monitor) {
  MeanError out;
  double sum = 0, total = 0, batch_sum[error_batches] = {}, batch_time[error_batches] = {};
  const double length = time.back() - time.front();
  out.running.reserve(time.size());
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double w = weight(time, k);
    if (!std::isnan(measured[k])) {
      const double e = std::abs(measured[k] - monitor[k]);
      const int b = std::min(error_batches - 1, static_cast<int>(error_batches * (time[k] - time.front()) / length));
      sum += w * e, total += w;
      batch_sum[b] += w * e, batch_time[b] += w;
    }
    out.running.push_back(total > 0 ? sum / total : 0.0);
  }
  out.figure.value = total > 0 ? sum / total : std::nan("");
  double square = 0;
  int n = 0;
  for (int b = 0; b < error_batches; ++b)
    if (batch_time[b] > 0) square += std::pow(batch_sum[b] / batch_time[b] - out.figure.value, 2), ++n;
  out.figure.std_error = n > 1 ? std::sqrt(square / (n - 1) / n) : std::nan("");
  std::size_t k = time.size();
  while (k > 0 && std::abs(out.running[k - 1] - out.figure.value) <= settled_band * out.figure.value) --k;
  out.settled_at = time[std::min(k, time.size() - 1)] - time.front();
  out.settled = out.settled_at <= settled_by * length && out.figure.std_error < settled_band * out.figure.value;
  return out;
}

std::optional<Fidelity> fidelity(const std::vector<double>& time, const std::vector<double>& measured,
                                 const std::vector<double>& monitor, const Preflight::Step& step, double noise) {
  const double end_value = monitor[step.back - 1];
  if (end_value == 0) return {};
  std::size_t to = step.from;
  while (to < step.back && std::abs(monitor[to]) < step_reached * std::abs(end_value)) ++to;
  if (to <= step.from + 1 || to >= step.back) return {};
  Fidelity out;
  out.duration = time[to] - time[step.from];
  double cross = 0, square = 0, model = 0, variance = 0;
  long n = 0;
  for (std::size_t k = step.from; k <= to; ++k) {
    if (std::isnan(measured[k])) continue;
    const double w = k == step.from || k == to ? 0.5 : 1.0;
    cross += w * measured[k] * monitor[k];
    square += w * measured[k] * measured[k];
    model += w * monitor[k] * monitor[k];
    ++n;
  }
  if (n < 2 || square < std::max(least_motion * least_motion * model,
                                 noise_deviations * noise_deviations * noise * noise * static_cast<double>(n))) {
    out.no_response = true;
    out.figure = {std::nan(""), std::nan("")};
    return out;
  }
  const double r = cross / square;
  for (std::size_t k = step.from; k <= to; ++k) {
    if (std::isnan(measured[k])) continue;
    const double w = k == step.from || k == to ? 0.5 : 1.0;
    variance += std::pow(w * (monitor[k] - 2 * r * measured[k]) / square * noise, 2);
  }
  out.figure = {r, std::sqrt(variance)};
  return out;
}

std::optional<Figure> correlation(const std::vector<double>& time, const std::vector<double>& spool,
                                  const std::vector<double>& piston, const Preflight::Sine& sine, double spool_noise,
                                  double piston_noise) {
  const double period = 1 / sine.frequency, tau = 0.25 * period;
  const double end = std::min(time.back(), sine.start + sine.cycles * period);
  const int whole = static_cast<int>(std::floor((end - sine.start - tau) * sine.frequency + 1e-6));
  if (whole < 1) return {};
  const double begin = end - tau - whole * period;  // the late cycles: the start rings
  const auto sample = [&](double t) {
    return static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), t - 1e-9) - time.begin());
  };
  const std::size_t from = sample(begin), to = sample(end - tau), last = std::min(time.size(), sample(end) + 1);
  const SineFit y = fit_sine(time, piston, from, last, sine.frequency, begin);
  const SineFit x = fit_sine(time, spool, from, to, sine.frequency, begin);
  if (!x.ok || !y.ok) return {};
  std::vector<double> cycle(static_cast<std::size_t>(whole), 0.0);
  double sum = 0, total = 0, x2 = 0, y2 = 0;
  std::vector<double> cycle_time(cycle.size(), 0.0);
  for (std::size_t k = from; k < to; ++k) {
    const double later = time[k] + tau;
    const double moved = at(time, piston, later) - y.constant - y.drift * (later - begin);
    const double opened = spool[k] - x.constant;
    if (std::isnan(moved) || std::isnan(opened)) continue;
    const double w = weight(time, k);
    const auto c = std::min(cycle.size() - 1, static_cast<std::size_t>((time[k] - begin) * sine.frequency));
    sum += w * opened * moved, total += w;
    cycle[c] += w * opened * moved, cycle_time[c] += w;
    x2 += w * opened * opened, y2 += w * moved * moved;
  }
  if (!(total > 0)) return {};
  Figure out{sum / total, 0};
  const auto n = static_cast<double>(to - from);
  const double noise = std::sqrt((x2 * piston_noise * piston_noise + y2 * spool_noise * spool_noise) / total / n);
  double scatter = 0;
  if (whole >= 3) {
    for (std::size_t c = 0; c < cycle.size(); ++c) scatter += std::pow(cycle[c] / cycle_time[c] - out.value, 2);
    scatter = std::sqrt(scatter / (whole - 1) / whole);
  }
  out.std_error = std::max(noise, scatter);
  return out;
}

}  // namespace servodx
