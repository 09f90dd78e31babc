// Derivatives that the integrator and a gradient fit rest on, against differences.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "effects/registry.h"
#include "integrate/sparse_lu.h"
#include "laws/bench.h"
#include "model/constants.h"
#include "model/derived.h"
#include "model/state.h"
#include "parameters/list.h"
#include "simulate/scenario.h"
#include "simulate/system.h"

namespace servodx {
namespace {

// Central difference with one Richardson step.
template <class F>
double difference(F f, double h) {
  const double wide = (f(2 * h) - f(-2 * h)) / (4 * h), narrow = (f(h) - f(-h)) / (2 * h);
  return narrow + (narrow - wide) / 3;
}

// Steps well inside the width of every smoothing that the state meets.
double step_of(int state) {
  switch (state) {
    case s_current:
      return 1e-6;
    case s_x_flapper:
      return 2e-8;
    case s_x_spool:
      return 2e-8;
    case s_v_flapper:
      return 1e-5;
    case s_v_spool:
      return 2e-6;
    case s_x_piston:
      return 1e-7;  // a hundredth of the stop's rounding, whose slope has corners
    case s_v_piston:
      return 2e-5;
    case s_p_filter:
    case s_p_pilot_1:
    case s_p_pilot_2:
    case s_p_a:
    case s_p_b:
      return 200;
    default:
      return 1e-7;
  }
}

template <class Effects>
void jacobian_equals_differences(const ParameterVector& v) {
  const Bench<Effects> bench(v);
  using Live = typename Bench<Effects>::Live;
  using Lu = SparseLu<Live::n, Live::pattern>;
  constexpr int n = Live::n;
  std::array<bool, n * n> seen{};
  for (unsigned trial = 0; trial < 60; ++trial) {
    Random random(23, trial);
    const auto y = bench.state(random);
    const auto u = bench.inputs(random);
    const Inputs<double> slope{3.0, 4e7, 1e7, 2e4};
    const Live system = bench.system(u, slope);
    std::array<double, Lu::entries> w;
    std::array<double, n> f, f_t, plain;
    system.value_and_jacobian(y, 0.0, f, w, f_t);
    system.value(y, 0.0, plain);
    for (int i = 0; i < n; ++i) EXPECT_EQ(f[i], plain[i]) << "the value beside the Jacobian";
    const auto along = [&](int i, int j, double s) {
      auto moved = y;
      moved[j] += s;
      std::array<double, n> g;
      system.value(moved, 0.0, g);
      return g[i];
    };
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double h = step_of(j);
        const double stated = Lu::plan.slot[i][j] >= 0 ? w[Lu::plan.slot[i][j]] : 0.0;
        const double found = difference([&](double s) { return along(i, j, s); }, h);
        const double rounding = 1e-13 * std::abs(f[i]) / h;  // the sum's own
        EXPECT_NEAR(stated, found, 2e-4 * std::abs(stated) + rounding) << "d f" << i << " / d y" << j << ", " << trial;
        seen[i * n + j] = seen[i * n + j] || std::abs(found) > 10 * rounding;
      }
    for (int i = 0; i < n; ++i) {
      const auto in_time = [&](double t) {
        std::array<double, n> g;
        system.value(y, t, g);
        return g[i];
      };
      constexpr double h = 1e-6;
      EXPECT_NEAR(f_t[i], difference(in_time, h), 2e-4 * std::abs(f_t[i]) + 1e-13 * std::abs(f[i]) / h)
          << "d f" << i << " / dt, " << trial;
    }
  }
  // Every entry of the pattern is met by some state: the comparison was not empty.
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) EXPECT_TRUE(seen[i * n + j] || !holds(Live::pattern.row[i], j)) << i << ' ' << j;
}

TEST(Derivatives, JacobianEqualsDifferences) { jacobian_equals_differences<NoEffects>(lively()); }
TEST(Derivatives, JacobianWithEveryEffectEqualsDifferences) {
  jacobian_equals_differences<AllEffects>(with_effects(lively()));
}

TEST(Derivatives, JetOverEveryRowEqualsDifferences) {
  constexpr int rows = n_parameters + AllEffects::n_parameters;
  using Jet = ceres::Jet<double, rows>;
  constexpr int n = Bench<AllEffects>::n;
  const ParameterVector v = with_effects(lively());
  const Bench<AllEffects> bench(v);
  std::vector<char> moved(rows, 0);
  for (unsigned trial = 0; trial < 20; ++trial) {
    Random random(29, trial);
    const auto y = bench.state(random);
    const auto u = bench.inputs(random);
    std::array<Jet, rows> p;
    for (int j = 0; j < rows; ++j) p[j] = Jet(v[j], j);
    const Derived<Jet> d = derive<Jet, AllEffects>(p.data(), Oil{});
    std::array<Jet, n> states;
    for (int i = 0; i < n; ++i) states[i] = Jet(y[i]);
    const Inputs<Jet> inputs{Jet(u.current), Jet(u.supply_pressure), Jet(u.return_pressure), Jet(u.load_force)};
    const auto g = derivative<AllEffects, Jet>(PlainStates<n, Jet>{states}, inputs, p.data(), d);
    const auto plain = bench.rate(y, u);
    unroll<n>([&](auto i) {
      const Jet& stated = std::get<i>(g);
      EXPECT_NEAR(stated.a, plain[i], 1e-10 * std::abs(plain[i]));
      for (int j = 0; j < rows; ++j) {
        // Rows at zero move by a part of their typical size.
        const double size = v[j] != 0 ? std::abs(v[j]) : j >= row::lap_pa && j <= row::lap_bt ? 1e-6 : 1e-3;
        // The stroke moves the stop, which is rounded within a part of it that is smaller still.
        const double h = (j == row::piston_stroke ? 2e-6 : 1e-4) * size;
        const auto along = [&](double s) {
          ParameterVector w = v;
          w[j] += s;
          return Bench<AllEffects>(w).rate(y, u)[i];
        };
        const double stop =
            i == s_v_piston ? constants::piston_stop_stiffness * v[row::piston_stroke] / v[row::moving_mass] : 0.0;
        const double found = difference(along, h),
                     rounding = (1e-13 * std::abs(plain[i]) + (j == row::piston_stroke ? 4e-15 : 0.0) * stop) / h;
        ASSERT_TRUE(std::isfinite(stated.v[j]));
        EXPECT_NEAR(stated.v[j], found, 2e-4 * std::abs(found) + rounding) << "f" << i << " row " << j << ", " << trial;
        moved[j] = moved[j] || std::abs(found) > 10 * rounding;
      }
    });
  }
  // Rows that act outside the right-hand side: the sensor's, the amplifier's, the return pressure, the null. The
  // supply pressure is the one at which screen_drop states the clean filter's drop.
  for (int j = 0; j < n_parameters; ++j) {
    const bool outside = j == row::current_limit || j == row::position_sensor_lag || j == row::position_sensor_gain ||
                         j == row::return_pressure || j == row::servovalve_null;
    EXPECT_EQ(moved[j] != 0, !outside) << parameter_list[j].name;
  }
}

TEST(Derivatives, JetIsFiniteAtRest) {
  // Every difference and every velocity zero: where a naive root has an infinite slope.
  using Jet = ceres::Jet<double, n_parameters>;
  ParameterVector v = nominal_candidate();
  std::array<Jet, n_values> p;
  for (int j = 0; j < n_parameters; ++j) p[j] = Jet(v[j], j);
  const Derived<Jet> d = derive<Jet>(p.data(), Oil{});
  std::array<Jet, n_base_states> y;
  y.fill(Jet(0.0));
  for (double pressure : {0.0, 1e7}) {
    for (int i : {s_p_filter, s_p_pilot_1, s_p_pilot_2, s_p_a, s_p_b}) y[i] = Jet(pressure);
    const Inputs<Jet> u{Jet(0.0), Jet(pressure), Jet(pressure), Jet(0.0)};
    const auto g = derivative<NoEffects, Jet>(PlainStates<n_base_states, Jet>{y}, u, p.data(), d);
    unroll<n_base_states>([&](auto i) {
      EXPECT_TRUE(std::isfinite(std::get<i>(g).a));
      for (int j = 0; j < n_parameters; ++j) EXPECT_TRUE(std::isfinite(std::get<i>(g).v[j])) << i << ' ' << j;
    });
  }
}

}  // namespace
}  // namespace servodx
