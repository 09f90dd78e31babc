// The tuned model as a test bench: a command is played to every lane, and what comes back is how large their effects
// are, and how they overlap, in the error model's deviates; and how far the valve went.
//
// The Gram matrix of the whitened effects is all that the figures of a test need. Effects of pieces played one after
// another add up in it, as far as a piece does not remember the one before.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "fit/error_model.h"
#include "fit/log_data.h"
#include "plan/lanes.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/plan.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "simulate/scenario.h"

namespace servodx {

struct TestRun {
  bool ok = false;       // the tuned valve stayed among the finite numbers
  Eigen::MatrixXd gram;  // of the lanes' effects [deviates^2]; a lane that failed has none
  PlannedTest::Extremes extremes;
  std::vector<double> piston;  // [m] of the tuned valve; empty on a test stand
};

class TestBench {
 public:
  // `like` may be null: the sensors of the tuning logs, each as noisy as the model is wrong, oil at 40 degC.
  TestBench(const Table& tuned, const RigFile& rig, const Log* like, double rate, int threads);

  // A log as the test's will be, its inputs constant: what it measures and how well.
  const LogData& pattern() const { return pattern_; }
  double rated_current() const { return pattern_.scenario.rated_current; }  // [A]
  double degrees(double seconds) const;                                     // independent samples of all channels
  // Commands [1 of rated current], one a sample.
  std::vector<TestRun> play(std::span<const std::vector<double>> waves, const LaneSet& set);
  const std::vector<Note>& notes() const { return notes_; }
  long simulations() const { return simulations_; }
  long failed_simulations() const { return failed_; }

 private:
  LogData log_of(const std::vector<double>& wave) const;
  TestRun measure(LogData log, const Trajectory& base, std::span<const Trajectory> lanes, const LaneSet& set) const;
  ErrorModel error_;
  LogData pattern_;
  double rate_;
  int threads_;
  std::vector<Note> notes_;
  long simulations_ = 0, failed_ = 0;
};

}  // namespace servodx
