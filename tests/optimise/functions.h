// Optimisers' test functions on the unit cube. Each has minimum 0 at one interior point.
#pragma once
#include <cmath>
#include <numbers>
#include <random>

#include "optimise/unit_cube.h"

namespace servodx::test {

struct Function {
  const char* name;
  // Residuals whose sum of squares is the cost, so that the local stage sees the same function as the genetic
  // algorithm.
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> residual;
};

inline Eigen::VectorXd minimiser(int n) {
  std::mt19937 random(7);
  Eigen::VectorXd at(n);
  for (double& v : at) v = 0.3 + 0.4 * (static_cast<double>(random()) / 4294967296.0);
  return at;
}

inline Function sphere(int n) {
  return {"sphere", [at = minimiser(n)](const Eigen::VectorXd& x) -> Eigen::VectorXd { return 10 * (x - at); }};
}

// Condition number 1e6, axes turned at random.
inline Function ellipsoid(int n) {
  std::mt19937 random(11);
  Eigen::MatrixXd a(n, n);
  for (double& v : a.reshaped()) v = static_cast<double>(random()) / 4294967296.0 - 0.5;
  const Eigen::MatrixXd turn = Eigen::HouseholderQR<Eigen::MatrixXd>(a).householderQ();
  Eigen::VectorXd axes(n);
  for (int j = 0; j < n; ++j) axes[j] = 10 * std::pow(1e3, j / (n - 1.0));
  return {"ellipsoid", [=, at = minimiser(n)](const Eigen::VectorXd& x) -> Eigen::VectorXd {
            return axes.cwiseProduct(turn * (x - at));
          }};
}

inline Function rosenbrock(int n) {
  return {"rosenbrock", [n](const Eigen::VectorXd& x) -> Eigen::VectorXd {
            const Eigen::VectorXd z = 4.096 * x.array() - 2.048;
            Eigen::VectorXd r(2 * n - 2);
            for (int j = 0; j + 1 < n; ++j) {
              r[2 * j] = 10 * (z[j + 1] - z[j] * z[j]);
              r[2 * j + 1] = 1 - z[j];
            }
            return r;
          }};
}

// About 10^n local minima. 10 - 10 cos(2 pi z) = 20 sin(pi z)^2, hence smooth residuals.
inline Function rastrigin(int n) {
  return {"rastrigin", [n, at = minimiser(n)](const Eigen::VectorXd& x) -> Eigen::VectorXd {
            const Eigen::VectorXd z = 10.24 * (x - at);
            Eigen::VectorXd r(2 * n);
            r.head(n) = z;
            r.tail(n) = std::sqrt(20.0) * (std::numbers::pi * z.array()).sin();
            return r;
          }};
}

inline Eigen::Map<const Eigen::VectorXd> as_vector(const Point& p) {
  return {p.data(), static_cast<Eigen::Index>(p.size())};
}

inline BatchCost cost_of(const Function& function) {
  return [function](std::span<const Point> points) {
    std::vector<double> costs;
    for (const Point& p : points) costs.push_back(function.residual(as_vector(p)).squaredNorm());
    return costs;
  };
}

inline BatchEvaluate residuals_of(const Function& function) {
  return [function](std::span<const Point> points) {
    std::vector<Evaluation> values;
    for (const Point& p : points) values.push_back({true, function.residual(as_vector(p))});
    return values;
  };
}

}  // namespace servodx::test
