#include "explain/score_healthy.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "evidence/conditions.h"
#include "evidence/log_scatter.h"
#include "explain/block_replay.h"
#include "explain/blocks.h"
#include "explain/cause_score.h"
#include "explain/cause_sizes.h"
#include "explain/drive.h"
#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/hold_out.h"
#include "explain/kept.h"
#include "explain/learnt_curves.h"
#include "explain/score.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/scenario.h"
#include "simulate/side_by_side.h"

namespace servodx {
namespace {

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

}  // namespace servodx
