#include "explain/fit_causes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include "base/stages.h"
#include "explain/constants.h"
#include "explain/deviance.h"
#include "explain/kept.h"
#include "fit/fit_work.h"
#include "optimise/box_least_squares.h"
#include "optimise/local.h"
#include "parameters/coordinate.h"

namespace servodx {
namespace {

using namespace explain_constants;

LeastSquaresOptions least_squares_options(int iterations, bool curve) {
  LeastSquaresOptions o;
  o.damping_trials = curve ? curve_dampings : dampings;
  o.max_iterations = iterations;
  o.difference = Difference::forward;
  o.cost_tolerance = cost_tolerance;
  return o;
}

// One trial and no Jacobian: candidates are many, and their fits a few iterations long.
LocalOptions local_options() {
  LocalOptions o;
  o.ceres.max_steps = 1;
  o.ceres.max_jacobians = 0;
  return o;
}

const Cause& cause_of(const Subject& subject, int cause) { return subject.causes()[static_cast<std::size_t>(cause)]; }

bool has_curve(const Subject& subject, const std::vector<int>& causes) {
  return std::any_of(causes.begin(), causes.end(), [&](int c) { return cause_of(subject, c).curve; });
}

// The last cause, at `first`, begins at its probes and where its score says; of an alternative with several, with all
// of them together.
std::vector<Point> starts_of(const Cause& cause, const CauseScore& score, const Point& x, std::size_t first) {
  std::vector<Point> starts;
  std::size_t k = 0;
  for (const auto& alternative : cause.probes) {
    Point together = x;
    for (const auto& probe : alternative) {
      Point alone = x;
      for (std::size_t j = 0; j < cause.numbers.size(); ++j) {
        const Number& n = cause.numbers[j];
        const double moved = n.size ? n.off + score.probes[k].size * (probe[j] - n.off) : probe[j];
        if (n.size && probe[j] == n.off) continue;
        together[first + j] = n.to_unit(moved);
        alone[first + j] = n.to_unit(probe[j]);
      }
      if (alternative.size() == 1) starts.push_back(alone);
      ++k;
    }
    starts.push_back(together);
  }
  return starts;
}

// Of several starts the one of least deviance, with the weights of what it leaves; without weights where every one
// fails.
struct Start {
  Point point;
  std::optional<Eigen::VectorXd> weights;
};
Start best_of(const Subject& subject, const LeastSquaresProblem& problem, const std::vector<Point>& starts) {
  Start out{starts.front(), {}};
  const std::vector<Evaluation> e = problem.evaluate(starts);
  double best = 1e300;
  for (std::size_t i = 0; i < e.size(); ++i)
    if (const double d = e[i].ok ? deviance_of(subject, e[i].residual) : 1e300; d < best) {
      best = d, out.point = starts[i];
      out.weights = weights_at(subject, e[i].residual);
    }
  return out;
}

// What was free before keeps its derivatives; only the new numbers' are taken again: a few runs in place of many.
LeastSquaresProblem keeping_derivatives(const LeastSquaresProblem& p, const Eigen::MatrixXd& kept) {
  LeastSquaresProblem out = p;
  const long old = kept.cols(), n = p.n;
  out.jacobian = [p, kept, old, n](const Point& x, const Eigen::VectorXd& r, Eigen::MatrixXd& j) {
    std::vector<Point> moved;
    std::vector<double> dx;
    for (long k = old; k < n; ++k) {
      moved.push_back(x);
      dx.push_back(x[static_cast<std::size_t>(k)] + difference_step <= 1 ? difference_step : -difference_step);
      moved.back()[static_cast<std::size_t>(k)] += dx.back();
    }
    const std::vector<Evaluation> e = p.evaluate(moved);
    j.setZero(r.size(), n);
    j.topLeftCorner(kept.rows(), old) = kept;  // priors of the new numbers come last
    for (std::size_t k = 0; k < e.size(); ++k) {
      if (!e[k].ok) return false;
      j.col(old + static_cast<long>(k)) = (e[k].residual - r) / dx[k];
    }
    return true;
  };
  return out;
}

std::vector<double> values_of(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

// What a search was before, at its end: made again from there, or made.
template <class... Input>
LocalOptions through_checkpoint(FitWork& work, const Stages& stages, const LeastSquaresProblem& problem,
                                const LeastSquaresOptions& options, const Input&... inputs) {
  LocalOptions o = local_options();
  if (!stages.keeps()) return o;
  o.through = [&work, &stages, &problem, &options, inputs...](const auto& search) {
    std::optional<LeastSquaresResult> made;
    const auto make = [&] {
      made = search();
      return without_rows(*made);
    };
    const SearchEnd end = counted(work, stages, "search", make, inputs...);
    if (made) return std::move(*made);
    const FitWork all = work;
    LeastSquaresResult again = with_rows(end, problem, options);
    work = all;
    return again;
  };
  return o;
}

// Of a fit, all that goes into it: where an earlier one got to stands for that fit.
Stages stages_of(const Subject& subject, std::string_view what, const std::vector<int>& causes,
                 const ExplainedFit* from, int iterations, bool quick, bool wide) {
  if (!subject.stages.keeps()) return {};
  std::vector<std::vector<double>> weights;
  for (const Series& s : subject.series()) weights.push_back(*s.sigma);
  Stages out = subject.stages.part(what, causes, iterations, quick, wide, weights);
  return from ? out.part("from", from->causes, from->wide, from->point, from->deviance) : out;
}

// Twice where weights are in play: what is left of a channel once the cause is in it is not what it began with.
void minimise(const Subject& subject, const Stages& stages, const LeastSquaresProblem& problem, Start start,
              const LeastSquaresOptions& options, ExplainedFit& out) {
  const int passes = start.weights && start.weights->minCoeff() < 1 ? 2 : 1;
  for (int pass = 0; pass < passes; ++pass) {
    const bool plain = passes == 1;
    const LeastSquaresProblem of_pass = plain ? problem : weighed(problem, *start.weights);
    const std::vector<double> weights = plain || !stages.keeps() ? std::vector<double>() : values_of(*start.weights);
    const LeastSquaresResult r =
        minimise_locally(of_pass, start.point, options,
                         through_checkpoint(*out.fit.work, stages, of_pass, options, start.point, weights, pass))
            .end;
    if (r.reason == StopReason::start_failed) return;
    const Eigen::VectorXd residual = plain ? r.residual : r.residual.cwiseQuotient(*start.weights);
    const double deviance = deviance_of(subject, residual);
    if (out.ok && deviance > out.deviance) return;
    out.ok = true;
    out.point = start.point = r.point;
    out.misfit = residual.squaredNorm();
    out.deviance = deviance;
    out.residual = residual;
    out.jacobian = r.jacobian;
    if (!plain) out.jacobian.array().colwise() /= start.weights->array();
    start.weights = weights_at(subject, residual);
  }
}

}  // namespace

std::size_t base_size(const Subject& subject, const ExplainedFit& f) {
  std::size_t n = f.fit.numbers.size();
  for (int c : f.causes) n -= cause_of(subject, c).numbers.size();
  return n;
}

Point numbers_of_causes(const Subject& subject, const ExplainedFit& fit) {
  return {fit.point.begin() + static_cast<long>(base_size(subject, fit)), fit.point.end()};
}

Point carried(const Subject& subject, const ExplainedFit& from, const SubjectFit& to, const std::vector<int>& causes) {
  Point x = to.start;
  const std::size_t base = base_size(subject, from);
  for (std::size_t j = 0; j < base && j < to.numbers.size(); ++j)
    if (to.numbers[j].name == from.fit.numbers[j].name) x[j] = from.point[j];
  std::size_t at = to.numbers.size();
  for (int c : causes) at -= cause_of(subject, c).numbers.size();
  for (int c : causes) {
    const std::size_t n = cause_of(subject, c).numbers.size();
    std::size_t its = base;
    for (int f : from.causes) {
      if (f == c)
        for (std::size_t j = 0; j < n; ++j) x[at + j] = from.point[its + j];
      its += cause_of(subject, f).numbers.size();
    }
    at += n;
  }
  return x;
}

ExplainedFit fit_causes(const Subject& subject, const std::vector<int>& causes, const ExplainedFit* from,
                        const CauseScore* score, int iterations, bool quick, bool wide) {
  ExplainedFit out;
  out.causes = causes;
  out.wide = wide || (from && from->wide);
  out.fit = subject.fit(causes, out.wide);
  std::vector<Point> starts = {from ? carried(subject, *from, out.fit, causes) : out.fit.start};
  if (score) {
    const Cause& cause = cause_of(subject, score->cause);
    starts = starts_of(cause, *score, starts.front(), out.fit.numbers.size() - cause.numbers.size());
  }
  // Nothing is known of the start without an earlier fit: no weights.
  const Start start = from ? best_of(subject, out.fit.problem, starts) : Start{starts.front(), {}};
  const LeastSquaresProblem problem =
      score && quick ? keeping_derivatives(out.fit.problem, from->jacobian) : out.fit.problem;
  minimise(subject, stages_of(subject, "fit", causes, from, iterations, score && quick, out.wide), problem, start,
           least_squares_options(iterations, has_curve(subject, causes)), out);
  return out;
}

ExplainedFit fit_base(Subject& subject, int iterations) {
  ExplainedFit fit = fit_causes(subject, {}, nullptr, nullptr, iterations, false);
  if (fit.ok && subject.rescale(fit.residual)) fit = fit_causes(subject, {}, &fit, nullptr, iterations / 2, false);
  return fit;
}

ExplainedFit hold_causes(const Subject& subject, const std::vector<int>& causes, const Point& numbers,
                         const ExplainedFit& from, int iterations) {
  ExplainedFit out;
  out.wide = from.wide;
  out.causes = causes;
  out.fit = subject.fit(causes, out.wide);
  const std::size_t base = base_size(subject, out);
  const auto whole = [&](Point x) {
    x.insert(x.end(), numbers.begin(), numbers.end());
    return x;
  };
  LeastSquaresProblem held;
  held.n = static_cast<int>(base);
  held.evaluate = [&](std::span<const Point> points) {
    std::vector<Point> all;
    for (const Point& p : points) all.push_back(whole(p));
    return out.fit.problem.evaluate(all);
  };
  const Point start(from.point.begin(), from.point.begin() + static_cast<long>(base));
  const Stages stages = stages_of(subject, "held", causes, &from, iterations, false, out.wide);
  const LeastSquaresOptions options = least_squares_options(iterations, false);
  const LeastSquaresResult r =
      minimise_locally(held, start, options, through_checkpoint(*out.fit.work, stages, held, options, start, numbers)).end;
  if (r.reason == StopReason::start_failed) return out;
  out.ok = true;
  out.point = whole(r.point);
  out.residual = r.residual;
  out.misfit = r.residual.squaredNorm();
  out.deviance = deviance_of(subject, r.residual);
  out.jacobian.setZero(r.jacobian.rows(), static_cast<long>(out.point.size()));
  out.jacobian.leftCols(r.jacobian.cols()) = r.jacobian;
  return out;
}

CauseNumbers numbers_of(const Subject& subject, const ExplainedFit& f, int cause) {
  const long n = f.jacobian.cols();
  Eigen::MatrixXd gram = f.jacobian.transpose() * f.jacobian;
  std::vector<char> free(static_cast<std::size_t>(n));
  for (long j = 0; j < n; ++j) {
    const double u = f.point[static_cast<std::size_t>(j)];
    free[static_cast<std::size_t>(j)] = off_walls(u);
    if (!free[static_cast<std::size_t>(j)]) gram.row(j).setZero(), gram.col(j).setZero(), gram(j, j) = 1;
  }
  gram.diagonal().array() += 1e-12 * gram.diagonal().maxCoeff();
  const Eigen::MatrixXd covariance = gram.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  // The likelihood already counts the model's own error; where it fits worse than that, the errors are wider.
  const double worse = std::sqrt(std::max(1.0, f.misfit / std::max(1.0, degrees_of(subject))));
  CauseNumbers out;
  std::size_t at = base_size(subject, f);
  for (int c : f.causes) {
    const std::vector<Number>& numbers = cause_of(subject, c).numbers;
    for (std::size_t j = 0; c == cause && j < numbers.size(); ++j) {
      const Number& number = numbers[j];
      const double value = number.from_unit(f.point[at + j]);
      const double slope = number.slope(value);
      const auto k = static_cast<long>(at + j);
      out.value.push_back(value);
      out.std_error.push_back(free[at + j] ? worse * slope * std::sqrt(std::max(0.0, covariance(k, k))) : std::nan(""));
    }
    at += numbers.size();
  }
  return out;
}

}  // namespace servodx
