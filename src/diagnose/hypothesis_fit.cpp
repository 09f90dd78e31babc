#include "diagnose/hypothesis_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/random.h"
#include "base/stages.h"
#include "diagnose/constants.h"
#include "diagnose/kept.h"
#include "diagnose/severity.h"
#include "diagnose/whitening.h"
#include "faults/fault.h"
#include "faults/sizes.h"
#include "fit/chart.h"
#include "fit/constants.h"
#include "fit/error_model.h"
#include "fit/fit_work.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/box_least_squares.h"
#include "optimise/local.h"
#include "optimise/unit_cube.h"
#include "parameters/coordinate.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

FitProblem problem_of(const HypothesisData& data, const std::vector<FreeValue>& free, int threads = 1) {
  SimulateOptions options;
  options.threads = threads;
  FitProblem problem(data.logs, data.base, free, options);
  for (std::size_t l = 0; l < data.logs.size(); ++l)
    whiten(problem, static_cast<int>(l), data.error, data.references[l]);
  return problem;
}

bool same_value(const FreeValue& a, const FreeValue& b) {
  return a.name == b.name && a.log == b.log && a.lower == b.lower && a.upper == b.upper;
}

Point starting_point(const HypothesisFit& so_far, const FitProblem& problem, const HypothesisFit* from) {
  if (so_far.ok) return so_far.point;
  Point x = problem.start();
  if (from && from->ok)
    for (std::size_t j = 0; j < x.size(); ++j)
      for (std::size_t i = 0; i < from->free.size(); ++i)
        if (same_value(problem.free()[j], from->free[i])) x[j] = from->point[i];
  return x;
}

// Around the usual start, always the same.
Point scattered_start(Point x, int which) {
  Random random(static_cast<std::uint64_t>(which));
  for (double& u : x) u = std::clamp(u + k::scattered_by * random.normal(), 0.0, 1.0);
  return x;
}

LeastSquaresOptions options_of(int iterations, const HypothesisData& data) {
  const std::function<bool()>& stop = data.settings.stop;
  LeastSquaresOptions o;
  o.max_iterations = iterations;
  o.difference = Difference::forward;
  // A gain counts by the misfit over its degrees, where that is above one; the cost is half of the misfit.
  o.cost_tolerance = std::min(k::worth_a_step, k::worth_a_step / data.degrees);
  o.cost_floor = k::worth_a_step / 2;
  o.damping_trials = 1;  // the hypotheses fill each other's packs: no lane is free
  o.progress = [&stop](const LeastSquaresProgress&) { return !(stop && stop()); };
  return o;
}

LeastSquaresResult minimise(FitProblem& problem, const Point& from, int iterations, const HypothesisData& data) {
  const LeastSquaresOptions o = options_of(iterations, data);
  LocalOptions local;
  local.ceres.max_steps = 1;  // one trial and no Jacobian: hypotheses are many, and their fits short
  local.ceres.max_jacobians = 0;
  local.stop = data.settings.stop;
  return minimise_locally(problem.least_squares(), from, o, local).end;
}

// Columns that the fit which ended there had too are its own at that end; the others are taken where they are asked
// for.
JacobianFunction lent_derivatives(const FitProblem& problem, const FitEnd& end) {
  std::vector<char> own(problem.free().size(), 1);
  std::vector<std::pair<long, long>> lent;  // here, there
  for (std::size_t j = 0; j < own.size(); ++j)
    for (std::size_t i = 0; i < end.free.size(); ++i)
      if (same_value(problem.free()[j], end.free[i]))
        own[j] = 0, lent.push_back({static_cast<long>(j), static_cast<long>(i)});
  return [&problem, &end, own, lent](const Point& x, const Eigen::VectorXd& residual, Eigen::MatrixXd& j) {
    for (const auto& [here, there] : lent) j.col(here).head(problem.data_rows()) = end.answer.derivatives().col(there);
    return problem.columns(x, residual, own, j);
  };
}

// A value on its bound has no error; a fault's severity, the first, has one everywhere.
std::vector<double> standard_errors(const LeastSquaresResult& r, std::size_t faults) {
  std::vector<char> kept(r.point.size());
  for (std::size_t j = 0; j < kept.size(); ++j) kept[j] = j < faults || off_walls(r.point[j]);
  const Eigen::MatrixXd covariance = covariance_of(r.jacobian, kept);
  std::vector<double> errors;
  for (std::size_t j = 0; j < kept.size(); ++j)
    errors.push_back(std::sqrt(std::max(0.0, covariance(static_cast<long>(j), static_cast<long>(j)))));
  return errors;
}

void measure_channel(HypothesisFit& fit, const FitProblem& problem, const Eigen::VectorXd& residual,
                     const HypothesisData& data, int log, int channel) {
  const LogData& of = *data.logs[static_cast<std::size_t>(log)];
  const FitChannel& c = of.channels[static_cast<std::size_t>(channel)];
  const auto [at, n] = problem.rows(log, channel);
  const double effective = effective_of(data.error.find(c.signal), of.scenario.time);
  const auto present = static_cast<double>(std::max(1L, present_samples(c)));
  fit.channel_adequacy.push_back(std::sqrt(residual.segment(at, n).squaredNorm() / present / effective));
  const std::vector<double>& sigma = problem.sigma(log, channel);
  double raw = 0;
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    const double v = residual[at + static_cast<long>(i)] * sigma[i];
    raw += v * v;
  }
  fit.channel_rms.push_back(std::sqrt(raw / present));
}

void measure_channels(HypothesisFit& fit, const FitProblem& problem, const Eigen::VectorXd& residual,
                      const HypothesisData& data) {
  for (std::size_t l = 0; l < data.logs.size(); ++l)
    for (std::size_t c = 0; c < data.logs[l]->channels.size(); ++c)
      measure_channel(fit, problem, residual, data, static_cast<int>(l), static_cast<int>(c));
}

// How many times as large a size is by its other count: a clearance by its drawing, as a tune trades the healthy one
// for the form of the edges; a leak at the oil of the logs, as a scored seal need not leak by the oil's viscosity.
double times_by_other_count(const Fault& fault, const HypothesisData& data) {
  if (fault.stated_at_40_degrees) {
    double thickness = 0;
    for (const LogData* log : data.logs) thickness += std::log(log->scenario.oil.viscosity_ratio);
    return std::exp(-thickness / static_cast<double>(data.logs.size()));
  }
  const auto off = data.settings.times_drawing.find(&fault);
  return off == data.settings.times_drawing.end() ? 1 : off->second;
}

// A size at 40 degC by logs whose oil nobody measured. A rig that does not measure it was tuned with its logs' mean
// taken for 40 degC, so that all its sizes are as open as one log's oil. One standard deviation of the logarithm.
double open_by_oil(const Fault& fault, const HypothesisData& data) {
  const bool measured =
      std::any_of(data.logs.begin(), data.logs.end(), [](const LogData* log) { return log->scenario.oil_known; });
  return fault.stated_at_40_degrees && !measured ? std::log(fit_constants::freed::usual_factor) : 0.0;
}

// The curvature at the end, inflated where the model does not fit as well as it should, the fault's own spread, and
// its other count.
FaultSize measure_severity(const HypothesisFit& fit, const Fault& fault, std::size_t j, const HypothesisData& data) {
  const FreeValue& severity = fit.free[j];
  const double at = fit.point[j];
  const double worst = *std::max_element(fit.channel_adequacy.begin(), fit.channel_adequacy.end());
  const double range = severity.range();
  const double half = k::deviates_of_95 * std::hypot(fit.standard_error[j] * std::max(1.0, worst),
                                                     sizes_of(fault, data.base.data()).spread / range);
  const auto beyond_health = [&](double u) { return std::abs(severity.from_unit(u) - fault.healthy); };
  const double mild = beyond_health(0.0) < beyond_health(1.0) ? 0.0 : 1.0;
  FaultSize size;
  size.fault = &fault;
  size.severity = severity.from_unit(at);
  size.at_least = std::abs(at - mild) < k::at_end_part;
  size.at_worst = std::abs(at - (1 - mild)) < k::at_end_part;
  size.severity_lower = severity.from_unit(std::clamp(at - half, 0.0, 1.0));
  size.severity_upper = severity.from_unit(std::clamp(at + half, 0.0, 1.0));
  return widened(counted_in_either(size, times_by_other_count(fault, data), severity), open_by_oil(fault, data),
                 severity);
}

}  // namespace

FaultSize widened(FaultSize size, double log_sd, const FreeValue& searched) {
  if (!(log_sd > 0 && size.severity > 0)) return size;
  const auto factor = [&](double end) {
    return std::exp(std::hypot(std::log(end / size.severity), k::deviates_of_95 * log_sd));
  };
  const double lower = size.severity_lower, upper = size.severity_upper;
  size.severity_lower = std::min(lower, std::max(searched.lower, size.severity / factor(lower)));
  size.severity_upper = std::max(upper, std::min(searched.upper, size.severity * factor(upper)));
  return size;
}

FaultSize counted_in_either(FaultSize size, double times, const FreeValue& searched) {
  const auto [lower, upper] = std::minmax({size.severity_lower, size.severity_upper});
  const double lowest = lower * std::min(1.0, times), highest = upper * std::max(1.0, times);
  size.severity_lower = std::min(lower, std::max(lowest, searched.lower));
  size.severity_upper = std::max(upper, std::min(highest, searched.upper));
  return size;
}

namespace {

double independent_samples(const std::vector<const LogData*>& logs, const ErrorModel& error) {
  double sum = 0;
  for (const LogData* log : logs)
    for (const FitChannel& c : log->channels)
      sum += static_cast<double>(present_samples(c)) * effective_of(error.find(c.signal), log->scenario.time);
  return sum;
}

}  // namespace

HypothesisData hypothesis_data(const std::vector<const LogData*>& logs, const ParameterVector& base,
                               const ErrorModel& error, const HypothesisSettings& settings) {
  HypothesisData data{logs, base, error, settings, {}, independent_samples(logs, error)};
  for (const LogData* log : logs) data.references.push_back(reference_of(*log, base, settings.threads));
  return data;
}

namespace {

std::vector<FreeValue> free_of(const Attempt& a, const HypothesisData& data) {
  return hypothesis_values(data.logs, data.base, {{a.fault, a.start}, {a.beside, a.start_beside}},
                           data.settings.null_limit, data.settings.times_drawing);
}

}  // namespace

void take_better(Attempt& attempt, Attempt other) {
  FitWork work = attempt.work;
  work.add(other.work);
  if (other.fit.ok && other.fit.misfit < attempt.fit.misfit) attempt = std::move(other);
  attempt.work = work;
}

FitProblem problem_of(Attempt& a, const HypothesisData& data, int threads) {
  a.fit.fault = a.fault;
  a.fit.free = free_of(a, data);
  FitProblem problem = problem_of(data, a.fit.free, threads);
  problem.difference_step = k::difference_step;
  return problem;
}

Point start_of(const Attempt& a, const FitProblem& problem, const HypothesisFit* from) {
  Point start = starting_point(a.fit, problem, from);
  return a.scattered > 0 && !a.fit.ok ? scattered_start(std::move(start), a.scattered) : start;
}

namespace {

void end_at(Attempt& a, const FitProblem& problem, const LeastSquaresResult& r, const HypothesisData& data) {
  HypothesisFit& fit = a.fit;
  a.work.add({problem.simulations(), problem.failed_simulations()});
  fit.stops = {r.stop};
  fit.standard_error.clear(), fit.channel_adequacy.clear(), fit.channel_rms.clear();
  if (r.reason == StopReason::start_failed) return;
  fit.ok = true;
  fit.misfit = 2 * r.misfit;
  fit.promised = r.reason == StopReason::iteration_limit ? 2 * r.promised_gain : 0.0;
  fit.point = r.point;
  fit.standard_error = standard_errors(r, a.beside ? 2 : a.fault ? 1 : 0);
  a.square = squares(problem, r.residual, data.error);
  measure_channels(fit, problem, r.residual, data);
  // The sizes come first, then the shapes.
  std::size_t at = a.beside ? 2 : 1;
  const auto shapes_of = [&](const Fault& fault) {
    std::vector<double> shapes;
    for (std::size_t i = 0; i < fault.shapes.size(); ++i, ++at) shapes.push_back(fit.free[at].from_unit(fit.point[at]));
    return shapes;
  };
  if (a.fault) {
    static_cast<FaultSize&>(fit) = measure_severity(fit, *a.fault, 0, data);
    fit.shapes = shapes_of(*a.fault);
  }
  if (a.beside) {
    fit.beside = measure_severity(fit, *a.beside, 1, data);
    fit.beside->shapes = shapes_of(*a.beside);
  }
}

}  // namespace

void run(Attempt& a, const HypothesisData& data, const HypothesisFit* from, int iterations) {
  const std::function<bool()>& stop = data.settings.stop;
  if (stop && stop()) return;
  through_checkpoint(a, data, "run", from, iterations, [&] {
    FitProblem problem = problem_of(a, data);
    end_at(a, problem, minimise(problem, start_of(a, problem, from), iterations, data), data);
  });
}

void approach(Attempt& a, const HypothesisData& data, const HypothesisFit* from, const FitEnd& end, int iterations) {
  const std::function<bool()>& stop = data.settings.stop;
  if (stop && stop()) return;
  through_checkpoint(a, data, "approach", from, iterations, [&] {
    FitProblem problem = problem_of(a, data);
    LeastSquaresProblem lent = problem.least_squares();
    lent.jacobian = lent_derivatives(problem, end);
    const Point start = start_of(a, problem, from);
    LeastSquaresOptions how = options_of(iterations, data);
    how.given_learns = !a.fault;  // a fault's own derivatives are worth their few runs
    LocalOptions local;
    local.method = LocalMethod::search_alone;  // `run` ends with Ceres
    local.stop = stop;
    end_at(a, problem, minimise_locally(lent, start, how, local).end, data);
  });
}

void through_checkpoint(Attempt& a, const HypothesisData& data, std::string_view how, const HypothesisFit* from,
                        int iterations, const std::function<void()>& work) {
  const Stages& stages = data.settings.stages;
  if (!stages.keeps()) return work();
  // Of a fault no one asks for the squares.
  const auto as_it_is = [&] { return KeptAttempt{a.fit, a.fault ? std::vector<double>{} : a.square, a.work}; };
  const auto made = [&] {
    work();
    return as_it_is();
  };
  const std::optional<HypothesisFit> start = from ? std::optional(*from) : std::nullopt;
  KeptAttempt kept =
      stages.made(how, made, a.fault, a.start, a.beside, a.start_beside, a.scattered, as_it_is(), start, iterations);
  a.fit = std::move(kept.fit), a.square = std::move(kept.square), a.work = kept.work;
  a.fit.free = free_of(a, data);
}

HypothesisFit unfitted(const HypothesisData& data) {
  Attempt health;
  const FitProblem problem = problem_of(health, data);
  health.fit.point = problem.start();
  health.fit.ok = true;
  return std::move(health.fit);
}

std::optional<FitEnd> end_of(const HypothesisFit& fit, const HypothesisData& data, FitWork& work) {
  if (!fit.ok) return {};
  FitProblem problem = problem_of(data, fit.free);
  problem.difference_step = k::difference_step;
  const Evaluation e = problem.evaluate(std::span(&fit.point, 1)).front();
  Eigen::MatrixXd jacobian;
  const bool had = e.ok && problem.jacobian(fit.point, e.residual, jacobian);
  work.add({problem.simulations(), problem.failed_simulations()});
  if (!had) return {};
  return FitEnd{e.residual.head(problem.data_rows()),
                {jacobian, fit.point, problem.data_rows()},
                jacobian.transpose() * e.residual,
                fit.free};
}

void screen(Screened& s, const HypothesisData& data, const HypothesisFit& from, const FitEnd* end) {
  // The unit interval of a severity depends on its sign.
  const std::vector<FaultStart> faults = s.beside
                                             ? std::vector<FaultStart>{{s.fault, from.severity}, {s.beside, s.severity}}
                                             : std::vector<FaultStart>{{s.fault, s.severity}};
  FitProblem problem = problem_of(
      data, hypothesis_values(data.logs, data.base, faults, data.settings.null_limit, data.settings.times_drawing));
  const Point x = starting_point({}, problem, &from);
  const Evaluation e = problem.evaluate(std::span(&x, 1)).front();
  if (e.ok) s.misfit = s.left = e.residual.squaredNorm();
  if (e.ok && end) {
    const Eigen::VectorXd change = e.residual.head(problem.data_rows()) - end->residual;
    s.gain = end->answer.left_of(change);
    s.left -= end->answer.taken(end->gradient + end->answer.derivatives().transpose() * change);
  }
  s.work = {problem.simulations(), problem.failed_simulations()};
}

}  // namespace servodx
