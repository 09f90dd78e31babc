#include "explain/beside_healthy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/student.h"
#include "base/tiny.h"
#include "evidence/log_scatter.h"
#include "explain/constants.h"
#include "explain/size_scatter.h"
#include "explain/subject.h"

namespace servodx {
namespace {

std::vector<SharesOfLog> shares_of(const HealthyReference& reference) {
  std::vector<SharesOfLog> out;
  for (const HealthyLog& l : reference.logs) {
    if (!l.has_shares || l.sets_no_share) continue;
    SharesOfLog& of = out.emplace_back();
    of.thickness = l.scores.empty() ? std::nan("") : l.scores.front().thickness;
    for (const HealthyShare& s : l.shares) {
      double& largest = of.of_effect[s.effect];
      largest = std::max(largest, s.share);
    }
  }
  return out;
}

// Held-out data would have refused it, whatever its size: a suspect is not accused by such a cause either.
bool is_refused(const HealthyLog& log, const HealthyScore& score) {
  return std::any_of(log.shares.begin(), log.shares.end(), [&](const HealthyShare& s) {
    return s.effect == score.effect && s.where == score.where && !(s.lower > 0);
  });
}

// Chance that one more positive number of the same kind is as large.
double chance_above(const std::vector<double>& healthy, double value) {
  return deviate_of(value, healthy, {}).chance_above();
}

}  // namespace

HealthyTest::HealthyTest(const HealthyReference& reference, double thickness)
    : reference_(reference), shares_(shares_of(reference), thickness) {
  const std::size_t n = reference.logs.size();
  for (std::size_t i = 0; i < n; ++i)
    for (const HealthyScore& s : reference.logs[i].scores) {
      OfCause& c = causes_[{s.effect, s.where}];
      c.score.resize(n), c.surprise.resize(n);
      c.score[i] = &s;
    }
  for (auto& [name, c] : causes_)
    for (std::size_t i = 0; i < n; ++i)
      if (c.score[i]) c.surprise[i] = -std::log(std::max(tiny, by_law(c, {*c.score[i]}, static_cast<int>(i))));
  smallest_.assign(n, 1.0);
  for (const auto& [name, c] : causes_)
    for (std::size_t i = 0; i < n; ++i)
      if (c.score[i] && !is_refused(reference.logs[i], *c.score[i]))
        smallest_[i] = std::min(smallest_[i], believed(c, c.surprise[i], static_cast<int>(i), c.score[i]->prior));
}

const HealthyTest::OfCause* HealthyTest::of(const HealthyScore& cause) const {
  const auto it = causes_.find({cause.effect, cause.where});
  return it == causes_.end() ? nullptr : &it->second;
}

double HealthyTest::alone(const std::vector<HealthyScore>& logs) const {
  const OfCause* c = of(logs.front());
  if (!c) return 1;
  return believed(*c, -std::log(std::max(tiny, by_law(*c, logs, -1))), -1, logs.front().prior);
}

// If the law holds, surprises are exponential with mean one, and so it is believed until the logs say otherwise: their
// mean is the inverse of a gamma, and the next surprise Lomax's. A law that is too careful is left as it is.
double HealthyTest::believed(const OfCause& cause, double surprise, int left_out, double prior) const {
  constexpr double law = explain_constants::law_logs;
  double n = 0, sum = 0;
  for (std::size_t i = 0; i < cause.score.size(); ++i)
    if (cause.score[i] && static_cast<int>(i) != left_out) ++n, sum += cause.surprise[i];
  return std::min(1.0, std::pow(1 + surprise / (std::max(sum, n) + law), -n - law) / prior);
}

double HealthyTest::by_law(const OfCause& cause, const std::vector<HealthyScore>& logs, int left_out) const {
  double best = 1;
  int tried = 0;
  for (std::size_t k = 0; k < logs.front().sizes.size(); ++k) {
    std::vector<SizeOnLog> sizes;
    for (std::size_t i = 0; i < cause.score.size(); ++i) {
      const HealthyScore* s = cause.score[i];
      if (s && static_cast<int>(i) != left_out && k < s->sizes.size() && std::isfinite(s->sizes[k].std_error) &&
          std::isfinite(s->sizes[k].size))
        sizes.push_back({s->sizes[k].size, s->sizes[k].std_error * s->sizes[k].std_error, s->thickness});
    }
    if (sizes.size() < explain_constants::enough_healthy) continue;
    const SizeScatter scatter = scatter_of(sizes);
    double weight = 0, sum = 0, noise = 0, shared = 0, known = 0;
    for (const HealthyScore& s : logs)
      if (k < s.sizes.size() && std::isfinite(s.sizes[k].std_error)) {
        const double own = s.sizes[k].std_error * s.sizes[k].std_error, all = scatter.variance(own);
        const double w = 1 / all;
        weight += w, sum += w * (s.sizes[k].size - scatter.at(s.thickness));
        noise += w * w * own, shared += w * std::sqrt(std::max(0.0, all - own));
        known += w * std::sqrt(scatter.variance_at(s.thickness));
      }
    if (weight <= 0) continue;
    const double scattered = (noise + shared * shared + known * known) / (weight * weight);
    const double t = sum / weight / std::sqrt(scattered);
    best = std::min(best, student_tail(t, scatter.degrees));
    ++tried;
  }
  // The probes of a cause are nearly one: sizes along one line.
  return tried ? std::min(1.0, best * std::min(tried, 2)) : 1.0;
}

double HealthyTest::spread(const HealthyScore& of, std::size_t probe) const {
  std::vector<SizeOnLog> sizes;
  for (const HealthyLog& l : reference_.logs)
    for (const HealthyScore& s : l.scores)
      if (s.effect == of.effect && s.where == of.where && probe < s.sizes.size() &&
          std::isfinite(s.sizes[probe].std_error) && std::isfinite(s.sizes[probe].size))
        sizes.push_back({s.sizes[probe].size, s.sizes[probe].std_error * s.sizes[probe].std_error, s.thickness});
  if (sizes.size() < explain_constants::enough_healthy) return 0;
  const SizeScatter scatter = scatter_of(sizes);
  const double own = of.sizes[probe].std_error, none = scatter.at(of.thickness);
  return std::sqrt(std::max(0.0, scatter.variance(own * own) - own * own) + none * none);
}

double HealthyTest::together(double alone) const {
  // The smallest of m independent chances has -ln(1 - p) exponential with rate m; m is learnt, causes are alike.
  const auto n = static_cast<double>(smallest_.size());
  if (smallest_.size() < explain_constants::enough_healthy || alone >= 1) return 1;
  double sum = 0, as_small = 0;
  for (double p : smallest_) sum -= std::log1p(-std::min(p, 1 - 1e-12)), as_small += p <= alone;
  const double by_law = 1 - std::pow(1 - std::log1p(-alone) / sum, -n);
  // What some healthy logs show is no rarer than they are, whatever the law says: that holds for any scatter.
  return as_small > 0 ? std::max(by_law, (as_small + 1) / (n + 1)) : by_law;
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
