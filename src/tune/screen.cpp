#include "tune/screen.h"

#include <Eigen/Dense>
#include <algorithm>
#include <optional>
#include <span>
#include <tuple>

#include "base/error.h"
#include "base/stopwatch.h"
#include "fit/chart.h"
#include "fit/fit_work.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "optimise/unit_cube.h"
#include "servodx/table.h"
#include "tune/constants.h"
#include "tune/kept.h"
#include "tune/tune.h"
#include "tune/weights.h"

namespace servodx {
namespace {

using namespace tune_constants;

// Change of the residual with each shared value at either end.
void drive_to_bounds(std::vector<ScreenedRow>& rows, const FitProblem& problem, const Point& x,
                     const Evaluation& at_nominal, TuneWatch& watch) {
  std::vector<Point> extremes;
  for (std::size_t j = 0; j < rows.size(); ++j)
    for (double end : {0.0, 1.0}) {
      Point p = x;
      p[j] = end;
      extremes.push_back(p);
    }
  for (std::size_t first = 0; first < extremes.size(); first += most_at_once) {
    const std::size_t n = std::min(most_at_once, extremes.size() - first);
    const std::vector<Evaluation> e = problem.evaluate(std::span(&extremes[first], n));
    for (std::size_t i = 0; i < n; ++i)
      if (e[i].ok)
        rows[(first + i) / 2].effect[(first + i) % 2] =
            (e[i].residual - at_nominal.residual).head(problem.data_rows()).norm();
    watch.tell(work.screen.at(static_cast<double>(first) / static_cast<double>(extremes.size())), problem);
  }
}

// Far from nominal a row may matter that does not here.
bool matters_anywhere(const ScreenedRow& row) {
  return std::any_of(row.effect.begin(), row.effect.end(), [](double e) { return e > least_effect || std::isnan(e); });
}

// The priors' rows count: a nuisance that its prior holds cannot stand in for a row.
void tell_apart(std::vector<ScreenedRow>& rows, const FitProblem& problem, const Eigen::MatrixXd& jacobian) {
  std::vector<char> candidates(static_cast<std::size_t>(problem.n()), 0);
  std::fill(candidates.begin(), candidates.begin() + static_cast<long>(rows.size()), 1);
  const Identifiability id = identify(jacobian, candidates);
  for (std::size_t j = 0; j < rows.size(); ++j) {
    if (id.verdict[j] == RowVerdict::flat && !matters_anywhere(rows[j])) rows[j].verdict = RowVerdict::flat;
    if (id.verdict[j] != RowVerdict::confounded) continue;
    rows[j].verdict = RowVerdict::confounded;
    for (int k : id.confounded_with[j])
      rows[j].confounded_with.push_back(problem.free()[static_cast<std::size_t>(k)].name);
  }
}

// An effect that the logs do not tell is not claimed: it goes to its off value.
void hold(TuneScope& scope, const FreeValue& value) {
  const std::optional<double> off = off_value(value.at);
  if (!off) return;
  scope.table.rows[static_cast<std::size_t>(scope.table.find(value.name))].nominal = *off;
  scope.base[static_cast<std::size_t>(value.at)] = *off;
}

}  // namespace

namespace {

struct Screening {
  std::vector<ScreenedRow> rows;
  bool told = false;  // their sensitivities could be had
  FitWork work;
};
auto fields(Screening& s) {
  auto& [rows, told, work] = s;
  return std::tie(rows, told, work);
}

Screening screened(const TuneScope& scope, TuneWatch& watch, const FitProblem& problem, const Point& x,
                   const Evaluation& at_nominal) {
  Screening out;
  for (const FreeValue& f : scope.shared) out.rows.push_back({f.name, RowVerdict::bounded, {}});
  drive_to_bounds(out.rows, problem, x, at_nominal, watch);
  Eigen::MatrixXd jacobian;
  out.told = problem.jacobian(x, at_nominal.residual, jacobian);
  if (out.told) tell_apart(out.rows, problem, jacobian);
  out.work = problem.work();
  return out;
}

}  // namespace

std::vector<ScreenedRow> screen_rows(TuneScope& scope, TuneWatch& watch) {
  Stopwatch clock;
  FitProblem problem = scope.problem();
  const Point x = problem.start();
  first_whitening(problem, x);
  const Evaluation at_nominal = problem.evaluate(std::span(&x, 1)).front();
  if (!at_nominal.ok)
    throw InputError({.file = scope.table.path}, "the simulation fails at the table's nominal values",
                     "check the table against the rig's data sheet");
  Screening out = watch.kept.made("screen", [&] { return screened(scope, watch, problem, x, at_nominal); });
  problem.work() = out.work;
  if (out.told) {
    std::vector<FreeValue> kept;
    for (std::size_t j = 0; j < out.rows.size(); ++j)
      if (out.rows[j].verdict == RowVerdict::bounded)
        kept.push_back(scope.shared[j]);
      else
        hold(scope, scope.shared[j]);
    scope.shared = kept;
  }
  watch.add_step(Stage::Kind::screening, 0, clock, problem);
  watch.done_with(problem);
  return std::move(out.rows);
}

}  // namespace servodx
