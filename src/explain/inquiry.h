// What is asked of which logs: the valve as a subject of the engine, each of several logs by itself, and what healthy
// logs say of either. Made once; the steps of explain_logs share it.
#pragma once
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "base/stages.h"
#include "explain/beside_healthy.h"
#include "explain/blocks.h"
#include "explain/cause_score.h"
#include "explain/engine.h"
#include "explain/explain.h"
#include "explain/fit_causes.h"
#include "explain/healthy.h"
#include "explain/hold_out.h"
#include "explain/kin.h"
#include "explain/learnt_curves.h"
#include "explain/score_healthy.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "parameters/table.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {

using SizesByLog = std::vector<std::vector<HealthyScore>>;  // [log][cause]

// One of several logs by itself, as healthy logs are taken.
struct LoneLog {
  LoneLog(const Log& log, const Table& tuned, const RigFile& rig, int threads, const std::optional<KnownRig>& known,
          const Stages& stages);
  ValveSubject subject;
  ExplainedFit fit;
};

class Inquiry {
 public:
  // `healthy` may be null. Throws InputError where logs or table cannot be used.
  Inquiry(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, const HealthyReference* healthy,
          const ExplainOptions& options);
  Inquiry(const Inquiry&) = delete;  // the engine's questions point into it
  Inquiry& operator=(const Inquiry&) = delete;

  const std::vector<Log>& logs() const { return logs_; }
  const ExplainOptions& options() const { return options_; }
  ValveSubject& subject() { return subject_; }
  const ValveSubject& subject() const { return subject_; }
  const Cause& cause(int cause) const { return subject_.causes()[static_cast<std::size_t>(cause)]; }
  const std::vector<Curve>& curves() const { return curves_; }
  const Curve& curve_of(int cause) const;
  // Healthy logs of all tests: so many promise a rate of false alarms. Whether one of them is of the suspects' test.
  int healthy_logs() const { return healthy_logs_; }
  bool alike() const { return speaking_.alike; }
  const HealthyTest* test() const { return test_ ? &*test_ : nullptr; }
  const HealthyReference& speaking() const { return speaking_.logs; }  // what the test is made of
  const std::optional<KnownRig>& known() const { return known_; }
  const std::deque<LoneLog>& lone() const { return lone_; }
  // Of what was asked of the suspects ahead of the engine's work.
  const HealthyCounts& beforehand() const { return beforehand_; }
  bool has_name(const Cause& cause) const;  // and is not left out on request

  // The engine's options for causes that have a name, and for learnt curves.
  EngineOptions for_names();
  EngineOptions for_curves();

  // Chance below which a size or what is left is news; shares have a level of their own.
  double level() const { return engine_.level; }
  Folds folds() const { return engine_.hold_out(); }
  // Chance that healthy logs are left with as much: as tuned the blocks are asked too, which know of no effects.
  double chance_left(const ExplainedFit& fit, bool as_tuned) const;
  // Chance that healthy logs score a curve's cause like this.
  double chance_of(const CauseScore& score) const { return engine_.p_new(score, 0); }

 private:
  bool suspects_take_all_air(const Table& tuned, const RigFile& rig);
  EngineOptions engine_options() const;
  void score_lone_logs(const std::function<bool(const Cause&)>& among);

  const std::vector<Log>& logs_;
  const ExplainOptions& options_;
  std::optional<KnownRig> known_;
  ValveSubject subject_;
  SpeakingLogs speaking_;  // the test points into it
  int healthy_logs_ = 0;
  std::optional<HealthyTest> test_;
  std::deque<LoneLog> lone_;  // one log is itself: empty
  SizesByLog sizes_;
  HealthyCounts beforehand_;
  std::vector<Curve> curves_;
  EngineOptions engine_;
};

// The engine's question whether healthy logs score a cause like this, each log by itself, as the healthy ones were
// taken. `by_log` is looked at when asked; all three have to outlive it.
std::function<double(const CauseScore&, int round)> chance_of_size(const HealthyTest& test, const Subject& subject,
                                                                   const SizesByLog& by_log);

}  // namespace servodx
