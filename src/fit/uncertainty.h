// What a fit knows, by differences as wide as what it does not know.
//
// Rows that shift the spool's zero (four laps, null, sensor offset) cancel to some parts in ten thousand. Derivatives
// by small steps are less exact than that where friction and backlash roughen the response, and what is left of the
// cancellation would pass for information. So the derivatives are taken once more along ways that do not go together, a
// third of a standard error either way, and the point may move by what they say: the principal axes of what the logs
// share, which each log's own follow, and then of each log's own beside them, all logs at once.
// Limits: priors on flat directions are wide; a step ends at the wall of the box.
#pragma once
#include <Eigen/Dense>
#include <vector>

#include "fit/problem.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct Uncertainty {
  Point point;                 // of the same or a lower cost
  Eigen::MatrixXd covariance;  // of the unit intervals; zero where not kept
};

// jacobian: at the point, by small steps; kept: columns that count.
Uncertainty uncertainty(const FitProblem& problem, const Point& point, const Eigen::MatrixXd& jacobian,
                        const std::vector<char>& kept);

}  // namespace servodx
