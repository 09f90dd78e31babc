// Ceres Solver's Levenberg-Marquardt on a problem of the unit cube: the local refinement that every fit ends with, and
// a search of its own where it is asked for alone.
//
// Walls: an active set. A coordinate at a wall that the gradient pushes into is held (ceres::SubsetManifold), and let
// go where Ceres has converged and its multiplier has the wrong sign. Ceres' own bounds keep the others in the box; a
// solve ends where one of them meets its wall. What is left to Ceres' bounds alone stalls (tests/optimise/
// ceres_comparison_test.cpp).
//
// Rows: without a loss Ceres sees n + 1 rows, the residual turned in its own space so that all but one row of the
// Jacobian vanish. The method sees J'J, J'e and |e| alone, and these stay; two copies of a tall Jacobian are saved.
// With a loss every row is a residual block of its own under Ceres' LossFunction.
//
// Derivatives: the Jacobian in hand serves the first step. A later one is taken where it may be, and where what the
// last one has learnt from the step (Broyden 1965) promises more than the tolerance.
//
// Limits: one thread, dense normal equations, never above the cost it began with. Source: Agarwal, Mierle and others,
// Ceres Solver 2.1, trust_region_minimizer.cc.
#pragma once
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"

namespace servodx {

enum class CeresEnd {
  not_run,
  converged,       // by a criterion of Ceres
  no_convergence,  // a limit on steps or Jacobians
  failure,         // of a linear solve or an evaluation
  interrupted      // on request
};

struct CeresBudget {
  // Trial steps, of all solves together. The first is nearly always a full Gauss-Newton step; three leave room for two
  // shorter ones where it is refused.
  int max_steps = 3;
  int max_jacobians = 1;  // beside the one in hand
  bool learns = true;     // steps may teach the Jacobian; else a solve ends where it may take no more
  // Of Ceres' line search along a step that its bounds have bent; 0: such a step is taken or refused as it is.
  int line_search_trials = 0;
};

// What Ceres says of its solves, together.
struct CeresSummary {
  CeresEnd end = CeresEnd::not_run;
  int solves = 0;    // one for each set of held walls
  int steps = 0;     // that were taken
  int refused = 0;   // that did not lower the cost
  int released = 0;  // walls that were let go
  int jacobians = 0;
  int learnt = 0;        // Jacobians that a step has taught, in place of new ones
  long evaluations = 0;  // every point asked for, those of differences included
  double initial_cost = 0, final_cost = 0;
};

// Goes on from `end`, whose residual, Jacobian and normal equations are known, and leaves it where Ceres ended. Of the
// options it takes what they say of differences, tolerances and loss.
CeresSummary refine_by_ceres(const LeastSquaresProblem& problem, LeastSquaresResult& end,
                             const LeastSquaresOptions& options, const CeresBudget& budget = {});

// Ceres alone, from a start: as many Jacobians as the options have iterations. `progress` is told of every step.
LeastSquaresResult minimise_by_ceres(const LeastSquaresProblem& problem, const Point& start,
                                     const LeastSquaresOptions& options, CeresSummary* summary = nullptr);

}  // namespace servodx
