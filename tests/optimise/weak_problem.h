// The kind of problem a servovalve fit is: effects of a full box from 2400 noise standard deviations down to 0.1,
// columns that look alike, curvature, and a minimum on several walls.
#pragma once
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"

namespace servodx::test {

struct Weak {
  int n;
  Eigen::MatrixXd shape;  // rows x n
  Eigen::VectorXd bend;   // curvature of each effect
  Eigen::VectorXd data;
  Eigen::VectorXd residual(const double* x) const {
    Eigen::VectorXd g(n);
    for (int j = 0; j < n; ++j) g[j] = std::expm1(bend[j] * (x[j] - 0.5)) / bend[j];
    Eigen::VectorXd r = shape * g;
    r.array() += 0.3 * r.array().square() / (1 + r.array().abs());  // effects act on each other
    return r - data;
  }
};

inline Weak make_weak(int n, std::uint64_t seed) {
  Random random(seed, 77);
  const int rows = 400;
  Weak weak{n, Eigen::MatrixXd(rows, n), Eigen::VectorXd(n), {}};
  Eigen::VectorXd at(n);
  for (int j = 0; j < n; ++j) {
    for (double& v : weak.shape.col(j)) v = random.normal();
    if (j % 3 == 2)
      weak.shape.col(j) = 0.97 * weak.shape.col(j - 1).normalized() + 0.24 * weak.shape.col(j).normalized();
    weak.shape.col(j).normalize();
    weak.shape.col(j) *= std::pow(10, random.uniform(-1, std::log10(2400.0)));
    weak.bend[j] = random.uniform(-4, 4);
    at[j] = random.uniform() < 0.35 ? (random.uniform() < 0.5 ? -0.05 : 1.05) : random.uniform(0.1, 0.9);
  }
  weak.data = Eigen::VectorXd::Zero(rows);
  weak.data = weak.residual(at.data());
  for (double& v : weak.data) v += random.normal();
  return weak;
}

inline LeastSquaresProblem least_squares(const Weak& weak) {
  LeastSquaresProblem problem;
  problem.n = weak.n;
  problem.evaluate = [&weak](std::span<const Point> points) {
    std::vector<Evaluation> values;
    for (const Point& p : points) values.push_back({true, weak.residual(p.data())});
    return values;
  };
  return problem;
}

}  // namespace servodx::test
