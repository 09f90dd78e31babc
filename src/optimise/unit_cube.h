// What an optimiser sees: a unit cube and numbers. No hydraulics here.
#pragma once
#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace servodx {

using Point = std::vector<double>;  // in the unit cube, one entry a free parameter

// Residuals of many points at once; the caller packs them into lanes and threads. A failed point has `ok` false and an
// empty residual.
struct Evaluation {
  bool ok = true;
  Eigen::VectorXd residual;  // whitened; 0.5*|residual|^2 is the misfit
};
using BatchEvaluate = std::function<std::vector<Evaluation>(std::span<const Point>)>;

// Costs only, for the genetic algorithm. A failed point has a large finite cost.
using BatchCost = std::function<std::vector<double>(std::span<const Point>)>;

// Costs of points that count only up to their bounds, one a point, infinite where a cost always counts: for a point
// that is sure to be above its own, any number above it may come back.
using BoundedCost = std::function<std::vector<double>(std::span<const Point>, std::span<const double> bounds)>;

}  // namespace servodx
