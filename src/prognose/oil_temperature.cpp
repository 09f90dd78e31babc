#include "prognose/oil_temperature.h"

#include <algorithm>
#include <cmath>

#include "base/celsius.h"
#include "fit/candidate_of.h"
#include "fit/error_model.h"
#include "fit/free_values.h"
#include "fit/oil_of.h"
#include "fit/problem.h"
#include "fit/tuned_state.h"
#include "model/state.h"
#include "optimise/box_least_squares.h"
#include "optimise/local.h"
#include "optimise/unit_cube.h"
#include "prognose/constants.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// Misfit of a healthy valve at an oil temperature, nuisances fitted.
double misfit_at(const LogData& log, const Table& tuned, const ErrorModel& error, int threads, long* simulations) {
  const ParameterVector base = candidate_of(tuned);
  SimulateOptions options;
  options.threads = threads;
  FitProblem problem({&log}, base, nuisance_values(log, 0, base, oil_null_limit), options);
  problem.difference_step = difference_step;
  const Point start = problem.start();
  apply_error_model(problem, error, start);
  LeastSquaresOptions o;
  o.max_iterations = oil_iterations;
  o.difference = Difference::forward;
  const LeastSquaresResult r = minimise_locally(problem.least_squares(), start, o).end;
  *simulations += problem.simulations();
  return r.reason == StopReason::start_failed ? 1e300 : 2 * r.misfit;
}

}  // namespace

OilTemperature estimate_temperature(const LogData& log, const Table& tuned, const RigFile& rig, int threads,
                                    long* simulations, const std::function<void(double part)>& told,
                                    const std::function<bool()>& stop) {
  const ErrorModel error = error_model_of(tuned);
  std::vector<double> kelvin, misfit;
  for (double celsius = coldest_celsius; celsius <= hottest_celsius; celsius += celsius_step) {
    LogData at = log;
    kelvin.push_back(celsius + zero_celsius);
    at.scenario.oil = oil_of(rig.fluid, kelvin.back());
    at.scenario.oil_known = true;
    misfit.push_back(misfit_at(at, tuned, error, threads, simulations));
    if (told) told((celsius - coldest_celsius + celsius_step) / (hottest_celsius - coldest_celsius + celsius_step));
    if (stop && stop()) break;
  }
  const double least = *std::min_element(misfit.begin(), misfit.end());
  double sum = 0, first = 0, second = 0;
  for (std::size_t i = 0; i < kelvin.size(); ++i) {
    const double p = std::exp(-0.5 * (misfit[i] - least));
    sum += p, first += p * kelvin[i], second += p * kelvin[i] * kelvin[i];
  }
  const double centre = first / sum;
  const double grid = celsius_step / 3.4641016151377544;  // [K] spread of a step of the grid
  return {centre, std::hypot(std::sqrt(std::max(0.0, second / sum - centre * centre)), grid), OilSource::estimated};
}

}  // namespace servodx
