// Which of the freed effects the logs have earned. A fit gives a free number a value whether or not the valve has what
// it stands for: it takes up what the model has wrong. So an effect stays only where the last part of each log, which
// the fit has not seen, is told better with it than without.
//
// Without an effect, the other numbers move to the floor of the seen part, by the derivatives; the point is run, and
// its cost on the held-out part compared. An effect that is missed there is asked once more from that point, as
// derivatives hold nearby alone. The effect that is missed least goes first, and the others are asked again without it.
// What two steps leave of the way to the floor speaks for an effect, so one too many rather stays.
#pragma once
#include <vector>

#include "fit/problem.h"
#include "optimise/unit_cube.h"
#include "tune/scope.h"
#include "tune/tune.h"
#include "tune/watch.h"

namespace servodx {

// `end`: of the fit that left out the last part `held` of each log; `problem` weighs all of each log. Effects that are
// not earned are set off in the scope and leave its shared values; `end` becomes the point from which the fit goes on,
// in the numbers that are left. In the order of trial.
std::vector<EarnedEffect> keep_earned(TuneScope& scope, const FitProblem& problem, double held, Point& end,
                                      TuneWatch& watch);

}  // namespace servodx
