// One whitening for all hypotheses about a log: sigma(t) of the error model, where the tuned model says things move.
#pragma once
#include <vector>

#include "fit/error_model.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "simulate/scenario.h"

namespace servodx {

// The trajectory at the tuned values: it says where things move, and so where the model may err, for all alike.
Trajectory reference_of(const LogData& log, const ParameterVector& base, int threads);
// The same of several candidates, in their order.
std::vector<Trajectory> references_of(const LogData& log, const std::vector<const ParameterVector*>& candidates,
                                      int threads);

// `log`: its position in the problem.
void whiten(FitProblem& problem, int log, const ErrorModel& error, const Trajectory& reference);

// A sample of the first log: mean over the channels of the squared whitened residual.
std::vector<double> squares(const FitProblem& problem, const Eigen::VectorXd& residual, const ErrorModel& error);

}  // namespace servodx
