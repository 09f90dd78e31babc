#include "fit/uncertainty.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fit/identifiability.h"
#include "optimise/unit_cube.h"

namespace servodx {
namespace {

constexpr int passes = 2;  // the second by the axes that the first has found
constexpr long in_a_batch = 16;
constexpr double reach = 0.3, least_reach = 1e-3;  // standard errors: beyond, a bent valley passes for its walls

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

Point moved(const Point& x, const Eigen::VectorXd& way, double part) {
  Point y = x;
  for (std::size_t j = 0; j < y.size(); ++j) y[j] = std::clamp(y[j] + part * way[static_cast<long>(j)], 0.0, 1.0);
  return y;
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
  const auto m = static_cast<long>(at.size());
  for (int pass = 0; pass < passes && m > 0; ++pass) {
    const Eigen::MatrixXd block = out.covariance(at, at);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(block);
    if (axes.info() != Eigen::Success) return out;
    Eigen::MatrixXd along(here.residual.size(), m);  // derivative along each axis
    for (long first = 0; first < m; first += in_a_batch) {
      const long last = std::min(m, first + in_a_batch);
      std::vector<Point> points;
      std::vector<double> apart;
      for (long k = first; k < last; ++k) {
        Eigen::VectorXd way = Eigen::VectorXd::Zero(problem.n());
        way(at) = axes.eigenvectors().col(k) * std::sqrt(std::max(axes.eigenvalues()[k], 1e-16));
        // Alike either way, so that a valley's bend cancels; at a wall into the box alone.
        double up = within_box(out.point, way), down = within_box(out.point, -way);
        const double both = std::min({up, down, reach});
        if (both > least_reach)
          up = down = both;
        else
          (up > down ? down : up) = 0.0, up = std::min(up, reach), down = std::min(down, reach);
        points.push_back(moved(out.point, way, up));
        points.push_back(moved(out.point, way, -down));
        apart.push_back((up + down) * std::sqrt(std::max(axes.eigenvalues()[k], 1e-16)));
      }
      const std::vector<Evaluation> e = problem.evaluate(points);
      for (long k = first; k < last; ++k) {
        const auto i = static_cast<std::size_t>(2 * (k - first));
        if (!e[i].ok || !e[i + 1].ok || !(apart[i / 2] > 0)) return out;
        along.col(k) = (e[i].residual - e[i + 1].residual) / apart[i / 2];
      }
    }
    Eigen::MatrixXd secants = Eigen::MatrixXd::Zero(here.residual.size(), problem.n());
    secants(Eigen::all, at) = along * axes.eigenvectors().transpose();
    out.covariance = covariance_of(secants, kept);
    const Eigen::VectorXd step = -(out.covariance * (secants.transpose() * here.residual));
    for (double part = within_box(out.point, step); part > 0.1; part *= 0.5) {
      const Point tried = moved(out.point, step, part);
      Evaluation there = problem.evaluate(std::span(&tried, 1)).front();
      if (cost_of(there) >= cost_of(here)) continue;
      out.point = tried, here = std::move(there);
      break;
    }
  }
  return out;
}

}  // namespace servodx
