#include "fit/profile.h"

#include <algorithm>
#include <cmath>

#include "fit/constants.h"
#include "optimise/box_least_squares.h"
#include "optimise/local.h"
#include "optimise/unit_cube.h"

namespace servodx {
namespace {

using namespace fit_constants::profiled;

// The problem with number j held.
class Held {
 public:
  Held(const FitProblem& problem, int j) : problem_(problem), j_(j) {}
  void hold_at(double u) { u_ = u; }
  Point whole(const Point& rest) const {
    Point x = rest;
    x.insert(x.begin() + j_, u_);
    return x;
  }
  LeastSquaresProblem least_squares() const {
    LeastSquaresProblem p;
    p.n = problem_.n() - 1;
    p.evaluate = [this](std::span<const Point> points) {
      std::vector<Point> all;
      for (const Point& rest : points) all.push_back(whole(rest));
      return problem_.evaluate(all);
    };
    p.jacobian = [this](const Point& rest, const Eigen::VectorXd& r, Eigen::MatrixXd& jacobian) {
      Eigen::MatrixXd full;
      if (!problem_.jacobian(whole(rest), r, full)) return false;
      jacobian.resize(full.rows(), full.cols() - 1);
      jacobian.leftCols(j_) = full.leftCols(j_);
      jacobian.rightCols(full.cols() - 1 - j_) = full.rightCols(full.cols() - 1 - j_);
      return true;
    };
    return p;
  }

 private:
  const FitProblem& problem_;
  int j_;
  double u_ = 0;
};

}  // namespace

ProfileInterval profile(const FitProblem& problem, const Point& best, int j, const Eigen::MatrixXd& covariance) {
  const double least = 0.5 * problem.evaluate(std::span(&best, 1)).front().residual.squaredNorm();
  const double sd = std::sqrt(std::max(covariance(j, j), least_variance)), centre = best[static_cast<std::size_t>(j)];
  Held held(problem, j);
  LeastSquaresOptions options;
  options.max_iterations = refit_iterations;
  options.difference = Difference::forward;
  options.cost_tolerance = cost_tolerance;
  ProfileInterval out;
  for (const int side : {-1, 1}) {
    const double room = side < 0 ? centre : 1 - centre;
    double& end = side < 0 ? out.lower : out.upper;
    bool& open = side < 0 ? out.lower_open : out.upper_open;
    double distance = std::min(room, root_of_chi2 * sd);
    double inside = 0, inside_root = 0;  // the farthest point below the level, and its root of the rise
    Point rest = best;
    rest.erase(rest.begin() + j);
    for (int k = 0; k < most_points; ++k) {
      // The others begin where the curvature says that they go.
      Point start = rest;
      for (int i = 0, r = 0; i < problem.n(); ++i)
        if (i != j) {
          start[r] = std::clamp(best[i] + covariance(i, j) / covariance(j, j) * side * distance, 0.0, 1.0);
          ++r;
        }
      held.hold_at(centre + side * distance);
      const Point alone{centre + side * distance};
      const double misfit = problem.n() > 1
                                ? minimise_locally(held.least_squares(), start, options).end.misfit
                                : 0.5 * problem.evaluate(std::span(&alone, 1)).front().residual.squaredNorm();
      const double root = std::sqrt(std::max(0.0, 2 * (misfit - least)));
      open = distance >= room && root < root_of_chi2;
      if (open || std::abs(root - root_of_chi2) < close * root_of_chi2) break;
      if (root < root_of_chi2) inside = distance, inside_root = root;
      // The root of the rise is nearly straight: from the last point below the level, or from the best point.
      const double slope =
          root > root_of_chi2 ? (root - inside_root) / std::max(distance - inside, least_divisor) : root / distance;
      const double from = root > root_of_chi2 ? inside : 0.0, from_root = root > root_of_chi2 ? inside_root : 0.0;
      const double next = from + (root_of_chi2 - from_root) / std::max(slope, least_divisor);
      distance = std::clamp(next, least_next * distance, std::min(room, most_next * distance));
    }
    end = centre + side * distance;
  }
  return out;
}

}  // namespace servodx
