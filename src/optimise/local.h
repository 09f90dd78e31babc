// The local stage of a fit: our bounded search from afar (box_least_squares.h), then Ceres from where it ended
// (ceres_refinement.h), and NLopt's BOBYQA (derivative_free.h) where the derivatives have proved false. Each goes on
// from the best so far and none ends above it.
//
// The two share one budget of Jacobians: Ceres may take what our search has left, and has the step for which the last
// one was never used. An end that has converged keeps its bits: Ceres agrees after one evaluation.
//
// Derivatives have proved false where columns of the Jacobian could not be had, or where no step that promises more
// than the tolerance lowers the cost and yet the Jacobian promises far more.
#pragma once
#include <functional>

#include "optimise/box_least_squares.h"
#include "optimise/ceres_refinement.h"
#include "optimise/unit_cube.h"

namespace servodx {

enum class LocalMethod { search_then_ceres, ceres_alone, search_alone };

enum class Distrust { none, missing_columns, broken_promise };

struct LocalOptions {
  LocalMethod method = LocalMethod::search_then_ceres;
  CeresBudget ceres;
  // The caller's `progress` also stops a search that has settled: Ceres goes on from there.
  bool after_interruption = false;
  // Of BOBYQA, where derivatives have proved false; 0: never. Only where the loss is none.
  long rescue_evaluations = 0;
  double trusted_if_less = 0;  // of the cost: a promise of no more that no step keeps is no proof of false derivatives
  std::function<bool()> stop;  // true: no further stage begins
  // Makes our search, or brings its end from elsewhere; empty: it is made.
  std::function<LeastSquaresResult(const std::function<LeastSquaresResult()>& search)> through = {};
  std::function<long()> simulations;  // runs so far, for what each stage has cost; empty: evaluations are counted
};

// What a stage has cost and gained.
struct StageGain {
  double before = 0, after = 0;  // cost
  long simulations = 0;
  int jacobians = 0;
  double seconds = 0;
};

struct LocalResult {
  LeastSquaresResult end;
  StageGain search, refinement, rescue;
  CeresSummary ceres;
  Distrust distrust = Distrust::none;  // other than none: BOBYQA has run
};

LocalResult minimise_locally(const LeastSquaresProblem& problem, const Point& start,
                             const LeastSquaresOptions& options = {}, const LocalOptions& local = {});

}  // namespace servodx
