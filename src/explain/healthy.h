// What healthy logs say of each cause, so that a rig's standing discrepancy is not taken for news.
//
// Every real rig differs from its model a little even when healthy, and from log to log. A cause's score on a healthy
// log is a size with a standard error; over the logs the sizes scatter beyond it (random effects). A new log's size is
// news where it lies outside what that predicts, by Student's t. With n logs no distribution-free test can promise less
// than 1/(n + 1); the tail beyond is an assumption, and the result says so.
//
// Sizes scatter widely where a test hardly shows a cause, and then no size is news. So a log is also looked at whole:
// if a block of the model or a channel misses more than healthy logs do, something is new whatever its name.
#pragma once
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/stages.h"
#include "evidence/conditions.h"
#include "explain/blocks.h"
#include "explain/cause_score.h"
#include "explain/engine.h"
#include "explain/share_null.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "optimise/unit_cube.h"
#include "parameters/table.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "signals/rig_file.h"

namespace servodx {

// A cause's sizes on one log, one a probe; a probe of several directions is their root mean square.
struct HealthyScore {
  std::string effect, where;  // place_key of the cause
  std::vector<ProbeScore> sizes;
  double gain = 0;                  // predicted fall of the deviance
  double prior = 1;                 // its share of the false alarms beside the others'
  double thickness = std::nan("");  // ln of the viscosity of the log's oil (Subject::thickness)
};
// What a cause removes of a healthy log's held-out misfit, found as a suspect's is.
struct HealthyShare {
  std::string effect, where;
  double share = 0, lower = 0;  // and the lower end of its interval
  double prior = 1;
};
struct HealthyLog {
  std::string log, sha256;
  bool other = false;                  // of another test than the baseline's own, or one that tuned: promises no rate
  bool sets_no_share = false;          // the model follows tests like the suspects', and not this one (kin.h)
  std::optional<TestConditions> test;  // files of earlier versions have none
  double adequacy = 1;                 // misfit over independent samples, re-tuned
  std::vector<HealthyScore> scores;
  std::vector<Miss> misses;
  std::vector<HealthyShare> shares;
  bool has_shares = false;  // they were looked for
  std::vector<UsualError> errors;
  double air = std::nan("");            // [-] free air, as fitted
  double command_slope = std::nan("");  // of the command between samples, as fitted
  double drive_delay = std::nan("");    // [s] from the command to the coil current; where the log has both
};
struct HealthyReference {
  std::vector<HealthyLog> logs;
  bool empty() const { return logs.empty(); }
  int promising() const;  // logs: all but the others
  KnownRig known(int left_out = -1) const;
};

// The place of a cause among the scores: what tells a curve apart from others at its place stands behind a slash.
std::string place_key(const Cause& cause);
HealthyScore summarise(const Subject& subject, const CauseScore& score);
// The same of the blocks' replay of a valve's logs; `at`: a point of valve.fit({}). Empty: no log shows the blocks.
struct ScoredBlocks {
  std::vector<HealthyScore> scores;
  std::vector<Miss> misses;
};
ScoredBlocks score_blocks(const ValveSubject& valve, const Point& at, const KnownRig& known);
// What the driver shows of each cause; empty where the log has not both command and coil current.
std::vector<HealthyScore> score_drive(const Log& log, const KnownRig& known);
struct HealthyCounts {
  long simulations = 0, failed = 0;
};
// Each log is scored as a suspect will be: weighed by what the other logs say is usual. `told`: fraction done; false
// from it ends the work, and the logs that are done are returned. `others`: of other tests, or those that tuned the
// table; they are scored, as such, where `logs` are of too few tests to show how sizes scatter from test to test.
// `stages`: of this table and rig.
HealthyReference score_healthy(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, int threads,
                               HealthyCounts& counts, const std::function<bool(double)>& told = {},
                               const std::vector<Log>& others = {}, const Stages& stages = {});
// How many of them it scores.
std::size_t logs_to_score(const std::vector<Log>& logs, const std::vector<Log>& others);

// What it says of this subject's causes alone: a family of their own, where the subject has data of its own.
HealthyReference of_causes(const HealthyReference& reference, const Subject& subject);

// The tests that a reference answers.
class HealthyTest {
 public:
  // `thickness` of the suspects (Subject::thickness): shares that follow the oil are judged at theirs. Not
  // known: every healthy log speaks alike.
  explicit HealthyTest(const HealthyReference& reference, double thickness = std::nan(""));
  // Chance that healthy logs show sizes like these of this cause, a score each log; 1 where fewer than three healthy
  // logs speak of it. Logs of one state share its oil and its day: over them only the noise averages out, and not what
  // else scatters from one healthy log to another. Tails that are longer than Student's are learnt: a cause's own
  // chances on the healthy logs, each beside the others, say how far its chances can be believed. A rare cause has its
  // share of the false alarms and no more: its chance counts over its prior (Genovese et al. 2006).
  double alone(const std::vector<HealthyScore>& logs) const;
  // The same with all causes counted together: how small the smallest of a healthy log's chances is, is learnt from the
  // healthy logs themselves, each against the others: -ln(1 - p) is taken as exponential, its predictive is Lomax's. A
  // cause that held-out data of that log refuse is not counted, as no suspect is accused by such a one.
  double together(double alone) const;
  // How far a size of this cause lies from none on healthy logs, and what a log with this standard error scatters
  // beyond it: root of the sum of squares; 0 where fewer than three speak of it. [of the probe]
  double spread(const HealthyScore& of, std::size_t probe) const;
  // Chance that a part misses as much in a healthy log; 1 where fewer than three speak of it.
  double miss(const Miss& part) const;
  // Of shares of the held-out misfit.
  const ShareNull& shares() const { return shares_; }
  // That any of these parts does, by Bonferroni.
  double any(const std::vector<Miss>& parts) const;

 private:
  struct OfCause {
    std::vector<const HealthyScore*> score;  // [healthy log] null: it does not speak of the cause
    std::vector<double> surprise;            // [healthy log] -ln of its chance by Student's law beside the others
  };
  const OfCause* of(const HealthyScore& cause) const;
  double by_law(const OfCause& cause, const std::vector<HealthyScore>& logs, int left_out) const;
  double believed(const OfCause& cause, double surprise, int left_out, double prior) const;
  const HealthyReference& reference_;
  std::map<std::pair<std::string, std::string>, OfCause> causes_;
  ShareNull shares_;
  std::vector<double> smallest_;  // [healthy log] of its chances beside the others
};

}  // namespace servodx
