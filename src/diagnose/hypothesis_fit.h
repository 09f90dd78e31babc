// One hypothesis, fitted from one start.
#pragma once
#include <Eigen/Dense>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "diagnose/hypotheses.h"
#include "diagnose/visible.h"
#include "faults/fault.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/fit_work.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/unit_cube.h"
#include "simulate/scenario.h"

namespace servodx {

// What every fit about a log shares.
struct HypothesisData {
  std::vector<const LogData*> logs;
  const ParameterVector& base;
  const ErrorModel& error;
  const HypothesisSettings& settings;
  std::vector<Trajectory> references;  // of each log
  double degrees = 0;                  // independent samples of all channels
};
HypothesisData hypothesis_data(const std::vector<const LogData*>& logs, const ParameterVector& base,
                               const ErrorModel& error, const HypothesisSettings& settings);

// The interval of a size that is `times` as large by another count: it holds the size by either, inside the range that
// was searched. docs/diagnosis.md says which sizes have two counts.
FaultSize counted_in_either(FaultSize size, double times, const FreeValue& searched);
// The interval of a size that is open by a factor besides, `log_sd` its logarithm's standard deviation; inside the
// range that was searched.
FaultSize widened(FaultSize size, double log_sd, const FreeValue& searched);

struct Attempt {
  const Fault* fault = nullptr;
  double start = 0;  // of the severity
  const Fault* beside = nullptr;
  double start_beside = 0;
  int scattered = 0;  // of health: which of the starts around the usual one; 0: that one
  HypothesisFit fit = {};
  std::vector<double> square =
      {};  // a sample of the first log: mean over the channels of the squared whitened residual
  FitWork work = {};
};

// The better of an attempt and of one begun elsewhere, with the work of both.
void take_better(Attempt& attempt, Attempt other);

// The attempt's own problem, over so many threads; and where it begins: health's end, or what `from` came to.
FitProblem problem_of(Attempt& attempt, const HypothesisData& data, int threads = 1);
Point start_of(const Attempt& attempt, const FitProblem& problem, const HypothesisFit* from);

// Goes on where the attempt got to before; else begins at its start and, for the rest, at what `from` came to, health
// or the first fault alone.
void run(Attempt& attempt, const HypothesisData& data, const HypothesisFit* from, int iterations);

// The attempt's work, or what a checkpoint has of it. `how`: it goes on; `from`: as run() and approach() take it.
void through_checkpoint(Attempt& attempt, const HypothesisData& data, std::string_view how, const HypothesisFit* from,
                        int iterations, const std::function<void()>& work);

// Where a fit ended, of health mostly, and what it could make of a change there.
struct FitEnd {
  Eigen::VectorXd residual;  // of the logs, whitened
  HealthyAnswer answer;
  Eigen::VectorXd gradient;  // of half the misfit; not zero where a wall holds a value
  std::vector<FreeValue> free;
};
// Health as the table has it, nothing fitted.
HypothesisFit unfitted(const HypothesisData& data);
// None where the fit failed.
std::optional<FitEnd> end_of(const HypothesisFit& fit, const HypothesisData& data, FitWork& work);

// As `run`, by the derivatives that `end` has: only those of what it lacks, a fault's own, are taken anew, so that a
// step costs a few runs. Of a large fault it ends halfway, and `run` goes on from there.
void approach(Attempt& attempt, const HypothesisData& data, const HypothesisFit* from, const FitEnd& end,
              int iterations);

struct Screened {
  const Fault* fault = nullptr;
  double severity = 0, misfit = 1e300;  // with the rest as in health, or as with the first fault alone
  double left = 1e300;                  // of it, once the rest moves as its linear model there says
  const Fault* beside = nullptr;        // then `severity` is of this one
  double gain = -1;                     // over health, were this fault there (visible.h); negative: not known
  FitWork work = {};
};
// `end` null: nothing moves, and it is not asked how visible the fault is.
void screen(Screened& screened, const HypothesisData& data, const HypothesisFit& from, const FitEnd* end = nullptr);

}  // namespace servodx
