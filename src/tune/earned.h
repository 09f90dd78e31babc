// Which of the freed effects the logs have earned. A fit gives a free number a value whether or not the valve has what
// it stands for: it takes up what the model has wrong. So an effect stays only where the last part of each log, which
// the fit has not seen, is told better with it than without.
//
// Without an effect, the other numbers move where the derivatives at the fit's end say; that point is then run, and
// its cost on the held-out part compared. The derivatives hold nearby alone, so an effect that is far from off is
// rather kept: the point is worse than a fit without it would be. The effect that is missed least goes first, and the
// others are asked again without it.
#pragma once
#include <vector>

#include "fit/problem.h"
#include "optimise/problem.h"
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
