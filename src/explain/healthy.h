// What healthy logs say of each cause, so that a rig's standing discrepancy is not taken for news.
//
// Every real rig differs from its model a little even when healthy, and from log to log. A cause's score on a healthy
// log is a size with a standard error. score_healthy.h makes the reference, beside_healthy.h sets a log beside it.
#pragma once
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "evidence/conditions.h"
#include "explain/blocks.h"
#include "explain/cause_score.h"
#include "explain/subject.h"
#include "explain/valve.h"

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

// What it says of this subject's causes alone: a family of their own, where the subject has data of its own.
HealthyReference of_causes(const HealthyReference& reference, const Subject& subject);

}  // namespace servodx
