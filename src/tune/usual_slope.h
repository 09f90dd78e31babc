// What the logs of a tune say of the recorder: how the command runs between samples, usual and spread.
#pragma once
#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "fit/problem.h"
#include "fit/recorder.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct SlopeOfLog {
  double value = 0, std_error = 0;  // [-] of the command between samples
};
// The logs' values pooled as random effects (DerSimonian & Laird 1986): logs that do not tell it count for little, and
// recorders that differ from log to log spread it. None of fewer than `enough_slopes` logs.
std::optional<CommandSlope> usual_slope(const std::vector<SlopeOfLog>& logs);

// Of the logs of a fit that free it. `jacobian`, `covariance`: at the point, of the unit intervals; a value that a wall
// holds is known no better than its column alone says.
std::vector<SlopeOfLog> slopes_of(const FitProblem& problem, const Point& point, const Eigen::MatrixXd& jacobian,
                                  const Eigen::MatrixXd& covariance);

}  // namespace servodx
