#include "diagnose/hypothesis_fit.h"

#include <algorithm>
#include <cmath>

#include "diagnose/constants.h"
#include "diagnose/severity.h"
#include "diagnose/whitening.h"
#include "faults/fault.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/box_least_squares.h"
#include "optimise/local.h"
#include "optimise/problem.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

FitProblem problem_of(const HypothesisData& data, const std::vector<FreeValue>& free) {
  SimulateOptions options;
  options.threads = 1;
  return {{&data.log}, data.base, free, options};
}

Point starting_point(const HypothesisFit& so_far, const FitProblem& problem, const HypothesisFit* health) {
  if (so_far.ok) return so_far.point;
  Point x = problem.start();
  if (health && health->ok)
    for (std::size_t j = 0; j < x.size(); ++j)
      for (std::size_t i = 0; i < health->free.size(); ++i)
        if (problem.free()[j].name == health->free[i].name) x[j] = health->point[i];
  return x;
}

LeastSquaresResult minimise(FitProblem& problem, const Point& from, int iterations, const std::function<bool()>& stop) {
  LeastSquaresOptions o;
  o.max_iterations = iterations;
  o.difference = Difference::forward;
  o.cost_tolerance = k::cost_tolerance;
  o.damping_trials = 1;  // the hypotheses fill each other's packs: no lane is free
  o.progress = [&](const LeastSquaresProgress&) { return !(stop && stop()); };
  LocalOptions local;
  local.ceres.max_steps = 1;  // one trial and no Jacobian: hypotheses are many, and their fits short
  local.ceres.max_jacobians = 0;
  local.stop = stop;
  return minimise_locally(problem.least_squares(), from, o, local).end;
}

// A value on its bound has no error; a fault's severity, the first, has one everywhere.
std::vector<double> standard_errors(const LeastSquaresResult& r, bool of_fault) {
  std::vector<char> kept(r.point.size());
  for (std::size_t j = 0; j < kept.size(); ++j)
    kept[j] = (of_fault && j == 0) || (r.point[j] > k::on_bound && r.point[j] < 1 - k::on_bound);
  const Eigen::MatrixXd covariance = covariance_of(r.jacobian, kept);
  std::vector<double> errors;
  for (std::size_t j = 0; j < kept.size(); ++j)
    errors.push_back(std::sqrt(std::max(0.0, covariance(static_cast<long>(j), static_cast<long>(j)))));
  return errors;
}

void measure_channels(HypothesisFit& fit, const FitProblem& problem, const Eigen::VectorXd& residual,
                      const HypothesisData& data) {
  const std::size_t samples = data.log.scenario.time.size();
  for (std::size_t c = 0; c < data.log.channels.size(); ++c) {
    const auto [at, n] = problem.rows(0, static_cast<int>(c));
    const ChannelError* e = data.error.find(data.log.channels[c].signal);
    const double effective = effective_of(e, data.log.scenario.time);
    const auto present = static_cast<double>(std::max(1L, present_samples(data.log.channels[c])));
    fit.channel_adequacy.push_back(std::sqrt(residual.segment(at, n).squaredNorm() / present / effective));
    double raw = 0;
    for (std::size_t i = 0; i < samples; ++i) {
      const double v = residual[at + static_cast<long>(i)] * problem.sigma(0, static_cast<int>(c))[i];
      raw += v * v;
    }
    fit.channel_rms.push_back(std::sqrt(raw / present));
  }
}

// The curvature at the end, inflated where the model does not fit as well as it should, and the fault's own spread.
void measure_severity(HypothesisFit& fit, const Fault& fault) {
  const FreeValue& severity = fit.free[0];
  const double at = fit.point[0];
  const double worst = *std::max_element(fit.channel_adequacy.begin(), fit.channel_adequacy.end());
  const double range = fault.log_scale ? std::log(severity.upper / severity.lower) : severity.upper - severity.lower;
  const double half =
      k::deviates_of_95 * std::hypot(fit.standard_error[0] * std::max(1.0, worst), fault.spread / range);
  fit.severity = severity.from_unit(at);
  const auto beyond_health = [&](double u) { return std::abs(severity.from_unit(u) - fault.healthy); };
  const double mild = beyond_health(0.0) < beyond_health(1.0) ? 0.0 : 1.0;
  fit.at_least = std::abs(at - mild) < k::at_end_part;
  fit.at_worst = std::abs(at - (1 - mild)) < k::at_end_part;
  fit.severity_lower = severity.from_unit(std::clamp(at - half, 0.0, 1.0));
  fit.severity_upper = severity.from_unit(std::clamp(at + half, 0.0, 1.0));
}

}  // namespace

void run(Attempt& a, const HypothesisData& data, const HypothesisFit* health, int iterations) {
  const std::function<bool()>& stop = data.settings.stop;
  if (stop && stop()) return;
  HypothesisFit& fit = a.fit;
  fit.fault = a.fault;
  fit.free = hypothesis_values(data.log, data.base, a.fault, a.start, data.settings.null_limit);
  FitProblem problem = problem_of(data, fit.free);
  problem.difference_step = k::difference_step;
  whiten(problem, data.error, data.reference);
  const LeastSquaresResult r = minimise(problem, starting_point(fit, problem, health), iterations, stop);
  a.work.add({problem.simulations(), problem.failed_simulations()});
  fit.stops = {r.stopped};
  fit.standard_error.clear(), fit.channel_adequacy.clear(), fit.channel_rms.clear();
  if (r.reason == StopReason::start_failed) return;
  fit.ok = true;
  fit.misfit = 2 * r.misfit;
  fit.point = r.point;
  fit.standard_error = standard_errors(r, a.fault != nullptr);
  a.square = squares(problem, r.residual, data.error);
  measure_channels(fit, problem, r.residual, data);
  if (a.fault) measure_severity(fit, *a.fault);
}

void screen(Screened& s, const HypothesisData& data, const HypothesisFit& health) {
  // The unit interval of a severity depends on its sign.
  FitProblem problem =
      problem_of(data, hypothesis_values(data.log, data.base, s.fault, s.severity, data.settings.null_limit));
  whiten(problem, data.error, data.reference);
  const Point x = starting_point({}, problem, &health);
  const Evaluation e = problem.evaluate(std::span(&x, 1)).front();
  if (e.ok) s.misfit = e.residual.squaredNorm();
  s.work = {problem.simulations(), problem.failed_simulations()};
}

}  // namespace servodx
