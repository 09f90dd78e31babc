#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/require_setting.h"
#include "diagnose/constants.h"
#include "diagnose/hypotheses.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "faults/sizes.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/fast_log.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/tuned_state.h"
#include "optimise/unit_cube.h"
#include "parameters/table.h"
#include "servodx/check_log.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "tune/tune.h"

namespace servodx {
namespace {

void whiten_about(FitProblem& problem, const ErrorModel& error, const Point& x) {
  if (!error.channels.empty()) return apply_error_model(problem, error, x);
  const LogData& log = *problem.logs().front();
  const double effective = effective_of(nullptr, log.scenario.time);
  for (std::size_t c = 0; c < log.channels.size(); ++c)
    problem.set_sigma(0, static_cast<int>(c), 2 * log.channels[c].noise / std::sqrt(effective));
}

double typical_of(const FaultSizes& sizes) { return std::abs(sizes.starts.back()); }

// Length of what is left of `r` when the columns of `j` (nuisances, their priors included) have taken their best.
double left_over(const Eigen::VectorXd& r, const Eigen::MatrixXd& j) {
  if (j.cols() == 0) return r.norm();
  return (r - j * j.colPivHouseholderQr().solve(r)).norm();
}

std::vector<Identifiable> identifiable_rows(const FitProblem& problem, const Table& table,
                                            const Eigen::MatrixXd& jacobian, const Point& x) {
  std::vector<char> candidates;
  for (const FreeValue& f : problem.free()) candidates.push_back(f.log < 0);
  const Identifiability id = identify(jacobian, candidates);
  std::vector<char> kept;
  for (const RowVerdict verdict : id.verdict) kept.push_back(verdict == RowVerdict::bounded);
  const Eigen::MatrixXd covariance = covariance_of(jacobian, kept);
  std::vector<Identifiable> rows;
  for (std::size_t j = 0; j < kept.size(); ++j) {
    const FreeValue& f = problem.free()[j];
    const int at = table.find(f.name);
    if (!candidates[j] || at < 0) continue;
    const double value = f.from_unit(x[j]);
    Identifiable row{f.name, table[at].unit, kept[j] ? RowVerdict::bounded : id.verdict[j], value, std::nan(""), {}};
    const auto k = static_cast<long>(j);
    const double per_unit = f.slope(value);
    if (kept[j]) row.std_error = std::sqrt(std::max(0.0, covariance(k, k))) * per_unit;
    for (const int other : id.confounded_with[j])
      row.confounded_with.push_back(problem.free()[static_cast<std::size_t>(other)].name);
    rows.push_back(std::move(row));
  }
  return rows;
}

// The log's nuisances and every fault's severity, as values of one problem.
std::vector<FreeValue> with_faults(std::vector<FreeValue> nuisances, const ParameterVector& base,
                                   const std::vector<const Fault*>& faults) {
  for (const Fault* fault : faults) {
    const double worst = sizes_of(*fault, base.data()).worst;
    FreeValue f;
    f.name = fault->name;
    f.apply = fault->apply;
    f.lower = std::min(fault->healthy, worst);
    f.upper = std::max(fault->healthy, worst);
    f.start = fault->healthy;
    nuisances.push_back(std::move(f));
  }
  return nuisances;
}

// Health, then each fault at its least and at a typical size.
std::vector<Point> points_of_faults(const FitProblem& problem, std::size_t nuisances,
                                    const std::vector<FaultSizes>& sizes) {
  std::vector<Point> points = {problem.start()};
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    for (const double severity : {sizes[k].least, typical_of(sizes[k])}) {
      Point p = points.front();
      p[nuisances + k] = problem.free()[nuisances + k].to_unit(severity);
      points.push_back(std::move(p));
    }
  }
  return points;
}

// A row beyond its limit must not be fitted away by the log's own value of that row.
Eigen::MatrixXd own_columns(const Eigen::MatrixXd& of_nuisances, const std::vector<FreeValue>& nuisances,
                            const Fault& fault) {
  Eigen::MatrixXd own = of_nuisances;
  for (std::size_t j = 0; j < nuisances.size(); ++j)
    if (nuisances[j].at == fault.beyond_limit_of) own.col(static_cast<long>(j)).setZero();
  return own;
}

// What each fault that this log can show adds to the residual, nuisances fitted away.
std::vector<Visible> visible_faults(const LogData& data, const ParameterVector& base, const ErrorModel& error,
                                    const std::vector<FreeValue>& nuisances, const Eigen::MatrixXd& jacobian,
                                    const SimulateOptions& options, long& simulations) {
  const std::vector<const Fault*> faults = fitted_faults({&data});
  std::vector<FaultSizes> sizes;
  for (const Fault* fault : faults) sizes.push_back(sizes_of(*fault, base.data()));
  FitProblem problem({&data}, base, with_faults(nuisances, base, faults), options);
  whiten_about(problem, error, problem.start());
  const std::vector<Evaluation> runs = problem.evaluate(points_of_faults(problem, nuisances.size(), sizes));
  simulations += problem.simulations();
  const long n = problem.data_rows();
  const auto count = static_cast<long>(nuisances.size());
  const Eigen::MatrixXd of_nuisances = jacobian.block(0, jacobian.cols() - count, n, count);
  std::vector<Visible> out;
  for (std::size_t k = 0; k < faults.size(); ++k) {
    const Fault& fault = *faults[k];
    const Eigen::MatrixXd own = own_columns(of_nuisances, nuisances, fault);
    const auto deviate = [&](const Evaluation& e) {
      return e.ok && runs.front().ok ? left_over((e.residual - runs.front().residual).head(n), own) : std::nan("");
    };
    out.push_back({std::string(fault.name), std::string(fault.unit), sizes[k].least, typical_of(sizes[k]),
                   deviate(runs[1 + 2 * k]), deviate(runs[2 + 2 * k])});
  }
  return out;
}

}  // namespace

Promise promise_of(const Log& log, const Table& table, const RigFile& rig, int threads) {
  require_threads(threads);
  const LogData data = prepare_at_points(log, rig, recorder_of(table));
  require_channels(data);
  const Table facts = apply_rig_facts(table, rig);
  const ParameterVector base = candidate_of(facts);
  const ErrorModel error = error_model_of(facts);
  SimulateOptions options;
  options.threads = threads;
  Promise promise;
  promise.error_known = !error.channels.empty();

  std::vector<FreeValue> free = shared_values(facts);
  const std::vector<FreeValue> nuisances = nuisance_values(data, 0, base, diagnose_constants::tuned_null_limit);
  free.insert(free.end(), nuisances.begin(), nuisances.end());
  FitProblem problem({&data}, base, free, options);
  const Point x = problem.start();
  whiten_about(problem, error, x);
  Evaluation at = problem.evaluate(std::span(&x, 1)).front();
  Eigen::MatrixXd jacobian;
  if (!at.ok || !problem.jacobian(x, at.residual, jacobian))
    throw InputError({.file = table.path}, "the simulation fails at the table's values on " + log.path,
                     "check the table against the rig's data sheet");
  promise.rows = identifiable_rows(problem, facts, jacobian, x);
  promise.simulations = problem.simulations();

  promise.faults = visible_faults(data, base, error, nuisances, jacobian, options, promise.simulations);
  return promise;
}

}  // namespace servodx
