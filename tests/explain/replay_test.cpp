// What the model wrote with a friction, a leak or another oil in it, read from the replay of its blocks: which it is
// and how large, with the sensors' noise on the log.
#include "explain/replay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "effects/registry.h"
#include "explain/engine.h"
#include "explain/missing_support.h"

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
  ReplaySubject blocks(valve, valve.problem({})->start());
  const ExplainedFit base = fit_base(blocks, 12);
  EXPECT_TRUE(base.ok);
  Read out;
  double most = 0;
  const std::vector<CauseScore> scores = score_causes(blocks, base);
  for (const CauseScore& s : scores) {
    const Cause& c = blocks.causes()[static_cast<std::size_t>(s.cause)];
    if (s.gain > most) most = s.gain, out.name = c.effect;
  }
  EngineOptions options;
  options.among = [&](const Cause& c) { return c.effect == cause; };
  options.most = 1;
  const Explanation e = explain(blocks, options);
  if (e.causes.empty()) return out;
  out.value = e.causes.front().value, out.std_error = e.causes.front().std_error;
  out.gain = e.causes.front().heldout_gain.value;
  for (const Number& n : blocks.causes()[static_cast<std::size_t>(e.causes.front().cause)].numbers) out.off.push_back(n.off);
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

TEST(Replay, ASensorsGainIsNoPhysics) {
  const int at = effect_row<SensorResponse>(2);  // pressure A
  const Rehearsed r(log_name, {.change = [&](ParameterVector& p) { p[static_cast<std::size_t>(at)] = 1.06; }}, all, 5);
  const Read found = read_off(r, "sensor_gain_error");
  EXPECT_EQ(found.name, "sensor_gain_error");
}

TEST(Replay, WithoutPressuresThereIsNone) {
  const Rehearsed r(log_name, {}, {Signal::spool_position, Signal::piston_position}, 6);
  const ValveSubject valve({r.log}, r.table, r.rig, 1, {});
  EXPECT_TRUE(ReplaySubject(valve, valve.problem({})->start()).empty());
}

}  // namespace
}  // namespace servodx
