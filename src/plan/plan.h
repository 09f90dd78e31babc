// The plan of a test: the command, its pieces, and what it and a random test of the same length would show.
#pragma once
#include <optional>
#include <vector>

#include "diagnose/baseline.h"
#include "parameters/table.h"
#include "plan/goal.h"
#include "servodx/log.h"
#include "servodx/plan.h"
#include "servodx/rig.h"

namespace servodx {

// Behind the front door's figures, for pages.
struct TestPlan {
  GoalKind kind = GoalKind::find;
  PlanLimits limits;            // in effect
  double rated_current = 0.02;  // [A]
  std::vector<double> piston;   // [m] of the tuned valve; empty on a test stand
};

// `baseline` and `like` may be null. Throws InputError.
PlannedTest plan_of(const Table& tuned, const RigFile& rig, const PlanOptions& options,
                    const DetectionBaseline* baseline, const Log* like);

}  // namespace servodx
