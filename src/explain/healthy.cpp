#include "explain/healthy.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/student.h"
#include "base/tiny.h"
#include "evidence/constants.h"
#include "evidence/log_scatter.h"
#include "explain/block_replay.h"
#include "explain/cause_score.h"
#include "explain/constants.h"
#include "explain/drive.h"
#include "explain/fit_causes.h"
#include "explain/hold_out.h"
#include "explain/kept.h"
#include "explain/learnt_curves.h"
#include "explain/score.h"
#include "explain/share_null.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "simulate/side_by_side.h"

namespace servodx {
namespace {

// Sizes over healthy logs, as random effects. How far they scatter beyond their standard errors has two faces: alike on
// all logs (tau: DerSimonian & Laird 1986), or in proportion to the standard error, where a test that hardly shows a
// cause lends it whatever else is wrong (Birge 1932). The likelier of the two is taken. Where the model's answer to the
// oil's temperature is off, sizes follow the oil: a line in the logarithm of its viscosity is taken where it is worth
// its number (Schwarz 1978), and the sizes scatter about that.
struct Size {
  double size = 0, square = 0, thickness = 0;  // [of the probe], its standard error squared, ln of the viscosity
};
struct Scatter {
  double tau2 = 0, phi2 = 1;
  double mean = 0, mean_variance = 0, slope = 0, slope_variance = 0, middle = 0, degrees = 1;
  double log_likelihood = -1e300;  // twice
  double variance(double square) const { return tau2 + phi2 * square + tiny; }
  double at(double thickness) const { return mean + (std::isfinite(thickness) ? slope * (thickness - middle) : 0.0); }
  double variance_at(double thickness) const {
    const double off = std::isfinite(thickness) ? thickness - middle : 0.0;
    return mean_variance + off * off * slope_variance;
  }
};
// Weighted line, or mean, through the sizes.
void pool(const std::vector<Size>& sizes, bool line, Scatter& s) {
  double w = 0, wx = 0;
  for (const Size& z : sizes) w += 1 / s.variance(z.square), wx += z.thickness / s.variance(z.square);
  s.middle = line ? wx / w : 0.0;
  double wy = 0, xx = 0, xy = 0;
  for (const Size& z : sizes) {
    const double v = s.variance(z.square), x = z.thickness - s.middle;
    wy += z.size / v, xx += x * x / v, xy += x * z.size / v;
  }
  s.mean = wy / w, s.mean_variance = 1 / w;
  s.slope = line ? xy / xx : 0.0, s.slope_variance = line ? 1 / xx : 0.0;
  s.log_likelihood = 0;
  for (const Size& z : sizes) {
    const double v = s.variance(z.square), off = z.size - s.at(z.thickness);
    s.log_likelihood -= std::log(v) + off * off / v;
  }
}
Scatter scatter_of(const std::vector<Size>& sizes, bool line) {
  const double n = static_cast<double>(sizes.size()), numbers = line ? 2 : 1;
  Scatter alike, in_proportion;
  pool(sizes, line, alike);
  double q = 0, w = 0, w2 = 0, w2xx = 0;  // Cochran's, and what it would be without scatter
  for (const Size& z : sizes) {
    const double v = z.square + tiny, off = z.size - alike.at(z.thickness), x = z.thickness - alike.middle;
    q += off * off / v, w += 1 / v, w2 += 1 / (v * v), w2xx += x * x / (v * v);
  }
  const double taken = w2 / w + w2xx * alike.slope_variance;
  in_proportion.phi2 = std::max(1.0, q / (n - numbers));
  pool(sizes, line, in_proportion);
  in_proportion.degrees = n - numbers;
  alike.tau2 = std::max(0.0, (q - (n - numbers)) / (w - taken));
  pool(sizes, line, alike);
  double squares = 0;
  for (const Size& z : sizes) squares += 1 / std::pow(alike.variance(z.square), 2);
  alike.degrees =
      std::max(1.0, 1 / (alike.mean_variance * alike.mean_variance * squares) - numbers);  // logs that speak
  return in_proportion.log_likelihood > alike.log_likelihood ? in_proportion : alike;
}
Scatter scatter_of(const std::vector<Size>& sizes) {
  const Scatter mean = scatter_of(sizes, false);
  double low = 1e300, high = -1e300;
  for (const Size& z : sizes) low = std::min(low, z.thickness), high = std::max(high, z.thickness);
  if (sizes.size() < evidence_constants::fewest_for_a_trend || !std::isfinite(low + high) || !(high > low)) return mean;
  for (const Size& z : sizes)
    if (!std::isfinite(z.thickness)) return mean;
  const Scatter line = scatter_of(sizes, true);
  return line.log_likelihood - mean.log_likelihood > std::log(static_cast<double>(sizes.size())) ? line : mean;
}

}  // namespace

std::string place_key(const Cause& cause) { return cause.where + (cause.family.empty() ? "" : "/" + cause.family); }

HealthyScore summarise(const Subject& subject, const CauseScore& score) {
  const Cause& cause = subject.causes()[static_cast<std::size_t>(score.cause)];
  HealthyScore out{cause.effect, place_key(cause), {}, score.gain, cause.prior, subject.thickness()};
  if (cause.curve) {  // knots that the log does not reach are loose: what they gain together is what counts
    out.sizes.push_back({std::log1p(score.gain), 1.0});
    return out;
  }
  std::size_t k = 0;
  for (const auto& alternative : cause.probes) {
    if (alternative.size() == 1) {
      out.sizes.push_back(score.probes[k++]);
      ProbeScore& size = out.sizes.back();
      size.std_error = std::hypot(size.std_error, subject.error_beside(score.cause, out.sizes.size() - 1));
      if (cause.atop.empty()) continue;
      const double off = cause.numbers.front().off, move = alternative.front().front() - off;
      size = {score.of * (off + move * size.size), score.of * std::abs(move) * size.std_error};
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

std::vector<HealthyShare> heldout_shares(ValveSubject& subject, const ExplainedFit& base) {
  EngineOptions engine;
  engine.most = 1;
  engine.compare_with_retuning = false;
  engine.among = [](const Cause& c) { return !c.curve && !is_rare(c); };
  FoundCauses begun;
  begun.before = base;
  cross_validate(subject, begun.before, engine.hold_out());
  const FoundCauses e = explain(subject, engine, &begun);
  std::vector<HealthyShare> out;
  for (const CandidateResult& r : e.candidates) {
    if (!r.fitted || r.delta_bic <= 0) continue;
    const Cause& c = subject.causes()[static_cast<std::size_t>(r.cause)];
    out.push_back({c.effect, c.where, r.share.value, r.share.lower, c.prior});
  }
  return out;
}

std::vector<HealthyScore> score_drive(const Log& log, const KnownRig& known) {
  std::vector<HealthyScore> out;
  DriveSubject drive({log}, known);
  if (drive.empty()) return out;
  const ExplainedFit fit = fit_base(drive, EngineOptions{}.iterations);
  if (!fit.ok) return out;
  for (const CauseScore& s : score_causes(drive, fit)) out.push_back(summarise(drive, s));
  return out;
}

ScoredBlocks score_blocks(const ValveSubject& valve, const Point& at, const KnownRig& known) {
  ScoredBlocks out;
  ReplaySubject blocks(valve, at, known);
  if (blocks.empty()) return out;
  const ExplainedFit fit = fit_base(blocks, EngineOptions{}.iterations);
  if (!fit.ok) return out;
  for (const CauseScore& s : score_causes(blocks, fit))
    if (!s.probes.empty()) out.scores.push_back(summarise(blocks, s));
  out.misses = blocks.misses(fit.residual);
  return out;
}

namespace {

bool show_scatter(const std::vector<Log>& own) {
  std::vector<TestConditions> tests;
  for (const Log& log : own) tests.push_back(conditions_of(log));
  return show_scatter_of_tests(tests);
}

// What of a log is usual, as tuned and with nothing known of the rig: how its channels and blocks err, and its own
// numbers.
void see_what_is_usual(ValveSubject& subject, const Log& log, HealthyLog& h) {
  const ExplainedFit fit = fit_base(subject, EngineOptions{}.iterations);
  if (!fit.ok) return;
  h.errors = subject.errors(fit.residual);
  if (ReplaySubject blocks(subject, fit.point); !blocks.empty())
    if (const ExplainedFit replayed = fit_base(blocks, EngineOptions{}.iterations); replayed.ok)
      for (UsualError& e : blocks.errors(replayed.residual)) h.errors.push_back(std::move(e));
  if (const std::optional<UsualDrive> drive = usual_drive(log))
    h.drive_delay = drive->delay, h.errors.push_back(drive->error);
  h.air = subject.own(0, row::air_fraction, fit.point);
  h.command_slope = subject.own(0, nuisance::command_slope, fit.point);
}

// Scores, misses and shares of a log, weighed by what is `known` of the rig from the others.
void score(ValveSubject& subject, const Log& log, const KnownRig& known, HealthyLog& h) {
  const std::vector<Curve> curves = add_curves(subject);
  const ExplainedFit fit = fit_base(subject, EngineOptions{}.iterations);
  if (!fit.ok) return;
  guess_curves(subject, curves, fit.point);
  h.adequacy = subject.adequacy(fit.residual);
  for (const CauseScore& s : score_causes(subject, fit)) h.scores.push_back(summarise(subject, s));
  h.misses = subject.misses(fit.residual);
  for (const BlockReplay& b : replay_blocks(subject, fit.point)) h.misses.push_back({b.block, b.missing});
  ScoredBlocks blocks = score_blocks(subject, fit.point, known);
  h.scores.insert(h.scores.end(), blocks.scores.begin(), blocks.scores.end());
  h.misses.insert(h.misses.end(), blocks.misses.begin(), blocks.misses.end());
  for (HealthyScore& s : score_drive(log, known)) h.scores.push_back(std::move(s));
  h.shares = heldout_shares(subject, fit), h.has_shares = true;
}

// Passes over the logs, side by side: each log's work has a subject of its own.
class Passes {
 public:
  Passes(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, int threads, const Stages& stages,
         const std::function<bool(double)>& told, HealthyCounts& counts)
      : logs_(logs), tuned_(tuned), rig_(rig), threads_(threads), stages_(stages), told_(told), counts_(counts) {}

  // work(subject, log, known, h) for each log, from its `so_far` on; `known_of` it from the others. `share`: of all
  // passes, for the progress. What is not done when the call is stopped is none.
  template <class KnownOf, class Work>
  std::vector<std::optional<HealthyLog>> pass(const char* what, double share, const std::vector<HealthyLog>& so_far,
                                              const KnownOf& known_of, const Work& work) {
    std::vector<std::optional<HealthyLog>> out(logs_.size());
    side_by_side(static_cast<int>(logs_.size()), threads_, [&](int piece, int threads) {
      if (stopped_) return;
      const auto at = static_cast<std::size_t>(piece);
      const KnownRig known = known_of(piece);
      Stages of_it;
      if (stages_.keeps()) of_it = stages_.part(what, content_hash(logs_[at]), known);
      const auto make = [&] {
        Counted<HealthyLog> made{so_far[at]};
        ValveSubject subject({logs_[at]}, tuned_, rig_, threads, known);
        subject.stages = of_it;
        work(subject, logs_[at], known, made.made);
        made.simulations = subject.simulations(), made.failed = subject.failed_simulations();
        return made;
      };
      Counted<HealthyLog> kept = of_it.made("whole", make, so_far[at]);
      out[at] = std::move(kept.made);
      tell(share / static_cast<double>(logs_.size()), kept.simulations, kept.failed);
    });
    return out;
  }
  bool stopped() const { return stopped_; }

 private:
  void tell(double share, long simulations, long failed) {
    const std::lock_guard lock(telling_);
    counts_.simulations += simulations, counts_.failed += failed;
    done_ += share;
    if (told_ && !told_(done_)) stopped_ = true;
  }

  const std::vector<Log>& logs_;
  const Table& tuned_;
  const RigFile& rig_;
  int threads_;
  const Stages& stages_;
  const std::function<bool(double)>& told_;
  HealthyCounts& counts_;
  std::mutex telling_;
  double done_ = 0;
  std::atomic<bool> stopped_ = false;
};

std::vector<HealthyLog> those_done(std::vector<std::optional<HealthyLog>> logs) {
  std::vector<HealthyLog> out;
  for (std::optional<HealthyLog>& h : logs)
    if (h) out.push_back(std::move(*h));
  return out;
}

}  // namespace

std::size_t logs_to_score(const std::vector<Log>& own, const std::vector<Log>& others) {
  return own.size() + (show_scatter(own) ? 0 : others.size());
}

HealthyReference score_healthy(const std::vector<Log>& own, const Table& tuned, const RigFile& rig, int threads,
                               HealthyCounts& counts, const std::function<bool(double)>& told,
                               const std::vector<Log>& others, const Stages& stages) {
  std::vector<Log> logs = own;
  if (!show_scatter(own)) logs.insert(logs.end(), others.begin(), others.end());
  std::vector<HealthyLog> begun;
  for (const Log& log : logs) {
    HealthyLog& h = begun.emplace_back();
    h.log = log.path, h.sha256 = log.sha256, h.test = conditions_of(log);
    h.other = begun.size() > own.size();
  }
  Passes passes(logs, tuned, rig, threads, stages, told, counts);
  HealthyReference usual, out;
  usual.logs = those_done(passes.pass(
      "usual", 0.2, begun, [](int) { return KnownRig{}; },
      [](ValveSubject& subject, const Log& log, const KnownRig&, HealthyLog& h) {
        see_what_is_usual(subject, log, h);
      }));
  if (passes.stopped()) return out;
  out.logs = those_done(passes.pass(
      "score", 0.8, usual.logs, [&](int log) { return usual.known(log); }, score));
  return out;
}

int HealthyReference::promising() const {
  return static_cast<int>(std::count_if(logs.begin(), logs.end(), [](const HealthyLog& l) { return !l.other; }));
}

KnownRig HealthyReference::known(int left_out) const {
  KnownRig out;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const HealthyLog& l = logs[i];
    if (static_cast<int>(i) == left_out) continue;
    out.errors.insert(out.errors.end(), l.errors.begin(), l.errors.end());
    if (l.air > 0) out.air.push_back(l.air);
    if (std::isfinite(l.command_slope)) out.command_slope.push_back(l.command_slope);
    if (std::isfinite(l.drive_delay)) out.drive_delay.push_back(l.drive_delay);
  }
  return out;
}

HealthyReference of_causes(const HealthyReference& reference, const Subject& subject) {
  const auto is_one = [&](const HealthyScore& s) {
    return std::any_of(subject.causes().begin(), subject.causes().end(),
                       [&](const Cause& c) { return c.effect == s.effect && place_key(c) == s.where; });
  };
  HealthyReference out = reference;
  for (HealthyLog& log : out.logs) std::erase_if(log.scores, [&](const HealthyScore& s) { return !is_one(s); });
  return out;
}

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
    std::vector<Size> sizes;
    for (std::size_t i = 0; i < cause.score.size(); ++i) {
      const HealthyScore* s = cause.score[i];
      if (s && static_cast<int>(i) != left_out && k < s->sizes.size() && std::isfinite(s->sizes[k].std_error) &&
          std::isfinite(s->sizes[k].size))
        sizes.push_back({s->sizes[k].size, s->sizes[k].std_error * s->sizes[k].std_error, s->thickness});
    }
    if (sizes.size() < explain_constants::enough_healthy) continue;
    const Scatter scatter = scatter_of(sizes);
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
  std::vector<Size> sizes;
  for (const HealthyLog& l : reference_.logs)
    for (const HealthyScore& s : l.scores)
      if (s.effect == of.effect && s.where == of.where && probe < s.sizes.size() &&
          std::isfinite(s.sizes[probe].std_error) && std::isfinite(s.sizes[probe].size))
        sizes.push_back({s.sizes[probe].size, s.sizes[probe].std_error * s.sizes[probe].std_error, s.thickness});
  if (sizes.size() < explain_constants::enough_healthy) return 0;
  const Scatter scatter = scatter_of(sizes);
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

namespace {

// Chance that one more positive number of the same kind is as large.
double chance_above(const std::vector<double>& healthy, double value) {
  return deviate_of(value, healthy, {}).chance_above();
}

}  // namespace

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
