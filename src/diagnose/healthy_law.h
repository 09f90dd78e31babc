// What fault-free logs say of a suspect's two questions, each with a null of its own and its own share of the rate.
//
//   like a fault    the largest gain of any fault over health, in deviates; healthy logs' largest gains (tail_law.h)
//   unlike health   how wrong the worst channel is left under health; healthy logs' (log_scatter.h)
//
// A healthy log that the model does not follow is an answer about the model: it sets the limits of suspects of a test
// like its own that the model does not follow either, and of no other.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/constants.h"
#include "evidence/conditions.h"
#include "evidence/log_scatter.h"
#include "evidence/tail_law.h"

namespace servodx {

// Whether the model follows a log about as well as those that tuned it, by its adequacy.
bool is_followed(double adequacy);

// What the law has to know of a suspect: its test, and the adequacy of the hypothesis that leaves least.
struct SuspectLog {
  TestConditions test;
  double adequacy = 0;
  std::size_t logs = 1;  // pooled: the worst of so many is compared with healthy logs one by one
};
SuspectLog suspect_of(const Assessment& assessment);

class HealthyLaw {
 public:
  // `suspect` null: logs of any test that the model follows. At least one score.
  HealthyLaw(const DetectionBaseline& baseline, const SuspectLog* suspect);

  int logs() const { return static_cast<int>(positions_.size()); }
  const std::vector<std::size_t>& positions() const { return positions_; }  // of these logs among the scores
  double limit() const { return limit_; }                                   // of a gain [deviates]
  // How far a suspect is from health, on the scale of the gain: beyond the limit it is not healthy.
  double error_of(double gain, double adequacy) const;
  double chance_of_gain(double gain) const { return gains_.chance(gain * gain); }
  double rate() const { return rate_of(diagnose_constants::share_of_gain); }  // of the gain
  // Of such logs, until such a gain would be beyond the limit; 0: it is, or the limit is not set by their number.
  int logs_needed(double gain) const;

 private:
  double rate_of(double share) const;  // of a question

  std::vector<std::size_t> positions_;
  TailLaw gains_;
  std::vector<double> adequacies_;
  double asked_ = 0, limit_ = 0, unlike_limit_ = 0;
  std::optional<int> promising_;  // logs that promise a rate; logs of other tests promise none
};

}  // namespace servodx
