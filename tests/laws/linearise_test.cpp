// The model's linearisation along a run against runs of the model: what it says of a deviation is what one makes.
#include "simulate/linearise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "laws/bench.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

// A valve and its piston on the move; more pressure at the start, and what is missing on the rod.
Scenario moving(double pressure, double force, double dt = 1e-3) {
  Scenario s = made(
      0.2, dt, [](double t) { return 0.008 + 0.004 * std::sin(2 * std::numbers::pi * 8 * t); },
      [=](double t) { return 500 * std::sin(2 * std::numbers::pi * 5 * t) - force; });
  s.command_slope = 1.0;
  s.piston_velocity_start = 0.1, s.piston_start = 0.01, s.spool_start = 1e-4;
  s.pressure_a_start = 1.1e7 + pressure, s.pressure_b_start = 0.9e7;
  return s;
}
SimulateOptions of_step(double step) {
  SimulateOptions o = all_signals();
  o.step = o.impact_step = step;
  return o;
}
constexpr double fine = 2e-5;
ParameterVector valve() {
  ParameterVector v = nominal_candidate();
  v[row::position_sensor_lag] = 0, v[row::position_sensor_gain] = 1;
  return v;
}

struct Shown {
  double piston, a, b, spool;
};
Shown at(const Trajectory& t, std::size_t k) {
  return {of(t, Signal::piston_position)[k], of(t, Signal::pressure_a)[k], of(t, Signal::pressure_b)[k],
          of(t, Signal::spool_position)[k]};
}
// Largest difference of the linear deviation from that of two runs, over the largest deviation, signal by signal.
double error_of(const Linearisation& linear, Eigen::VectorXd x, const Trajectory& with, const Trajectory& without) {
  double largest[4] = {}, off[4] = {};
  for (std::size_t k = 0; k < linear.transition.size(); ++k) {
    x = linear.transition[k] * x;
    const Shown a = at(with, k + 1), b = at(without, k + 1);
    const double truth[4] = {a.piston - b.piston, a.a - b.a, a.b - b.b, a.spool - b.spool},
                 said[4] = {x[s_x_piston], x[s_p_a], x[s_p_b], x[s_x_spool]};
    for (int i = 0; i < 4; ++i)
      largest[i] = std::max(largest[i], std::abs(truth[i])), off[i] = std::max(off[i], std::abs(said[i] - truth[i]));
  }
  double worst = 0;
  for (int i = 0; i < 3; ++i) worst = std::max(worst, off[i] / largest[i]);
  return worst;
}

TEST(Linearise, DeviationAtTheStartGoesOnAsTheModelTakesIt) {
  const ParameterVector v = valve();
  constexpr double more = 1e3;  // [Pa]
  const Linearisation linear = linearise(moving(0, 0), v, of_step(fine));
  ASSERT_TRUE(linear.ok);
  ASSERT_EQ(linear.transition.size(), 200u);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(linear.states);
  x[s_p_a] = more;
  EXPECT_LT(error_of(linear, x, simulate(moving(more, 0), v, of_step(fine)), simulate(moving(0, 0), v, of_step(fine))),
            0.02);
}

TEST(Linearise, MissingForceIsALoadOfTheOtherSign) {
  const ParameterVector v = valve();
  constexpr double force = 1.0;
  const Linearisation linear = linearise(moving(0, 0), v, of_step(fine));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(linear.states);
  x[linear.states - n_missing_places + 6] = force;
  ASSERT_STREQ(missing_places[6].where, "piston_force");
  EXPECT_LT(error_of(linear, x, simulate(moving(0, force), v, of_step(fine)), simulate(moving(0, 0), v, of_step(fine))),
            0.02);
}

TEST(Linearise, MissingFlowAcrossIsALeakOfTheSeal) {
  // A leak so small that the load pressure stays: its flow is known from the run without it.
  const ParameterVector v = valve();
  ParameterVector leaky = v;
  leaky[row::cross_piston_leakage] += 1e-14;
  const Scenario s = moving(0, 0, 1e-4);
  const Linearisation linear = linearise(s, v, of_step(fine));
  const Trajectory with = simulate(s, leaky, of_step(fine)), without = simulate(s, v, of_step(fine));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(linear.states);
  const int across = linear.states - n_missing_places + 5;
  double largest = 0, off = 0;
  for (std::size_t k = 0; k < linear.transition.size(); ++k) {
    const double mean = 0.5 * (of(without, Signal::load_pressure)[k] + of(without, Signal::load_pressure)[k + 1]);
    x[across] = -1e-14 * mean / s.oil.viscosity_ratio;
    x = linear.transition[k] * x;
    const double truth = of(with, Signal::load_pressure)[k + 1] - of(without, Signal::load_pressure)[k + 1];
    largest = std::max(largest, std::abs(truth)), off = std::max(off, std::abs(x[s_p_a] - x[s_p_b] - truth));
  }
  EXPECT_LT(off, 0.03 * largest) << largest;
}

TEST(Linearise, ConvergesWithTheStep) {
  // Over a tenth of a second, the response of all signals to a force; coarser steps come nearer as they shrink.
  const ParameterVector v = valve();
  const auto response = [&](double step) {
    const Linearisation linear = linearise(moving(0, 0), v, of_step(step));
    Eigen::VectorXd x = Eigen::VectorXd::Zero(linear.states);
    x[linear.states - n_missing_places + 6] = 1.0;
    for (std::size_t k = 0; k < 100; ++k) x = linear.transition[k] * x;
    return Eigen::Vector3d(x[s_x_piston] / 1e-6, x[s_p_a] / 1e3, x[s_p_b] / 1e3);
  };
  const Eigen::Vector3d limit = response(5e-6);
  double last = 1e300;
  for (const double step : {1e-3, 2.5e-4, 6.25e-5}) {
    const double off = (response(step) - limit).norm() / limit.norm();
    std::printf("  step %.3g s: off by %.2g\n", step, off);
    EXPECT_LT(off, 0.5 * last);
    last = off;
  }
  EXPECT_LT(last, 0.01);
}

TEST(Linearise, StuckPartStaysWhereADeviationPutIt) {
  // At rest in its friction; moved with what its asperities hold on to, it is as much at rest.
  ParameterVector v = valve();
  const Scenario still = made(0.1, 1e-3, [](double) { return 0.0; });
  const Linearisation linear = linearise(still, v, of_step(1e-4));
  ASSERT_TRUE(linear.ok);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(linear.states);
  x[s_x_piston] = 1e-6;
  const auto anchors = [&](double where) {
    for (int i = 1; i <= 3; ++i) x[linear.states - n_missing_places - 4 + i] = where;
  };
  anchors(1e-6);
  for (const Eigen::MatrixXd& t : linear.transition) x = t * x;
  EXPECT_NEAR(x[s_x_piston], 1e-6, 1e-8);
  // Not so without them: the asperities pull it back.
  x.setZero(), x[s_x_piston] = 1e-6;
  for (const Eigen::MatrixXd& t : linear.transition) x = t * x;
  EXPECT_LT(x[s_x_piston], 0.9e-6);
}

TEST(Linearise, PartThatSlidElsewhereStopsThere) {
  // Its asperities were dragged along: where it stops it is held, and not pulled to where the run stopped.
  ParameterVector v = valve();
  v[row::piston_coulomb_friction] = 3000;
  const auto stopping = [](double pressure) {
    Scenario s = moving(pressure, 0);
    for (std::size_t k = 0; k < s.time.size(); ++k) s.command[k] = s.time[k] < 0.05 ? 0.01 : 0, s.load_force[k] = 0;
    return s;
  };
  constexpr double more = 1e4;  // [Pa]
  const Linearisation linear = linearise(stopping(0), v, of_step(fine));
  const Trajectory with = simulate(stopping(more), v, of_step(fine)), without = simulate(stopping(0), v, of_step(fine));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(linear.states);
  x[s_p_a] = more;
  for (const Eigen::MatrixXd& t : linear.transition) x = t * x;
  const double truth = at(with, 200).piston - at(without, 200).piston;
  EXPECT_GT(std::abs(truth), 1e-7) << x[s_x_piston];
  EXPECT_NEAR(x[s_x_piston], truth, 0.1 * std::abs(truth));
}

TEST(Linearise, StrideIsTheProductOfItsSamples) {
  const Linearisation one = linearise(moving(0, 0), valve()), four = linearise(moving(0, 0), valve(), {}, 4);
  ASSERT_EQ(four.transition.size(), 50u);
  for (std::size_t k = 0; k < four.transition.size(); ++k) {
    Eigen::MatrixXd product = one.transition[4 * k];
    for (std::size_t j = 1; j < 4; ++j) product = (one.transition[4 * k + j] * product).eval();
    EXPECT_LT((product - four.transition[k]).norm(), 1e-9 * product.norm());
  }
}

}  // namespace
}  // namespace servodx
