// The front door of the misfit: a tune's own problem, for other optimisers and for ours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/require_setting.h"
#include "door/require_samples.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/tuned_state.h"
#include "optimise/box_least_squares.h"
#include "optimise/differences.h"
#include "optimise/unit_cube.h"
#include "report/shared/search_words.h"
#include "servodx/data_sheet.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/objective.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "tune/breadth.h"
#include "tune/scope.h"
#include "tune/search.h"
#include "tune/tune.h"
#include "tune/watch.h"
#include "tune/weights.h"

namespace servodx {
namespace {

TuneOptions scope_options(const Table& table, const ObjectiveOptions& options) {
  TuneOptions to;
  to.threads = options.threads;
  to.effects = table.has_std_error ? std::optional(std::vector<std::string>()) : options.effects;
  if (table.has_std_error) to.moving_average = recorder_of(table).moving_average;
  return to;
}

TuneScope scope_of(const std::vector<Log>& logs, const Table& table, const Rig& rig, const ObjectiveOptions& options) {
  options.validate();
  door::require_samples(logs, rig);
  TuneScope scope = scope_of(logs, table, rig, scope_options(table, options));
  hold_to_sheet(scope.shared, scope.table, scope.facts, {});
  return scope;
}

TuneLocal local_of(Objective::Method method) {
  switch (method) {
    case Objective::Method::ceres:
      return TuneLocal::ceres;
    case Objective::Method::nlopt:
      return TuneLocal::nlopt;
    case Objective::Method::least_squares:
    case Objective::Method::whole:
      return TuneLocal::least_squares;
  }
  return TuneLocal::least_squares;
}

std::vector<Point> points_of(std::span<const double> points, std::size_t n) {
  if (points.empty() || points.size() % n != 0)
    throw InputError({.file = "points"}, fmt::format("{} numbers are no points of {} each", points.size(), n),
                     fmt::format("give points of shape ({},) or (many, {})", n, n));
  std::vector<Point> out;
  for (std::size_t at = 0; at < points.size(); at += n) {
    out.emplace_back(points.begin() + static_cast<long>(at), points.begin() + static_cast<long>(at + n));
    for (const double u : out.back())
      if (!(u >= 0 && u <= 1))
        throw InputError({.file = "points"}, fmt::format("{} lies outside of the unit interval", u),
                         "keep to bounds of 0 and 1");
  }
  return out;
}

Point point_of(std::span<const double> point, std::size_t n) {
  std::vector<Point> points = points_of(point, n);
  if (points.size() != 1)
    throw InputError({.file = "point"}, "is not one point", fmt::format("give one of shape ({},)", n));
  return std::move(points.front());
}

}  // namespace

struct Objective::Inside {
  TuneScope scope;
  FitProblem problem;
  std::vector<Number> numbers;
  std::vector<Part> parts;
  std::size_t rows = 0;
  mutable long searched = 0;  // simulations of genetic searches

  Inside(const std::vector<Log>& logs, const Table& table, const Rig& rig, const ObjectiveOptions& options)
      : scope(scope_of(logs, table, rig, options)), problem(scope.problem()) {
    const Point start = problem.start();
    if (table.has_std_error)
      apply_error_model(problem, error_model_of(table), start);
    else
      scope.on_stand ? weigh_sweeps(problem, start) : first_whitening(problem, start);
    rows = static_cast<std::size_t>(problem.data_rows());
    for (const FreeValue& f : problem.free()) {
      const int row = scope.table.find(f.name);
      numbers.push_back({f.name, row < 0 ? f.unit : scope.table[row].unit, f.lower, f.upper, f.log_scale, f.start,
                         f.prior_sd, f.log});
      rows += std::isfinite(f.prior_sd);
    }
    for (std::size_t l = 0; l < scope.data.size(); ++l)
      for (std::size_t c = 0; c < scope.data[l].channels.size(); ++c) {
        const auto [first, count] = problem.rows(static_cast<int>(l), static_cast<int>(c));
        parts.push_back({scope.data[l].path, scope.data[l].channels[c].signal, static_cast<std::size_t>(first),
                         static_cast<std::size_t>(count)});
      }
  }

  std::vector<Point> starts(Method method, const Point& from, TuneWatch& watch) const {
    std::vector<Point> out = {from};
    if (method != Method::whole || watch.stopped()) return out;
    for (Point& p : search_broadly(scope, from, watch)) out.push_back(std::move(p));
    searched += watch.simulations(problem) - problem.simulations();
    return out;
  }
};

void ObjectiveOptions::validate() const {
  require_threads(threads);
  TuneOptions to;
  to.effects = effects;
  to.validate();
}

void Objective::Budget::validate() const {
  require_setting(iterations >= 1, "Budget.iterations", "must be at least 1", "12 is the default");
  TuneOptions to;
  to.population = population, to.generations = generations;
  to.validate();
}

Objective::Objective(const std::vector<Log>& logs, const Table& table, const Rig& rig, const ObjectiveOptions& options)
    : inside_(std::make_shared<Inside>(logs, table, rig, options)) {}

const std::vector<Objective::Number>& Objective::numbers() const { return inside_->numbers; }
const std::vector<Objective::Part>& Objective::parts() const { return inside_->parts; }
std::size_t Objective::size() const { return inside_->rows; }
std::vector<double> Objective::start() const { return inside_->problem.start(); }
long Objective::simulations() const { return inside_->problem.simulations() + inside_->searched; }
long Objective::failed_simulations() const { return inside_->problem.failed_simulations(); }

std::vector<double> Objective::point_of(const Table& table) const {
  const Table there = apply_rig_facts(table, inside_->scope.facts);
  std::vector<double> values;
  for (const Number& number : inside_->numbers) {
    const int at = number.log < 0 ? there.find(number.name) : -1;
    values.push_back(at < 0 ? number.start : there[at].nominal);
  }
  return point_at(values);
}

std::vector<double> Objective::values_at(std::span<const double> point) const {
  Point values = servodx::point_of(point, inside_->numbers.size());
  for (std::size_t j = 0; j < values.size(); ++j) values[j] = inside_->problem.free()[j].from_unit(values[j]);
  return values;
}

std::vector<double> Objective::point_at(std::span<const double> values) const {
  const std::vector<FreeValue>& free = inside_->problem.free();
  if (values.size() != free.size())
    throw InputError({.file = "values"}, fmt::format("{} are not the {} that are free", values.size(), free.size()),
                     "give one a number, in the order of numbers()");
  std::vector<double> point;
  for (std::size_t j = 0; j < free.size(); ++j) point.push_back(free[j].to_unit(values[j]));
  return point;
}

std::vector<double> Objective::residuals(std::span<const double> points) const {
  std::vector<double> out;
  const std::vector<Point> at = points_of(points, inside_->numbers.size());
  out.reserve(at.size() * size());
  for (const Evaluation& e : inside_->problem.evaluate(at)) {
    if (e.ok)
      out.insert(out.end(), e.residual.begin(), e.residual.end());
    else
      out.insert(out.end(), size(), std::nan(""));
  }
  return out;
}

std::vector<double> Objective::costs(std::span<const double> points) const {
  std::vector<double> out;
  for (const Evaluation& e : inside_->problem.evaluate(points_of(points, inside_->numbers.size())))
    out.push_back(e.ok ? 0.5 * e.residual.squaredNorm() : std::nan(""));
  return out;
}

Objective::Jacobian Objective::jacobian(std::span<const double> point) const {
  const FitProblem& problem = inside_->problem;
  const Point at = servodx::point_of(point, inside_->numbers.size());
  const Evaluation here = std::move(problem.evaluate(std::span(&at, 1)).front());
  Jacobian out;
  if (!here.ok) return out;
  Eigen::MatrixXd j;
  if (!problem.jacobian(at, here.residual, j))
    out.missing = take_differences([&](const std::vector<Point>& points) { return problem.evaluate(points); }, at,
                                   here.residual, {.step = problem.difference_step}, j);
  out.values.resize(static_cast<std::size_t>(j.size()));
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(out.values.data(), j.rows(),
                                                                                     j.cols()) = j;
  return out;
}

Objective::End Objective::minimise(Method method, std::span<const double> start, const Budget& budget) const {
  budget.validate();
  const Point from = servodx::point_of(start, inside_->numbers.size());
  TuneOptions options;
  options.population = budget.population, options.generations = budget.generations, options.seed = budget.seed;
  options.local = local_of(method), options.watch = budget.watch;
  TuneWatch watch(options);
  const long before = simulations();
  const std::vector<Point> starts = inside_->starts(method, from, watch);
  End best;
  best.cost = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < starts.size() && !(watch.stopped() && s > 0); ++s) {
    const double part = 1.0 / static_cast<double>(starts.size());
    const LeastSquaresResult end =
        search_locally(inside_->problem, starts[s], Stage{Stage::Kind::start, static_cast<int>(s) + 1},
                       budget.iterations, s == 0 ? Start::nominal : Start::found,
                       {part * static_cast<double>(s), part * static_cast<double>(s + 1)}, watch);
    if (end.cost < best.cost) best = {end.point, end.cost, 0, report::words_of(end.stop)};
  }
  best.simulations = simulations() - before;
  return best;
}

}  // namespace servodx
