#include "tune/settle.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "base/normal.h"
#include "fit/chart.h"
#include "fit/fit_work.h"
#include "fit/identifiability.h"
#include "fit/problem.h"
#include "fit/profile.h"
#include "fit/uncertainty.h"
#include "parameters/coordinate.h"
#include "parameters/table.h"
#include "servodx/note.h"
#include "servodx/tune.h"
#include "tune/constants.h"
#include "tune/kept.h"
#include "tune/named_rows.h"
#include "tune/tune.h"
#include "tune/usual_slope.h"

namespace servodx {
namespace {

using tune_constants::flat_error, tune_constants::one_sided_within;

// A free row's place in the fit and how well it is known there.
struct Known {
  const FreeValue& value;
  std::size_t at;     // in the fit
  double u;           // of the unit interval
  double unit_error;  // the same
  bool held;          // by a bound
};

// What the fit says of a free row.
void take_estimate(ParameterResult& p, Row& row, const Known& known) {
  p.estimate = known.value.from_unit(known.u);
  if (known.held) {
    p.verdict = RowVerdict::at_bound;
  } else {
    p.std_error = std::max(0.0, known.unit_error) * known.value.slope(p.estimate);
    if (known.unit_error > flat_error)
      p.verdict = RowVerdict::flat;
    else if (known.u - one_sided_within * known.unit_error < 0 || known.u + one_sided_within * known.unit_error > 1)
      p.verdict = RowVerdict::one_sided;
    row.std_error = p.std_error;
  }
  row.nominal = p.estimate;
  row.source = "tuned; before: " + row.source;
}

Note profile_note(const ParameterResult& p, const ProfileInterval& interval) {
  return {Note::Kind::profile,
          fmt::format("profile of {}: 95 % from {:.4g}{} to {:.4g}{} {}; by curvature {:.4g} to {:.4g}", p.name,
                      p.profile_lower, interval.lower_open ? " (its bound)" : "", p.profile_upper,
                      interval.upper_open ? " (its bound)" : "", p.unit, p.estimate - normal_95 * p.std_error,
                      p.estimate + normal_95 * p.std_error)};
}

struct KeptProfile {
  ProfileInterval interval;
  FitWork work;
};
auto fields(KeptProfile& p) {
  auto& [lower, upper, lower_open, upper_open] = p.interval;
  return std::tie(lower, upper, lower_open, upper_open, p.work);
}

KeptProfile profile_through(const TuneWatch& watch, const FitProblem& problem, const Point& best, int j,
                            const Eigen::MatrixXd& covariance) {
  const auto made = [&] {
    const ProfileInterval interval = profile(problem, best, j, covariance);
    return KeptProfile{interval, problem.work()};
  };
  if (!watch.kept.keeps()) return made();
  KeptProfile out = watch.kept.made("profile", made, problem.content_hash(), best, j, watch.work_so_far(problem));
  problem.work() = out.work;
  return out;
}

ParameterResult begun(const Row& row, const ScreenedRow& screened) {
  ParameterResult p;
  p.id = row.id;
  p.name = row.name;
  p.unit = row.unit;
  p.nominal = p.estimate = row.nominal;
  p.std_error = std::nan("");
  p.effect_at_lower = screened.effect[0];
  p.effect_at_upper = screened.effect[1];
  p.confounded_with = screened.confounded_with;
  p.verdict = screened.verdict;
  return p;
}

}  // namespace

Settled settle(const TuneScope& scope, const std::vector<ScreenedRow>& screened, const FitProblem& problem,
               const LeastSquaresResult& end, const TuneWatch& watch) {
  std::vector<char> off_bounds(static_cast<std::size_t>(problem.n()), 1);
  for (std::size_t j = 0; j < off_bounds.size(); ++j) off_bounds[j] = off_walls(end.point[j]);
  const auto [point, covariance] = uncertainty(problem, end.point, end.jacobian, off_bounds);
  Settled out{point, scope.table, {}, {}, usual_slope(slopes_of(problem, point, end.jacobian, covariance))};
  out.table.has_std_error = true;
  for (Row& row : out.table.rows) {
    const auto named = [&](const auto& v) { return v.name == row.name; };
    const auto seen = std::find_if(screened.begin(), screened.end(), named);
    if (seen == screened.end()) continue;
    ParameterResult p = begun(row, *seen);
    const auto free = std::find_if(problem.free().begin(), problem.free().end(),
                                   [&](const FreeValue& f) { return f.log < 0 && named(f); });
    if (free != problem.free().end()) {
      const auto j = static_cast<std::size_t>(free - problem.free().begin());
      const double variance = covariance(static_cast<long>(j), static_cast<long>(j));
      take_estimate(p, row, {*free, j, point[j], std::sqrt(std::max(0.0, variance)), !off_bounds[j]});
      if (off_bounds[j] && is_profiled(row.name, watch.options) && !watch.stopped()) {
        const KeptProfile kept = profile_through(watch, problem, point, static_cast<int>(j), covariance);
        const ProfileInterval& interval = kept.interval;
        p.profile_lower = free->from_unit(interval.lower);
        p.profile_upper = free->from_unit(interval.upper);
        out.notes.push_back(profile_note(p, interval));
      }
    }
    out.parameters.push_back(p);
  }
  return out;
}

}  // namespace servodx
