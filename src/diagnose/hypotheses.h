// The hypotheses about one log, or about several of one valve in one state, each fitted to the same data with the same
// whitening. Several logs share severities and tolerances; null, air and the like are each log's own.
//
// Healthy is not a point: every fault's severity may wander within its tolerance (up to `least`, with a prior of half
// of that), the null within its limit. A fault's hypothesis lets its own severity run from `least` to the worst, all
// else as in health. So a gain of a fault over health is what only a fault explains.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/stages.h"
#include "diagnose/constants.h"
#include "diagnose/visible.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "faults/sizes.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/fit_work.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/search_stop.h"
#include "optimise/unit_cube.h"
#include "simulate/scenario.h"

namespace servodx {

struct FaultSize {
  const Fault* fault = nullptr;
  double severity = 0;                            // in the fault's unit
  double severity_lower = 0, severity_upper = 0;  // 95 %, from the curvature, cut at the range that was searched
  bool at_least = false, at_worst = false;        // it stands at the mild, at the far end of its range
  std::vector<double> shapes = {};                // of the fault, in its order
};

struct HypothesisFit : FaultSize {       // a null fault: healthy
  std::optional<FaultSize> beside = {};  // a second fault
  bool ok = false;
  double misfit = 1e300;  // -2 log likelihood, priors included
  Point point;
  std::vector<FreeValue> free;
  std::vector<double> standard_error;  // of each free value, of the unit interval
  // Log by log, of each its channels.
  std::vector<double> channel_adequacy;  // whitened rms of a channel; 1 when as wrong as on the tuning logs
  std::vector<double> channel_rms;       // [SI] of the residual, high-passed where the channel is
  std::vector<SearchStop> stops;         // how each start ended
  double promised = 0;                   // misfit that steps would still gain, where they ran out
};

struct HypothesisSettings {
  double null_limit = 0.05;  // [fraction of rated]
  int threads = 0;
  int iterations = diagnose_constants::iterations;
  // Of a genetic search in place of the screened starts (sub_groups.h).
  struct Genetic {
    int population = 50;  // of each sub-group
    std::uint64_t seed = 1;
  };
  std::optional<Genetic> genetic = {};
  bool pairs = true;  // tried where a fault gains beyond doubt
  TimesDrawing times_drawing = {};
  std::vector<const Fault*> among = {};  // weighed beside health; empty: all that are fitted
  std::function<bool()> stop = {};       // true: give up; what comes back is worthless
  std::function<void(double part, long simulations)> progress = {};  // after every fit, from any thread
  Stages stages = {};  // that a checkpoint keeps: of these logs, this base and error model
};

struct HypothesisFits {
  std::vector<HypothesisFit> pairs;    // where one fault leaves much: the best of them with each other one beside it
  std::vector<HypothesisFit> fits;     // healthy first, then the faults fitted, or `among`, in their order
  double degrees = 0;                  // independent samples of all channels
  std::vector<double> healthy_square;  // a sample of the first log: mean over the channels of the squared whitened
                                       // residual under health
  std::vector<VisibleFault> visible;   // of each fault, each side of health
  FitWork work;
};

// The faults that a fit of these logs can show: what an input's own record tells is not fitted.
std::vector<const Fault*> fitted_faults(const std::vector<const LogData*>& logs);

// Index of the fit with the least misfit.
std::size_t best_fit(const HypothesisFits& fits);

HypothesisFits fit_hypotheses(const std::vector<const LogData*>& logs, const ParameterVector& base,
                              const ErrorModel& error, const HypothesisSettings& settings);

}  // namespace servodx
