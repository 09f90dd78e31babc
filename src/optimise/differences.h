// A Jacobian by differences, all its points in one batch, steps taken into the box. A column whose points fail is tried
// on the other side, then given up (zero).
#pragma once
#include <functional>
#include <vector>

#include "optimise/unit_cube.h"

namespace servodx {

// One evaluation a point; `ok` false where a point cannot be used.
using EvaluatePoints = std::function<std::vector<Evaluation>(const std::vector<Point>&)>;

struct DifferenceStep {
  double step = 1e-5;    // of the box
  bool central = false;  // 2n points in place of n
};

// Returns how many columns were given up.
int take_differences(const EvaluatePoints& evaluate, const Point& here, const Eigen::VectorXd& residual,
                     DifferenceStep by, Eigen::MatrixXd& jacobian);

}  // namespace servodx
