#include "explain/inquiry.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/stages.h"
#include "evidence/conditions.h"
#include "evidence/tail_law.h"
#include "explain/beside_healthy.h"
#include "explain/cause_sizes.h"
#include "explain/constants.h"
#include "explain/kept.h"
#include "explain/score.h"
#include "fit/log_data.h"
#include "fit/ports_of.h"
#include "parameters/list.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "signals/rig_content.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

std::optional<KnownRig> known_of(const HealthyReference* healthy) {
  return healthy ? std::optional<KnownRig>(healthy->known()) : std::nullopt;
}

Stages stages_of_inquiry(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                         const std::optional<KnownRig>& known, const ExplainOptions& options) {
  if (!options.watch.checkpoint) return {};
  std::vector<std::string> content;
  for (const Log& log : logs) content.push_back(content_hash(log));
  return {options.watch, "explain", content, content_hash(tuned), content_bytes(rig), known};
}

}  // namespace

LoneLog::LoneLog(const Log& log, const Table& tuned, const RigFile& rig, int threads,
                 const std::optional<KnownRig>& known, const Stages& stages)
    : subject({log}, tuned, rig, threads, known) {
  if (stages.keeps()) subject.stages = stages.part("one log", content_hash(log));
  const std::vector<Curve> curves = add_curves(subject);
  fit = fit_base(subject, explain_constants::base_iterations);
  if (fit.ok) guess_curves(subject, curves, fit.point);
}

Inquiry::Inquiry(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, const HealthyReference* healthy,
                 const ExplainOptions& options)
    : logs_(logs),
      options_(options),
      known_(known_of(healthy)),
      subject_(logs, tuned, rig, options.threads, known_),
      sizes_(logs.size()) {
  subject_.stages = stages_of_inquiry(logs, tuned, rig, known_, options);
  if (healthy && logs.size() > 1)
    for (const Log& log : logs) lone_.emplace_back(log, tuned, rig, options.threads, known_, subject_.stages);
  if (healthy) {
    std::vector<TestConditions> tests;
    for (const Log& log : logs) tests.push_back(conditions_of(log));
    const bool some_take_all = std::any_of(healthy->logs.begin(), healthy->logs.end(), takes_all_air);
    const bool suspects_do = some_take_all && suspects_take_all_air(tuned, rig);
    speaking_ = logs_that_speak(shares_marked(*healthy, tests, suspects_do), tests);
    healthy_logs_ = healthy->promising();
    test_.emplace(speaking_.logs, subject_.thickness());
  }
  curves_ = add_curves(subject_);
  engine_ = engine_options();
  // A sweep says most in the few seconds that it is near null.
  if (all_on_test_stand(logs, rig)) engine_.blocks *= explain_constants::blocks_of_sweep;
}

bool Inquiry::suspects_take_all_air(const Table& tuned, const RigFile& rig) {
  const auto takes_all = [](const ValveSubject& subject, const ExplainedFit& fit) {
    return fit.ok && subject.own_at_end(row::air_fraction, fit.point);
  };
  if (!lone_.empty())
    return std::any_of(lone_.begin(), lone_.end(), [&](const LoneLog& log) { return takes_all(log.subject, log.fit); });
  // A subject of its own: a fit weighs the one that it is of by what it leaves.
  ValveSubject alone(logs_, tuned, rig, options_.threads, known_);
  const bool out = takes_all(alone, fit_base(alone, explain_constants::base_iterations));
  beforehand_ = {alone.simulations(), alone.failed_simulations()};
  return out;
}

EngineOptions Inquiry::engine_options() const {
  EngineOptions o;
  o.seed = options_.seed;
  o.stop = options_.watch.stop;
  o.level = options_.level;
  if (!test_) {
    o.least_share = explain_constants::least_worth;
    return o;
  }
  if (test_->shares().logs() > 0) {
    o.p_share = [this](const Cause& cause, double share) { return test_->shares().chance(cause.effect, share); };
    o.level_of_shares = rate_of_question(options_.level, healthy_logs_, explain_constants::of_shares);
    o.level = rate_of_question(options_.level, healthy_logs_, 1 - explain_constants::of_shares);
  }
  o.p_new = chance_of_size(*test_, subject_, sizes_);
  o.p_left = [this](const ExplainedFit& fit, LeftOf what, int round) {
    return chance_left(fit, what == LeftOf::rows_and_blocks && round == 0);
  };
  return o;
}

const Curve& Inquiry::curve_of(int cause) const {
  return *std::find_if(curves_.begin(), curves_.end(), [&](const Curve& c) { return c.cause == cause; });
}

bool Inquiry::has_name(const Cause& c) const {
  return !c.curve && std::find(options_.without.begin(), options_.without.end(), c.effect) == options_.without.end();
}

void Inquiry::score_lone_logs(const std::function<bool(const Cause&)>& among) {
  for (std::size_t l = 0; l < lone_.size(); ++l) {
    if (!lone_[l].fit.ok) continue;
    for (const CauseScore& s : score_causes(lone_[l].subject, lone_[l].fit, among))
      if (!s.probes.empty()) sizes_[l].push_back(summarise(lone_[l].subject, s));
  }
}

EngineOptions Inquiry::for_names() {
  EngineOptions o = engine_;
  o.progress = [this](double f) { options_.watch.tell("explain", f, subject_.simulations()); };
  o.among = [this](const Cause& c) { return has_name(c); };
  score_lone_logs(o.among);
  return o;
}

EngineOptions Inquiry::for_curves() {
  EngineOptions o = engine_;
  o.progress = [this](double f) { options_.watch.tell("explain", f, subject_.simulations()); };
  o.among = [](const Cause& c) { return c.curve; };
  o.most = 1, o.fitted = o.judged = explain_constants::curves_fitted;
  score_lone_logs(o.among);
  return o;
}

double Inquiry::chance_left(const ExplainedFit& fit, bool as_tuned) const {
  std::vector<Miss> misses = subject_.misses(fit.residual);
  if (as_tuned)
    for (const BlockReplay& b : replay_blocks(subject_, fit.point)) misses.push_back({b.block, b.missing});
  return test_->any(misses);
}

std::function<double(const CauseScore&, int)> chance_of_size(const HealthyTest& test, const Subject& subject,
                                                             const SizesByLog& by_log) {
  return [&](const CauseScore& s, int round) {
    std::vector<HealthyScore> scores;
    const HealthyScore whole = summarise(subject, s);
    if (round == 0)
      for (const auto& log : by_log)
        for (const HealthyScore& h : log)
          if (h.effect == whole.effect && h.where == whole.where) scores.push_back(h);
    if (scores.empty()) scores.push_back(whole);
    return test.together(test.alone(scores));
  };
}

}  // namespace servodx
