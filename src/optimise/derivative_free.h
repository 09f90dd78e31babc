// Least squares without derivatives, for where differences are not to be trusted (friction that sticks and slips, a
// piston at its stops): NLopt's BOBYQA (Powell 2009), a quadratic model through points that it has visited, in a box.
//
// One point at a time, so lanes and threads run empty: some ten times the wall time of box_least_squares.h where that
// works, and it stops short on badly scaled problems. Failed points cost a large finite number.
#pragma once
#include <functional>

#include "optimise/search_stop.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct DerivativeFreeOptions {
  long max_evaluations = 2000;
  double first_step = 0.05;                                     // of the box
  double cost_tolerance = 1e-6;                                 // relative
  double step_tolerance = 1e-5;                                 // of the box
  std::function<bool(long evaluations, double cost)> progress;  // false asks to stop; the best so far is returned
};

struct DerivativeFreeResult {
  Point point;
  double cost = 0;  // 0.5*|residual|^2
  long evaluations = 0, failed_evaluations = 0;
  SearchStop stop;
};

DerivativeFreeResult minimise_without_derivatives(int n, const BatchEvaluate& evaluate, const Point& start,
                                                  const DerivativeFreeOptions& options = {});

}  // namespace servodx
