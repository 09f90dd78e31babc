// What a residual is weighed by on the way to a tuned model, and what of each log is left out of the misfit.
#pragma once
#include <cstddef>
#include <vector>

#include "fit/problem.h"
#include "optimise/unit_cube.h"

namespace servodx {

// Of the samples in [from, to) that are there. [SI] 0 where none is.
double rms_of(const std::vector<double>& r, std::size_t from, std::size_t to);

// Whitening before anything is known: the residual's own size, a few tens of independent samples a second. Logs of one
// programme share what they tell (LogData::alike).
void first_whitening(FitProblem& problem, const Point& x);

// On a stand the model's error is a curve of the command, not of time: a fast sweep tells as much of it as a slow one,
// so each counts alike, by its own rms.
void weigh_sweeps(FitProblem& problem, const Point& x);

}  // namespace servodx
