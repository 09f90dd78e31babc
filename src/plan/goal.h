// What a test is to tell, as one number that the search makes large, and what it would show, as figures.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "faults/fault.h"
#include "plan/information.h"
#include "plan/lanes.h"
#include "servodx/plan.h"

namespace servodx {

enum class GoalKind { find, part, estimate };  // faults; two faults from one another; rows

// Faults: a sum of squared distances, each over itself plus a half, so that what is told beyond doubt gains little by
// more. Rows: the mean logarithm of how many times smaller their errors are.
double worth_of(const Information& information, const LaneSet& set, GoalKind kind);

// What a finding has to pass.
struct FindingLaw {
  double threshold = 0;                           // [deviates]
  std::map<std::string, double> usual_gain = {};  // of each fault on healthy logs [deviates^2]
  double degrees = 1;                             // independent samples of the test
};
FindingLaw usual_law(double false_alarm);

// `set`: targets, and rivals at severities fine enough to look for the least one.
PlannedTest::Figures figures_of(const Information& information, const LaneSet& set, GoalKind kind,
                                const FindingLaw& law);

}  // namespace servodx
