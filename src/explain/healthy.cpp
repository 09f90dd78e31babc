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
  HealthyScore out{
      cause.effect, cause.where + (cause.family.empty() ? "" : "/" + cause.family), {}, score.gain, cause.prior};
  if (cause.curve) {  // knots that the log does not reach are loose: what they gain together is what counts
    out.sizes.push_back({std::log1p(score.gain), 1.0});
    return out;
  }
  std::size_t k = 0;
  for (const auto& alternative : cause.probes) {
    if (alternative.size() == 1) {
      out.sizes.push_back(score.probes[k++]);
      if (cause.atop.empty()) continue;
      const double off = cause.numbers.front().off, move = alternative.front().front() - off;
      ProbeScore& whole = out.sizes.back();
      whole = {score.of * (off + move * whole.size), score.of * std::abs(move) * whole.std_error};
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

HealthyReference score_healthy(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, int threads,
                               HealthyCounts& counts, const std::function<bool(double)>& told) {
  const auto n = static_cast<double>(logs.size());
  const auto count = [&](const ValveSubject& s) {
    counts.simulations += s.simulations(), counts.failed += s.failed_simulations();
  };
  HealthyReference all, out;
  for (const Log& log : logs) {  // what is usual
    HealthyLog& h = all.logs.emplace_back();
    h.log = log.path, h.sha256 = log.sha256;
    ValveSubject subject({log}, tuned, rig, threads, KnownRig{});
    const ExplainedFit fit = fit_base(subject, EngineOptions{}.iterations);
    if (fit.ok) {
      h.errors = subject.errors(fit.residual);
      h.air = subject.own(0, row::air_fraction, fit.point);
      h.command_slope = subject.own(0, nuisance::command_slope, fit.point);
    }
    count(subject);
    if (told && !told(0.2 * static_cast<double>(all.logs.size()) / n)) return out;
  }
  for (std::size_t l = 0; l < logs.size(); ++l) {
    ValveSubject subject({logs[l]}, tuned, rig, threads, all.known(static_cast<int>(l)));
    HealthyLog& h = out.logs.emplace_back(all.logs[l]);
    const std::vector<Curve> curves = add_curves(subject);
    const ExplainedFit fit = fit_base(subject, EngineOptions{}.iterations);
    if (fit.ok) {
      guess_curves(subject, curves, fit.point);
      h.adequacy = subject.adequacy(fit.residual);
      for (const CauseScore& s : score_causes(subject, fit)) h.scores.push_back(summarise(subject, s));
      h.misses = subject.misses(fit.residual);
      for (const BlockReplay& b : replay_blocks(subject, fit.point)) h.misses.push_back({b.block, b.missing});
    }
    count(subject);
    if (told && !told(0.2 + 0.8 * static_cast<double>(out.logs.size()) / n)) break;
  }
  return out;
}

KnownRig HealthyReference::known(int left_out) const {
  KnownRig out;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const HealthyLog& l = logs[i];
    if (static_cast<int>(i) == left_out) continue;
    out.errors.insert(out.errors.end(), l.errors.begin(), l.errors.end());
    if (l.air > 0) out.air.push_back(l.air);
    if (std::isfinite(l.command_slope)) out.command_slope.push_back(l.command_slope);
  }
  return out;
}

HealthyTest::HealthyTest(const HealthyReference& reference) : reference_(reference) {
  const std::size_t n = reference.logs.size();
  for (std::size_t i = 0; i < n; ++i)
    for (const HealthyScore& s : reference.logs[i].scores) {
      OfCause& c = causes_[{s.effect, s.where}];
      c.score.resize(n), c.surprise.resize(n);
      c.score[i] = &s;
    }
  for (auto& [name, c] : causes_)
    for (std::size_t i = 0; i < n; ++i)
      if (c.score[i]) c.surprise[i] = -std::log(std::max(1e-300, by_law(c, {*c.score[i]}, static_cast<int>(i))));
  smallest_.assign(n, 1.0);
  for (const auto& [name, c] : causes_)
    for (std::size_t i = 0; i < n; ++i)
      if (c.score[i])
        smallest_[i] = std::min(smallest_[i], believed(c, c.surprise[i], static_cast<int>(i), c.score[i]->prior));
}

const HealthyTest::OfCause* HealthyTest::of(const HealthyScore& cause) const {
  const auto it = causes_.find({cause.effect, cause.where});
  return it == causes_.end() ? nullptr : &it->second;
}

double HealthyTest::alone(const std::vector<HealthyScore>& logs) const {
  const OfCause* c = of(logs.front());
  if (!c) return 1;
  return believed(*c, -std::log(std::max(1e-300, by_law(*c, logs, -1))), -1, logs.front().prior);
}

// If the law holds, surprises are exponential with mean one, and so it is believed until the logs say otherwise: their
// mean is the inverse of a gamma, and the next surprise Lomax's. A law that is too careful is left as it is.
double HealthyTest::believed(const OfCause& cause, double surprise, int left_out, double prior) const {
  constexpr double law = 10;  // counts as much as so many logs
  double n = 0, sum = 0;
  for (std::size_t i = 0; i < cause.score.size(); ++i)
    if (cause.score[i] && static_cast<int>(i) != left_out) ++n, sum += cause.surprise[i];
  return std::min(1.0, std::pow(1 + surprise / (std::max(sum, n) + law), -n - law) / prior);
}

double HealthyTest::by_law(const OfCause& cause, const std::vector<HealthyScore>& logs, int left_out) const {
  double best = 1;
  int tried = 0;
  for (std::size_t k = 0; k < logs.front().sizes.size(); ++k) {
    std::vector<double> size, square;
    for (std::size_t i = 0; i < cause.score.size(); ++i) {
      const HealthyScore* s = cause.score[i];
      if (s && static_cast<int>(i) != left_out && k < s->sizes.size() && std::isfinite(s->sizes[k].std_error) &&
          std::isfinite(s->sizes[k].size))
        size.push_back(s->sizes[k].size), square.push_back(s->sizes[k].std_error * s->sizes[k].std_error);
    }
    if (size.size() < 3) continue;
    const Scatter scatter = scatter_of(size, square);
    double weight = 0, sum = 0, noise = 0, shared = 0;
    for (const HealthyScore& s : logs)
      if (k < s.sizes.size() && std::isfinite(s.sizes[k].std_error)) {
        const double own = s.sizes[k].std_error * s.sizes[k].std_error, all = scatter.variance(own) + 1e-300;
        const double w = 1 / all;
        weight += w, sum += w * s.sizes[k].size;
        noise += w * w * own, shared += w * std::sqrt(std::max(0.0, all - own));
      }
    if (weight <= 0) continue;
    const double scattered = (noise + shared * shared) / (weight * weight);
    const double t = (sum / weight - scatter.mean) / std::sqrt(scattered + scatter.mean_variance);
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
  const auto n = static_cast<double>(smallest_.size());
  if (n < 3 || alone >= 1) return 1;
  double sum = 0, as_small = 0;
  for (double p : smallest_) sum -= std::log1p(-std::min(p, 1 - 1e-12)), as_small += p <= alone;
  const double by_law = 1 - std::pow(1 - std::log1p(-alone) / sum, -n);
  // What some healthy logs show is no rarer than they are, whatever the law says: that holds for any scatter.
  return as_small > 0 ? std::max(by_law, (as_small + 1) / (n + 1)) : by_law;
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
