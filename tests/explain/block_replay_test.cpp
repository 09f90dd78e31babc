// What the model wrote with a friction, a leak or another oil in it, read from the replay of its blocks: which it is
// and how large, with the sensors' noise on the log.
#include "explain/block_replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "effects/registry.h"
#include "effects/sampled_lag.h"
#include "effects/sensor_response.h"
#include "effects/unexplained.h"
#include "effects/viscosity_change.h"
#include "explain/cause_score.h"
#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/learnt_curves.h"
#include "explain/missing_support.h"
#include "explain/score.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

const std::set<Signal> all = {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b};
const char* const log_name = "healthy/h12_mixed";

struct Read {
  std::string name;                           // that promises most
  std::vector<double> value, std_error, off;  // of the cause asked for
  double gain = 0;                            // held out
};
Read read_off(const Rehearsed& r, const std::string& cause) {
  const ValveSubject valve({r.log}, r.table, r.rig, 1, {});
  ReplaySubject blocks(valve, valve.start({}));
  const ExplainedFit base = fit_base(blocks, 12);
  EXPECT_TRUE(base.ok);
  Read out;
  double most = 0;
  const std::vector<CauseScore> scores = score_causes(blocks, base);
  for (const CauseScore& s : scores) {
    const Cause& c = blocks.causes()[static_cast<std::size_t>(s.cause)];
    // The logs come from a rig whose supply sags when healthy: only healthy logs can tell that it is no news.
    if (s.gain > most && (c.effect == cause || c.effect != "supply_droop")) most = s.gain, out.name = c.effect;
  }
  EngineOptions options;
  options.among = [&](const Cause& c) { return c.effect == cause; };
  options.most = 1;
  const FoundCauses e = explain(blocks, options);
  if (e.causes.empty()) return out;
  out.value = e.causes.front().value, out.std_error = e.causes.front().std_error;
  out.gain = e.causes.front().heldout_gain.value;
  for (const Number& n : blocks.causes()[static_cast<std::size_t>(e.causes.front().cause)].numbers)
    out.off.push_back(n.off);
  return out;
}

TEST(Replay, NothingIsReadFromWhatTheTableWrote) {
  const Rehearsed r(log_name, {}, all, 1);
  for (const char* cause : {"stribeck_friction", "viscosity_change", "cross_piston_leakage"}) {
    const Read found = read_off(r, cause);
    EXPECT_TRUE(found.value.empty()) << cause << " " << found.value.front();
  }
}

TEST(Replay, BreakawayFrictionIsReadThoughTheSimulationSticksElsewhere) {
  for (const double more : {200.0, 500.0}) {
    const Rehearsed r(log_name, {.change = [&](ParameterVector& p) { p[row::piston_stribeck_friction] += more; }}, all,
                      2);
    const Read found = read_off(r, "stribeck_friction");
    ASSERT_FALSE(found.value.empty());
    EXPECT_EQ(found.name, "stribeck_friction");
    // How much is left at a speed is what slides show: the size goes with the film's speed.
    EXPECT_NEAR(found.value[0] - found.off[0], more, 0.5 * more);
    EXPECT_GT(found.gain, 0);
  }
}

TEST(Replay, AnotherOilIsReadFromFrictionAndLeaksTogether) {
  for (const double factor : {0.4, 2.5}) {
    const int at = effect_row<ViscosityChange>(0);
    const Rehearsed r(log_name, {.change = [&](ParameterVector& p) { p[static_cast<std::size_t>(at)] = factor; }}, all,
                      3);
    const Read found = read_off(r, "viscosity_change");
    ASSERT_FALSE(found.value.empty());
    EXPECT_NEAR(std::log(found.value[0]), std::log(factor), 0.2) << found.value[0];
  }
}

TEST(Replay, LeakageIsReadFromTheFlows) {
  constexpr double leak = 4e-12;  // [m3/s/Pa]
  const Rehearsed r(log_name, {.leak = leak}, all, 4);
  const Read found = read_off(r, "cross_piston_leakage");
  ASSERT_FALSE(found.value.empty());
  EXPECT_EQ(found.name, "cross_piston_leakage");
  EXPECT_NEAR(found.value[0] - found.off[0], leak, 0.1 * leak);
}

TEST(Replay, SupplyThatSagsWithTheFlowIsReadThoughTheSimulationIsDrivenByIt) {
  Rehearsed r(log_name, {}, all, 6);
  const Read healthy = read_off(r, "supply_droop");
  // What the rod draws by, added to what the rig's own supply does.
  constexpr double resistance = 2e10, recovery = 20e-3;  // [Pa s/m3], [s]
  const std::vector<double> x = quiet(r.log.time, r.log[Signal::piston_position]);
  SampledLag<double> drawn;
  std::vector<double>& supply = r.log.channels[index(Signal::supply_pressure)].value;
  const double area = r.table[row::piston_area_a].nominal;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const std::size_t from = k > 0 ? k - 1 : 0, to = std::min(k + 1, x.size() - 1);
    const double speed = std::abs(x[to] - x[from]) / (r.log.time[to] - r.log.time[from]);
    supply[k] -= drawn(r.log.time[k], resistance * area * speed, recovery);
  }
  const Read found = read_off(r, "supply_droop");
  ASSERT_FALSE(found.value.empty());
  const double before = healthy.value.empty() ? 0.0 : healthy.value[0];
  EXPECT_NEAR(found.value[0] - before, resistance, 0.15 * resistance) << before;
}

TEST(Replay, ASensorsGainIsNoPhysics) {
  const int at = effect_row<SensorResponse>(2);  // pressure A
  const Rehearsed r(log_name, {.change = [&](ParameterVector& p) { p[static_cast<std::size_t>(at)] = 1.06; }}, all, 5);
  const Read found = read_off(r, "sensor_gain_error");
  EXPECT_EQ(found.name, "sensor_gain_error");
}

// The curve whose place and variables the truth has promises most, and is what was planted where the log has been.
TEST(Replay, WhatHasNoNameIsReadAsACurveOfItsOwnVariables) {
  using U = Unexplained;
  KnownRig known;  // what is left where nothing is missing: a planted force remembers itself over the whole log
  for (std::uint32_t seed = 11; seed < 14; ++seed) {
    const Rehearsed healthy(log_name, {}, all, seed);
    const ValveSubject valve({healthy.log}, healthy.table, healthy.rig, 1, KnownRig{});
    ReplaySubject blocks(valve, valve.start({}));
    for (const UsualError& e : blocks.errors(fit_base(blocks, 12).residual)) known.errors.push_back(e);
  }
  struct Planted {
    int factor;
    double knots[U::knots];  // [N]
    const char* family;
  };
  for (const Planted& planted :
       {Planted{U::one, {3000, 900, 350, 0, -350, -900, -3000}, "replay/piston_position"},
        Planted{
            U::by_velocity, {-900, -500, -200, -50, -200, -500, -900}, "replay/piston_position by piston_velocity"}}) {
    constexpr double scale = 0.02;  // [m]
    const auto put = [&](ParameterVector& p) {
      const auto at = [&](int k) -> double& { return p[static_cast<std::size_t>(effect_row<U>(k))]; };
      at(0) = U::piston, at(1) = U::piston_position, at(2) = planted.factor, at(3) = scale;
      for (int k = 0; k < U::knots; ++k) at(4 + k) = planted.knots[k];
    };
    const Rehearsed r(log_name, {.change = put}, all, 7);
    ValveSubject valve({r.log}, r.table, r.rig, 1, KnownRig{});
    const std::vector<Curve> curves = add_curves(valve);
    ReplaySubject blocks(valve, valve.start({}), known);
    EngineOptions options;
    options.among = [](const Cause& c) { return c.curve; };
    options.most = 1;
    const FoundCauses e = explain(blocks, options);
    ASSERT_EQ(e.causes.size(), 1u);
    EXPECT_EQ(blocks.causes()[static_cast<std::size_t>(e.causes.front().cause)].family, planted.family);
    const auto curve =
        std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.cause == e.causes.front().cause; });
    ASSERT_NE(curve, curves.end());
    const auto value = [](const double* knots, double x, double its_scale) {
      double s = x / std::hypot(x, its_scale), power = 1, sum = 0;
      for (int j = 0; j < U::knots; ++j, power *= s)
        for (int k = 0; k < U::knots; ++k) sum += curve::powers[j][k] * power * knots[k];
      return sum;
    };
    for (const double x : {-0.02, -0.01, 0.01, 0.02}) {
      const double truth = value(planted.knots, x, scale);
      EXPECT_NEAR(value(e.causes.front().value.data(), x, curve->scale), truth, 30 + 0.1 * std::abs(truth)) << x;
    }
  }
}

TEST(Replay, WithoutPressuresThereIsNone) {
  const Rehearsed r(log_name, {}, {Signal::spool_position, Signal::piston_position}, 6);
  const ValveSubject valve({r.log}, r.table, r.rig, 1, {});
  EXPECT_TRUE(ReplaySubject(valve, valve.start({})).empty());
}

}  // namespace
}  // namespace servodx
