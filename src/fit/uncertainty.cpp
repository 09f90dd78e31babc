#include "fit/uncertainty.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "fit/constants.h"
#include "fit/identifiability.h"
#include "optimise/unit_cube.h"

namespace servodx {
namespace {

using namespace fit_constants::secant;

double cost_of(const Evaluation& e) { return e.ok ? 0.5 * e.residual.squaredNorm() : 1e300; }

// The farthest part of the way that stays in the box, at most all of it.
double within_box(const Point& x, const Eigen::VectorXd& way) {
  double part = 1;
  for (std::size_t j = 0; j < x.size(); ++j) {
    const double d = way[static_cast<long>(j)];
    if (d > 0) part = std::min(part, (1 - x[j]) / d);
    if (d < 0) part = std::min(part, x[j] / -d);
  }
  return std::max(0.0, part);
}

void shift(Point& x, const Eigen::VectorXd& way, double part) {
  for (std::size_t j = 0; j < x.size(); ++j) x[j] = std::clamp(x[j] + part * way[static_cast<long>(j)], 0.0, 1.0);
}

// Ways of one standard error each that do not go together: those of the shared values, which every log's own follow,
// then those of a log's own beside them. A log's own move no other log's rows, so one way of each log is gone at once.
struct Ways {
  Eigen::MatrixXd of;  // [free value][way]
  struct Step {
    long way;
    int log;  // -1: of the shared values
  };
  std::vector<std::vector<Step>> at_once;
};

struct Axes {
  Eigen::MatrixXd vectors;
  Eigen::VectorXd errors;
};
std::optional<Axes> axes_of(const Eigen::MatrixXd& covariance) {
  if (covariance.rows() == 0) return Axes{Eigen::MatrixXd(0, 0), Eigen::VectorXd(0)};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(covariance);
  if (solved.info() != Eigen::Success) return std::nullopt;
  return Axes{solved.eigenvectors(), solved.eigenvalues().cwiseMax(least_variance).cwiseSqrt()};
}

std::optional<Ways> ways_of(const FitProblem& problem, const Eigen::MatrixXd& covariance,
                            const std::vector<char>& kept) {
  std::vector<long> shared, own;
  std::vector<std::vector<long>> of_log(problem.logs().size());
  for (std::size_t j = 0; j < kept.size(); ++j) {
    if (!kept[j]) continue;
    const int log = problem.free()[j].log;
    (log < 0 ? shared : own).push_back(static_cast<long>(j));
    if (log >= 0) of_log[static_cast<std::size_t>(log)].push_back(static_cast<long>(j));
  }
  const auto n_shared = static_cast<long>(shared.size());
  Ways out{Eigen::MatrixXd::Zero(problem.n(), n_shared + static_cast<long>(own.size())), {}};
  const std::optional<Axes> axes = axes_of(covariance(shared, shared));
  if (!axes) return std::nullopt;
  const Eigen::MatrixXd spread = axes->vectors * axes->errors.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd follow = covariance(own, shared) * spread;
  for (long k = 0; k < n_shared; ++k) {
    out.of(shared, k) = axes->vectors.col(k) * axes->errors[k];
    out.of(own, k) = follow.col(k);
    out.at_once.push_back({{k, -1}});
  }
  long way = n_shared;
  for (std::size_t l = 0; l < of_log.size(); ++l) {
    const std::vector<long>& mine = of_log[l];
    const Eigen::MatrixXd taken = out.of(mine, Eigen::seqN(0, n_shared));
    const std::optional<Axes> left = axes_of(covariance(mine, mine) - taken * taken.transpose());
    if (!left) return std::nullopt;
    for (std::size_t k = 0; k < mine.size(); ++k, ++way) {
      out.of(mine, way) = left->vectors.col(static_cast<long>(k)) * left->errors[static_cast<long>(k)];
      const std::size_t step = static_cast<std::size_t>(n_shared) + k;
      if (out.at_once.size() <= step) out.at_once.resize(step + 1);
      out.at_once[step].push_back({way, static_cast<int>(l)});
    }
  }
  return out;
}

// How far to go either way, in standard errors: alike, so that a valley's bend cancels; at a wall into the box alone.
struct Reach {
  double up, down;
};
Reach reach_of(const Point& x, const Eigen::VectorXd& way) {
  const double up = within_box(x, way), down = within_box(x, -way), both = std::min({up, down, reach});
  if (both > least_reach) return {both, both};
  return up > down ? Reach{std::min(up, reach), 0} : Reach{0, std::min(down, reach)};
}

// Derivatives by the free values, from differences along the ways; zero where not kept. Nothing where a run fails.
std::optional<Eigen::MatrixXd> secants(const FitProblem& problem, const Point& x, const Ways& ways,
                                       const std::vector<long>& kept) {
  const std::vector<int> log_of = problem.logs_of_rows();
  const auto rows = static_cast<long>(log_of.size());
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(rows, ways.of.cols());
  for (std::size_t first = 0; first < ways.at_once.size(); first += in_a_batch) {
    const auto batch = std::span(ways.at_once).subspan(first, std::min(in_a_batch, ways.at_once.size() - first));
    std::vector<Point> points;
    for (const auto& steps : batch) {
      points.resize(points.size() + 2, x);
      for (const Ways::Step& s : steps) {
        const Reach r = reach_of(x, ways.of.col(s.way));
        shift(points[points.size() - 2], ways.of.col(s.way), r.up), shift(points.back(), ways.of.col(s.way), -r.down);
      }
    }
    const std::vector<Evaluation> runs = problem.evaluate(points);
    for (std::size_t k = 0; k < batch.size(); ++k) {
      const Evaluation &up = runs[2 * k], &down = runs[2 * k + 1];
      if (!up.ok || !down.ok) return std::nullopt;
      for (const Ways::Step& s : batch[k]) {
        const Reach r = reach_of(x, ways.of.col(s.way));
        if (!(r.up + r.down > 0)) return std::nullopt;
        for (long row = 0; row < rows; ++row)
          if (s.log < 0 || log_of[static_cast<std::size_t>(row)] == s.log)
            along(row, s.way) = (up.residual[row] - down.residual[row]) / (r.up + r.down);
      }
    }
  }
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, problem.n());
  const Eigen::MatrixXd of_kept = ways.of(kept, Eigen::all);
  out(Eigen::all, kept) = of_kept.transpose().partialPivLu().solve(along.transpose()).transpose();
  return out;
}

}  // namespace

Uncertainty uncertainty(const FitProblem& problem, const Point& point, const Eigen::MatrixXd& jacobian,
                        const std::vector<char>& kept) {
  Uncertainty out{point, covariance_of(jacobian, kept)};
  Evaluation here = problem.evaluate(std::span(&point, 1)).front();
  if (!here.ok) return out;
  std::vector<long> at;
  for (long j = 0; j < problem.n(); ++j)
    if (kept[static_cast<std::size_t>(j)]) at.push_back(j);
  for (int pass = 0; pass < passes && !at.empty(); ++pass) {
    const std::optional<Ways> ways = ways_of(problem, out.covariance, kept);
    const std::optional<Eigen::MatrixXd> derivatives =
        ways ? secants(problem, out.point, *ways, at) : std::optional<Eigen::MatrixXd>();
    if (!derivatives) return out;
    out.covariance = covariance_of(*derivatives, kept);
    const Eigen::VectorXd step = -(out.covariance * (derivatives->transpose() * here.residual));
    for (double part = within_box(out.point, step); part > least_step; part *= shorter) {
      Point tried = out.point;
      shift(tried, step, part);
      Evaluation there = problem.evaluate(std::span(&tried, 1)).front();
      if (cost_of(there) >= cost_of(here)) continue;
      out.point = std::move(tried), here = std::move(there);
      break;
    }
  }
  return out;
}

}  // namespace servodx
