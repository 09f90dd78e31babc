#include "integrate/rodas3.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/pack.h"
#include "base/random.h"
#include "integrate/sparse_lu.h"

namespace servodx {
namespace {

template <int N>
constexpr Pattern<N> full_pattern() {
  Pattern<N> p;
  for (int i = 0; i < N; ++i) p.row[i] = range(0, N);
  return p;
}

// y0' = y1, y1' = mu (1 - y0^2) y1 - y0: smooth for small mu, stiff for large.
template <class T>
struct VanDerPol {
  static constexpr int n = 2;
  static constexpr Pattern<2> pattern = full_pattern<2>();
  double mu;
  void value(const std::array<T, 2>& y, const T&, std::array<T, 2>& f) const {
    f[0] = y[1];
    f[1] = T(mu) * (T(1.0) - y[0] * y[0]) * y[1] - y[0];
  }
  template <class W>
  void value_and_jacobian(const std::array<T, 2>& y, const T& t, std::array<T, 2>& f, W& w,
                          std::array<T, 2>& f_t) const {
    using Lu = SparseLu<2, pattern>;
    value(y, t, f);
    w[Lu::plan.slot[0][0]] = T(0.0);
    w[Lu::plan.slot[0][1]] = T(1.0);
    w[Lu::plan.slot[1][0]] = -(T(2.0 * mu) * y[0] * y[1] + T(1.0));
    w[Lu::plan.slot[1][1]] = T(mu) * (T(1.0) - y[0] * y[0]);
    f_t = {T(0.0), T(0.0)};
  }
};

// y' = lambda (y - phi(t)) + phi'(t), phi = sin t: the solution is phi whatever lambda. (Prothero, Robinson 1974)
struct ProtheroRobinson {
  static constexpr int n = 1;
  static constexpr Pattern<1> pattern = full_pattern<1>();
  double lambda;
  double start = 0;  // [s] time at the beginning of the step
  bool tells_time_derivative = true;
  void value(const std::array<double, 1>& y, const double& t, std::array<double, 1>& f) const {
    f[0] = lambda * (y[0] - std::sin(start + t)) + std::cos(start + t);
  }
  template <class W>
  void value_and_jacobian(const std::array<double, 1>& y, const double& t, std::array<double, 1>& f, W& w,
                          std::array<double, 1>& f_t) const {
    value(y, t, f);
    w[0] = lambda;
    f_t[0] = tells_time_derivative ? -lambda * std::cos(start + t) - std::sin(start + t) : 0.0;
  }
};

// y' = y^2 cos t, y(0) = 1/2: y = 1 / (2 - sin t).
struct Forced {
  static constexpr int n = 1;
  static constexpr Pattern<1> pattern = full_pattern<1>();
  double start = 0;
  bool tells_time_derivative = true;
  void value(const std::array<double, 1>& y, const double& t, std::array<double, 1>& f) const {
    f[0] = y[0] * y[0] * std::cos(start + t);
  }
  template <class W>
  void value_and_jacobian(const std::array<double, 1>& y, const double& t, std::array<double, 1>& f, W& w,
                          std::array<double, 1>& f_t) const {
    value(y, t, f);
    w[0] = 2 * y[0] * std::cos(start + t);
    f_t[0] = tells_time_derivative ? -y[0] * y[0] * std::sin(start + t) : 0.0;
  }
};

std::array<double, 2> van_der_pol(double mu, double until, int steps) {
  VanDerPol<double> system{mu};
  std::array<double, 2> y{2.0, 0.0};
  for (int k = 0; k < steps; ++k) rodas3_step<double>(system, y, until / steps);
  return y;
}

double forced_error(int steps, bool tells_time_derivative) {
  constexpr double until = 2.0;
  Forced system{.tells_time_derivative = tells_time_derivative};
  std::array<double, 1> y{0.5};
  for (int k = 0; k < steps; ++k) {
    system.start = until / steps * k;
    rodas3_step<double>(system, y, until / steps);
  }
  return std::abs(y[0] - 1.0 / (2.0 - std::sin(until)));
}

// log2 of the error ratio: 3 as h -> 0; within 0.3 of it on grids that are not yet in the limit.
constexpr double order = 3.0, order_tolerance = 0.3;

TEST(Rodas3, HalvingTheStepDividesTheErrorOfASmoothSystemByEight) {
  const std::array<double, 2> exact = van_der_pol(1.0, 3.0, 20000);
  const auto error = [&](int steps) {
    const std::array<double, 2> y = van_der_pol(1.0, 3.0, steps);
    return std::hypot(y[0] - exact[0], y[1] - exact[1]);
  };
  for (int steps : {100, 200, 400}) {
    const double observed = std::log2(error(steps) / error(2 * steps));
    std::printf("van der Pol, mu 1, %d steps: order %.3f\n", steps, observed);
    EXPECT_NEAR(observed, order, order_tolerance) << steps;
  }
}

TEST(Rodas3, HalvingTheStepDividesTheErrorOfATimeDependentSystemByEight) {
  for (int steps : {20, 40, 80}) {
    const double observed = std::log2(forced_error(steps, true) / forced_error(2 * steps, true));
    std::printf("y' = y^2 cos t, %d steps: order %.3f\n", steps, observed);
    EXPECT_NEAR(observed, order, order_tolerance) << steps;
  }
  // The order rests on the time derivative: without it the method is of first or second order here.
  EXPECT_LT(std::log2(forced_error(80, false) / forced_error(160, false)), 2.5);
}

TEST(Rodas3, StiffSystemFollowsItsSlowSolution) {
  for (double lambda : {-1e3, -1e6, -1e9}) {
    constexpr int steps = 50;
    constexpr double h = 0.02;
    ProtheroRobinson system{lambda};
    std::array<double, 1> y{0.0};
    double worst = 0;
    for (int k = 0; k < steps; ++k) {
      system.start = h * k;
      rodas3_step<double>(system, y, h);
      worst = std::max(worst, std::abs(y[0] - std::sin(h * (k + 1))));
    }
    // Far from the layer the error is that of the slow solution, at most one order of h above the method's: h^2.
    EXPECT_LT(worst, h * h) << lambda;
  }
}

TEST(Rodas3, HugeStepDampsAFastModeInOneStep) {
  ProtheroRobinson system{-1e12};
  system.start = 0;
  std::array<double, 1> y{1.0};
  rodas3_step<double>(system, y, 1.0);
  // L-stable: R(infinity) = 0, so what is left of the initial 1 is of order 1/(lambda h); the slow solution remains.
  EXPECT_NEAR(y[0], std::sin(1.0), 0.2);
  std::array<double, 1> with{2.0};
  rodas3_step<double>(system, with, 1.0);
  EXPECT_NEAR(with[0], y[0], 1e-3);
}

TEST(Rodas3, StiffOscillatorFollowsItsSlowBranchAtStepsFarBeyondItsFastRate) {
  // On the slow branch y0' = y0 / (mu (1 - y0^2)), so ln y0 - y0^2 / 2 falls by t / mu; the fast rate is 3 mu.
  constexpr double mu = 1e3, h = 1.0;
  VanDerPol<double> system{mu};
  std::array<double, 2> y{2.0, 0.0};
  const auto clock = [&] { return mu * (std::log(y[0]) - 0.5 * y[0] * y[0]); };
  const double start = clock();
  for (int k = 1; k <= 600; ++k) {  // the branch ends at (3/2 - ln 2) mu = 807
    rodas3_step<double>(system, y, h);
    ASSERT_NEAR(clock() - start, h * k, 2 * h) << k;
  }
}

TEST(Rodas3, StiffOscillatorKeepsItsLimitCycle) {
  VanDerPol<double> system{100.0};
  std::array<double, 2> y{2.0, 0.0};
  double largest = 0, smallest = 0;
  constexpr double h = 2e-3, period = (3 - 2 * 0.6931) * 100.0;
  for (int k = 0; k < static_cast<int>(3 * period / h); ++k) {
    rodas3_step<double>(system, y, h);
    ASSERT_TRUE(std::isfinite(y[0]) && std::isfinite(y[1])) << k;
    largest = std::max(largest, y[0]), smallest = std::min(smallest, y[0]);
  }
  EXPECT_NEAR(largest, 2.0, 0.05);  // the amplitude of the cycle tends to 2
  EXPECT_NEAR(smallest, -2.0, 0.05);
}

TEST(Rodas3, LaneEqualsScalarBitForBit) {
  using T = Pack<2>;
  VanDerPol<T> packed{5.0};
  VanDerPol<double> scalar{5.0};
  std::array<T, 2> y{T(2.0), T(0.0)};
  y[0].set(1, -1.3);
  y[1].set(1, 0.7);
  std::array<double, 2> a{2.0, 0.0}, b{-1.3, 0.7};
  for (int k = 0; k < 500; ++k) {
    rodas3_step<T>(packed, y, 0.01);
    rodas3_step<double>(scalar, a, 0.01);
    rodas3_step<double>(scalar, b, 0.01);
  }
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(y[i][0], a[i]);
    EXPECT_EQ(y[i][1], b[i]);
  }
}

}  // namespace
}  // namespace servodx
