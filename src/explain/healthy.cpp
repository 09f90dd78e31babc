#include "explain/healthy.h"

#include <algorithm>
#include <cmath>

#include "explain/curves.h"
#include "explain/valve.h"

namespace servodx {
namespace {

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}
double variance(const std::vector<double>& v) {
  const double m = mean(v);
  double sum = 0;
  for (double x : v) sum += (x - m) * (x - m);
  return sum / static_cast<double>(v.size() - 1);
}

// Variance of the sizes beyond their standard errors (DerSimonian & Laird 1986): logs that hardly see a cause hardly
// count.
double between(const std::vector<double>& size, const std::vector<double>& square) {
  double w = 0, ww = 0, middle = 0, q = 0;
  for (std::size_t i = 0; i < size.size(); ++i) {
    const double one = 1 / (square[i] + 1e-300);
    w += one, ww += one * one, middle += one * size[i];
  }
  middle /= w;
  for (std::size_t i = 0; i < size.size(); ++i) q += (size[i] - middle) * (size[i] - middle) / (square[i] + 1e-300);
  return std::max(0.0, (q - static_cast<double>(size.size() - 1)) / (w - ww / w));
}

// Continued fraction of the incomplete beta function (Abramowitz & Stegun 26.5.8), Lentz's method.
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  double c = 1, d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < tiny ? tiny : d);
  double h = d;
  for (int m = 1; m < 300; ++m) {
    for (const double step : {m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                              -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))}) {
      d = 1 + step * d;
      d = 1 / (std::abs(d) < tiny ? tiny : d);
      c = 1 + step / c;
      if (std::abs(c) < tiny) c = tiny;
      h *= d * c;
    }
    if (std::abs(d * c - 1) < 1e-14) break;
  }
  return h;
}
double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

}  // namespace

double student_tail(double t, double degrees) {
  return incomplete_beta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
}

HealthyScore summarise(const Subject& subject, const CauseScore& score) {
  const Cause& cause = subject.causes()[static_cast<std::size_t>(score.cause)];
  HealthyScore out{cause.effect, cause.where + (cause.family.empty() ? "" : "/" + cause.family), {}};
  if (cause.curve) {  // knots that the log does not reach are loose: what they gain together is what counts
    out.sizes.push_back({std::log1p(score.gain), 1.0});
    return out;
  }
  std::size_t k = 0;
  for (const auto& alternative : cause.probes) {
    if (alternative.size() == 1) {
      out.sizes.push_back(score.probes[k++]);
      continue;
    }
    double size = 0, error = 0;
    for (std::size_t j = 0; j < alternative.size(); ++j, ++k)
      size += score.probes[k].size * score.probes[k].size,
          error += score.probes[k].std_error * score.probes[k].std_error;
    const auto n = static_cast<double>(alternative.size());
    out.sizes.push_back({std::sqrt(size / n), std::sqrt(error / n)});
  }
  return out;
}

HealthyLog score_healthy(const Log& log, const Table& tuned, const RigFile& rig, int threads, long* simulations,
                         long* failed) {
  HealthyLog out{log.path, log.sha256, 1, {}, {}};
  ValveSubject subject({log}, tuned, rig, threads);
  add_curves(subject);
  const ExplainedFit fit = fit_base(subject, EngineOptions{}.iterations);
  if (fit.ok) {
    out.adequacy = subject.adequacy(fit.residual);
    for (const CauseScore& s : score_causes(subject, fit)) out.scores.push_back(summarise(subject, s));
    out.misses = subject.misses(fit.residual);
    for (const BlockReplay& b : replay_blocks(subject, fit.point)) out.misses.push_back({b.block, b.missing});
  }
  if (simulations) *simulations += subject.simulations();
  if (failed) *failed += subject.failed_simulations();
  return out;
}

HealthyTest::HealthyTest(const HealthyReference& reference) : reference_(reference) {
  for (std::size_t i = 0; i < reference.logs.size(); ++i) {
    double smallest = 1;
    for (const HealthyScore& s : reference.logs[i].scores)
      smallest = std::min(smallest, alone({s}, static_cast<int>(i)));
    sum_ -= std::log1p(-std::min(smallest, 1 - 1e-12));
  }
}

double HealthyTest::alone(const std::vector<HealthyScore>& logs, int left_out) const {
  double best = 1;
  int tried = 0;
  for (std::size_t k = 0; k < logs.front().sizes.size(); ++k) {
    std::vector<double> size, square;
    for (std::size_t i = 0; i < reference_.logs.size(); ++i)
      for (const HealthyScore& s : reference_.logs[i].scores)
        if (static_cast<int>(i) != left_out && s.effect == logs.front().effect && s.where == logs.front().where &&
            k < s.sizes.size() && std::isfinite(s.sizes[k].std_error) && std::isfinite(s.sizes[k].size))
          size.push_back(s.sizes[k].size), square.push_back(s.sizes[k].std_error * s.sizes[k].std_error);
    if (size.size() < 3) continue;
    const double tau2 = between(size, square);
    // Mean weighted by what each knows, and its variance.
    struct Pool {
      double weight = 0, sum = 0, squares = 0;
      void add(double w, double x) { weight += w, sum += w * x, squares += w * w; }
      double mean() const { return sum / weight; }
      double count() const { return weight * weight / squares; }  // of logs that speak
    } healthy, here;
    for (std::size_t i = 0; i < size.size(); ++i) healthy.add(1 / (tau2 + square[i] + 1e-300), size[i]);
    for (const HealthyScore& s : logs)
      if (k < s.sizes.size() && std::isfinite(s.sizes[k].std_error))
        here.add(1 / (tau2 + s.sizes[k].std_error * s.sizes[k].std_error + 1e-300), s.sizes[k].size);
    if (here.weight <= 0) continue;
    const double t = (here.mean() - healthy.mean()) / std::sqrt(1 / here.weight + 1 / healthy.weight);
    best = std::min(best, student_tail(t, std::max(1.0, healthy.count() - 1)));
    ++tried;
  }
  // The probes of a cause are nearly one: sizes along one line.
  return tried ? std::min(1.0, best * std::min(tried, 2)) : 1.0;
}

double HealthyTest::together(double alone) const {
  // The smallest of m independent chances has -ln(1 - p) exponential with rate m; m is learnt, causes are alike.
  const auto n = static_cast<double>(reference_.logs.size());
  if (n < 3 || alone >= 1) return 1;
  return 1 - std::pow(1 - std::log1p(-alone) / sum_, -n);
}

namespace {

// Chance that one more positive number of the same kind is as large: Student's predictive of the logarithms.
double chance_above(const std::vector<double>& healthy, double value) {
  std::vector<double> logs;
  for (double v : healthy)
    if (v > 0) logs.push_back(std::log(v));
  if (logs.size() < 3 || !(value > 0)) return 1;
  const auto n = static_cast<double>(logs.size());
  const double t = (std::log(value) - mean(logs)) / std::sqrt(std::max(1e-6, variance(logs)) * (1 + 1 / n));
  return t > 0 ? 0.5 * student_tail(t, n - 1) : 1;
}

}  // namespace

double HealthyTest::adequacy(double value) const {
  std::vector<double> healthy;
  for (const HealthyLog& l : reference_.logs) healthy.push_back(l.adequacy);
  return chance_above(healthy, value);
}

double HealthyTest::miss(const Miss& part) const {
  std::vector<double> healthy;
  for (const HealthyLog& l : reference_.logs)
    for (const Miss& m : l.misses)
      if (m.part == part.part) healthy.push_back(m.size);
  return chance_above(healthy, part.size);
}

double HealthyTest::any(const std::vector<Miss>& parts) const {
  double least = 1;
  for (const Miss& m : parts) least = std::min(least, miss(m) * static_cast<double>(parts.size()));
  return least;
}

}  // namespace servodx
