// The local stage from several starts at once, and how many of them agree: the honest measure of how much to trust a
// minimum. The runs advance in step and their points are merged, so that one call to `evaluate` fills the lanes and
// threads of all of them; each run is the run it would have been alone, bit for bit, provided a point's residual does
// not depend on its neighbours in the batch. Limits: agreement is judged by cost, since along a weakly identified
// direction equal fits lie apart; `distance` tells how far.
#pragma once
#include <string>
#include <vector>

#include "optimise/box_least_squares.h"
#include "optimise/problem.h"

namespace servodx {

struct MultiStartOptions {
  LeastSquaresOptions local;     // its `progress` is called by one run at a time, from the run's own thread
  double basin_relative = 1e-3;  // a run has reached the best basin when its cost is within this part of the best cost,
  double basin_absolute = 1e-9;  // or within this of it
  void validate() const;
};

struct MultiStartRun {
  Point start;
  Point point;
  double cost = 0;      // infinite when the start failed
  double distance = 0;  // largest coordinate difference to the best point
  bool in_best_basin = false;
  long evaluations = 0;
  int iterations = 0;
  StopReason reason = StopReason::start_failed;
  std::string stopped;
};

struct MultiStartResult {
  LeastSquaresResult best;          // whole, with residual and Jacobian
  std::vector<MultiStartRun> runs;  // in the order of the starts
  int best_run = -1;                // -1: no start could be evaluated
  int reached = 0;                  // runs in the best basin, the best one included
  long evaluations = 0;
  long failed_evaluations = 0;
  std::string summary;  // "7 of 10 starts reached the best cost 512.3 (within 0.1 %); next best 530.1"
};

MultiStartResult minimise_from_starts(const LeastSquaresProblem& problem, const std::vector<Point>& starts,
                                      const MultiStartOptions& options = {});

}  // namespace servodx
