// What the steps of a tune share: what was asked for, how far it is, what it has cost.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "base/stages.h"
#include "base/stopwatch.h"
#include "fit/problem.h"
#include "optimise/ceres_refinement.h"
#include "optimise/local.h"
#include "servodx/tune.h"
#include "tune/constants.h"
#include "tune/tune.h"

namespace servodx {

class TuneWatch {
 public:
  explicit TuneWatch(const TuneOptions& asked) : options(asked) {}
  const TuneOptions& options;
  std::vector<ConvergencePoint> convergence;
  std::vector<StageResult> stages;
  CeresSummary ceres;                  // of the last fit
  Distrust distrust = Distrust::none;  // of its derivatives
  Stages kept;                         // by a checkpoint: of these logs, this table and rig

  bool stopped() const { return options.watch.stopped(); }
  // Simulations of problems that are done, and of one that is at work.
  long simulations(const FitProblem& at_work) const { return simulations_ + at_work.simulations(); }
  long failed(const FitProblem& at_work) const { return failed_ + at_work.failed_simulations(); }
  // What a stage begins with: points of convergence that it leaves count from the first run on.
  std::vector<long> work_so_far(const FitProblem& at_work) const {
    return {simulations_, failed_, at_work.simulations(), at_work.failed_simulations()};
  }
  void done_with(const FitProblem& problem) {
    simulations_ += problem.simulations();
    failed_ += problem.failed_simulations();
  }
  // A step in which nothing is minimised: what it has cost since `simulations` had run.
  void add_step(Stage::Kind kind, long simulations, Stopwatch& clock, const FitProblem& at_work) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    stages.push_back({{kind}, StageMethod::none, none, none, this->simulations(at_work) - simulations, 0, clock.lap()});
  }
  void tell(double part, const FitProblem& at_work) { options.watch.tell("tune", part, simulations(at_work)); }
  void mark(Stage stage, const FitProblem& at_work, double cost) {
    convergence.push_back({stage, simulations(at_work), cost});
  }

 private:
  long simulations_ = 0, failed_ = 0;
};

}  // namespace servodx
