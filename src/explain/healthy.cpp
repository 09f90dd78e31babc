#include "explain/healthy.h"

#include <algorithm>
#include <cmath>

#include "base/student.h"
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

// Sizes over healthy logs, as random effects. How far they scatter beyond their standard errors has two faces: alike on
// all logs (tau: DerSimonian & Laird 1986), or in proportion to the standard error, where a test that hardly shows a
// cause lends it whatever else is wrong (Birge 1932). The likelier of the two is taken.
struct Scatter {
  double tau2 = 0, phi2 = 1;
  double mean = 0, mean_variance = 0, degrees = 1;
  double variance(double square) const { return tau2 + phi2 * square; }
};
Scatter scatter_of(const std::vector<double>& size, const std::vector<double>& square) {
  const auto n = static_cast<double>(size.size());
  struct Pool {
    double weight = 0, sum = 0, squares = 0;
    void add(double w, double x) { weight += w, sum += w * x, squares += w * w; }
    double mean() const { return sum / weight; }
  };
  const auto pooled = [&](const Scatter& s) {
    Pool p;
    for (std::size_t i = 0; i < size.size(); ++i) p.add(1 / (s.variance(square[i]) + 1e-300), size[i]);
    return p;
  };
  const auto likelihood = [&](const Scatter& s) {
    double sum = 0;
    for (std::size_t i = 0; i < size.size(); ++i) {
      const double v = s.variance(square[i]) + 1e-300;
      sum -= std::log(v) + (size[i] - s.mean) * (size[i] - s.mean) / v;
    }
    return sum;
  };
  Scatter alike, in_proportion;
  Pool p = pooled(alike);
  double q = 0;
  for (std::size_t i = 0; i < size.size(); ++i) q += (size[i] - p.mean()) * (size[i] - p.mean()) / (square[i] + 1e-300);
  in_proportion.phi2 = std::max(1.0, q / (n - 1));
  in_proportion.mean = p.mean(), in_proportion.mean_variance = in_proportion.phi2 / p.weight;
  in_proportion.degrees = n - 1;
  alike.tau2 = std::max(0.0, (q - (n - 1)) / (p.weight - p.squares / p.weight));
  p = pooled(alike);
  alike.mean = p.mean(), alike.mean_variance = 1 / p.weight;
  alike.degrees = std::max(1.0, p.weight * p.weight / p.squares - 1);  // of logs that speak
  return likelihood(in_proportion) > likelihood(alike) ? in_proportion : alike;
}

}  // namespace

HealthyScore summarise(const Subject& subject, const CauseScore& score) {
  const Cause& cause = subject.causes()[static_cast<std::size_t>(score.cause)];
  HealthyScore out{cause.effect, cause.where + (cause.family.empty() ? "" : "/" + cause.family), {}, score.gain};
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
  HealthyLog out;
  out.log = log.path, out.sha256 = log.sha256;
  ValveSubject subject({log}, tuned, rig, threads, KnownRig{});
  const std::vector<Curve> curves = add_curves(subject);
  const ExplainedFit fit = fit_base(subject, EngineOptions{}.iterations);
  if (fit.ok) {
    guess_curves(subject, curves, fit.point);
    out.adequacy = subject.adequacy(fit.residual);
    for (const CauseScore& s : score_causes(subject, fit)) out.scores.push_back(summarise(subject, s));
    out.misses = subject.misses(fit.residual);
    out.errors = subject.errors(fit.residual);
    out.air = subject.own(0, row::air_fraction, fit.point);
    out.command_slope = subject.own(0, nuisance::command_slope, fit.point);
    for (const BlockReplay& b : replay_blocks(subject, fit.point)) out.misses.push_back({b.block, b.missing});
  }
  if (simulations) *simulations += subject.simulations();
  if (failed) *failed += subject.failed_simulations();
  return out;
}

KnownRig HealthyReference::known() const {
  KnownRig out;
  for (const HealthyLog& l : logs) {
    out.errors.insert(out.errors.end(), l.errors.begin(), l.errors.end());
    if (l.air > 0) out.air.push_back(l.air);
    if (std::isfinite(l.command_slope)) out.command_slope.push_back(l.command_slope);
  }
  return out;
}

HealthyTest::HealthyTest(const HealthyReference& reference) : reference_(reference) {
  for (std::size_t i = 0; i < reference.logs.size(); ++i) {
    double smallest = 1;
    for (const HealthyScore& s : reference.logs[i].scores)
      smallest = std::min(smallest, alone({s}, static_cast<int>(i)));
    sum_ -= std::log1p(-std::min(smallest, 1 - 1e-12));
    least_ = std::min(least_, smallest);
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
    const Scatter scatter = scatter_of(size, square);
    double weight = 0, sum = 0;
    for (const HealthyScore& s : logs)
      if (k < s.sizes.size() && std::isfinite(s.sizes[k].std_error)) {
        const double w = 1 / (scatter.variance(s.sizes[k].std_error * s.sizes[k].std_error) + 1e-300);
        weight += w, sum += w * s.sizes[k].size;
      }
    if (weight <= 0) continue;
    const double t = (sum / weight - scatter.mean) / std::sqrt(1 / weight + scatter.mean_variance);
    best = std::min(best, student_tail(t, scatter.degrees));
    ++tried;
  }
  // The probes of a cause are nearly one: sizes along one line.
  return tried ? std::min(1.0, best * std::min(tried, 2)) : 1.0;
}

double HealthyTest::spread(const HealthyScore& of, std::size_t probe) const {
  std::vector<double> size, square;
  for (const HealthyLog& l : reference_.logs)
    for (const HealthyScore& s : l.scores)
      if (s.effect == of.effect && s.where == of.where && probe < s.sizes.size() &&
          std::isfinite(s.sizes[probe].std_error) && std::isfinite(s.sizes[probe].size))
        size.push_back(s.sizes[probe].size), square.push_back(s.sizes[probe].std_error * s.sizes[probe].std_error);
  if (size.size() < 3) return 0;
  const Scatter scatter = scatter_of(size, square);
  const double own = of.sizes[probe].std_error;
  return std::sqrt(std::max(0.0, scatter.variance(own * own) - own * own) + scatter.mean * scatter.mean);
}

double HealthyTest::together(double alone) const {
  // The smallest of m independent chances has -ln(1 - p) exponential with rate m; m is learnt, causes are alike.
  // What some healthy log shows beside the others is not new, whatever the law says: that holds for any scatter.
  const auto n = static_cast<double>(reference_.logs.size());
  if (n < 3 || alone >= std::min(1.0, least_)) return 1;
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
