// What a preflight test can tell of wear: the errors that the fit of the parameters states, on logs of the model's own.
#include "prognose/track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "base/random.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "fit/tuned_state.h"
#include "model/state.h"
#include "parameters/table.h"
#include "rig/excitations.h"
#include "rig/rig_model.h"
#include "servodx/log.h"
#include "simulate/scenario.h"
#include "support.h"

namespace servodx {
namespace {

// A table as `tune` leaves it: it knows how wrong it is. Sizes as it finds them on logs of the virtual rig.
Table tuned_table() {
  Table table = shipped_table();
  const ErrorModel error{{{Signal::spool_position, 0.5e-6, 0.1, 10},
                          {Signal::piston_position, 14e-6, 0.2, 7},
                          {Signal::pressure_a, 0.4e5, 1.5, 5},
                          {Signal::pressure_b, 0.4e5, 1.5, 5}}};
  set_tuned_state(table, {error, {}, {}, {}});
  return table;
}

// What a test of the model's own valve is read as, once `wear` has been at it.
Track tracked(const std::string& test, double duration, double celsius, const std::function<void(double*)>& wear) {
  const Table table = tuned_table();
  const rig::RigModel rig = rig::read_rig_model(SERVODX_SOURCE_DIR "/params/rigs/borello2009.toml");
  const rig::Stimulus stimulus = rig::make_stimulus(test, rig, {.duration = duration});
  LogData log;
  log.scenario.oil = oil_at(860, 14e-6, celsius + 273.15);
  for (int k = 0; k < static_cast<int>(duration * 1000); ++k) {
    log.scenario.time.push_back(k * 1e-3);
    log.scenario.command.push_back(stimulus.command(k * 1e-3, 0.0));
  }
  ParameterVector worn = candidate_of(table);
  wear(worn.data());
  const Trajectory t = simulate(log.scenario, worn);
  Random random(5);
  for (const auto& [signal, noise] : {std::pair{Signal::spool_position, 0.2e-6},
                                      {Signal::piston_position, 10e-6},
                                      {Signal::pressure_a, 0.1e5},
                                      {Signal::pressure_b, 0.1e5}}) {
    FitChannel channel{
        signal, simulated_index(signal), t.signals[static_cast<std::size_t>(simulated_index(signal))], noise, {}};
    for (double& x : channel.measured) x += noise * random.normal();
    log.channels.push_back(std::move(channel));
  }
  return track_parameters(log, table, {.threads = 1, .last = {}});
}

const TrackedParameter& of(const Track& track, std::string_view fault) {
  return *std::ranges::find_if(track.parameters, [&](const TrackedParameter& p) { return p.fault->name == fault; });
}

// Stated error of one wearing parameter after a test of the valve that wears so.
double stated_error(const std::string& test, double duration, const std::string& fault, double severity,
                    double celsius) {
  return of(tracked(test, duration, celsius, [&](double* v) { find_fault(fault)->apply(v, severity); }), fault)
      .std_error;
}

struct Wear {
  const char* fault;
  double severity, celsius;
};
class PreflightTest : public testing::TestWithParam<Wear> {};

// Reversals at full current tell the filter, the slow triangle the clearance. In the cold a triangle tells a clearance
// no better where its corners may have worn too (docs/not_done.md).
TEST_P(PreflightTest, OfWearTellsTheFilterTwiceAsWellAsThePapersAndTheClearanceBetter) {
  const auto [fault, severity, celsius] = GetParam();
  const double paper = stated_error("preflight", 0.8, fault, severity, celsius),
               slew = stated_error("preflight_slew", 1.51, fault, severity, celsius),
               wear = stated_error("preflight_wear", 2.75, fault, severity, celsius);
  if (std::string_view(fault) == "clogged_filter") {
    EXPECT_LT(slew, 0.5 * paper);
    EXPECT_LT(wear, 0.5 * paper);
  } else {
    EXPECT_LT(wear, 0.8 * paper);
    EXPECT_LT(wear, 0.8 * slew);
  }
}

INSTANTIATE_TEST_SUITE_P(, PreflightTest,
                         testing::Values(Wear{"clogged_filter", 0.375, 40}, Wear{"clogged_filter", 0.375, -15},
                                         Wear{"radial_clearance_wear", 2.5, 40}));

constexpr double slew = 1.51;  // [s] of preflight_slew

TEST(Track, AHealthyValveIsToldNothing) {
  for (const TrackedParameter& p : tracked("preflight_slew", slew, 40, [](double*) {}).parameters) {
    EXPECT_FALSE(p.told) << p.fault->name << " " << p.severity << " +- " << p.whole_error;
    EXPECT_NEAR(p.value, p.tuned, 2 * p.whole_error) << p.fault->name;
  }
}

// Fig. 12 of the prognostic paper is of such a valve. As if its corners were new, it reads as half of its clearance or
// less, and a backlash.
TEST(Track, AClearanceIsReadBesideCornersThatHaveWornWithIt) {
  const Fault& wear = *find_fault("radial_clearance_wear");
  const ParameterVector healthy = candidate_of(tuned_table());
  struct Worn {
    double times, share;
  };
  for (const Worn worn : {Worn{3, 2}, Worn{6, 1.6}, Worn{10, 4}, Worn{6, 0}}) {
    const Track track = tracked("preflight_slew", slew, 40, [&](double* v) {
      wear.apply(v, worn.times);
      wear.along->apply(v, healthy.data(), worn.share);
    });
    const TrackedParameter& clearance = of(track, wear.name);
    EXPECT_TRUE(clearance.told) << worn.times;
    EXPECT_NEAR(clearance.value, worn.times * clearance.tuned, 2 * clearance.whole_error) << worn.times;
    EXPECT_NEAR(clearance.severity, worn.times, 0.1 * worn.times);
    ASSERT_TRUE(clearance.along) << worn.times;
    EXPECT_NEAR(clearance.along->value, worn.share, 2 * clearance.along->whole_error + 0.01) << worn.times;
    for (const TrackedParameter& p : track.parameters)
      EXPECT_EQ(p.told, p.fault == &wear)
          << worn.times << " " << p.fault->name << " " << p.severity << " +- " << p.whole_error;
  }
}

// As if nothing wore along, and where nothing has worn: the first checks of a valve tell as much.
TEST(Track, WhatWearsAlongActsOnNothingInHealth) {
  const ParameterVector healthy = candidate_of(tuned_table());
  for (const Progressive& p : progressive_faults()) {
    if (!p.fault->along) continue;
    for (const double share : {0.0, p.fault->along->likely, p.fault->along->most}) {
      ParameterVector v = healthy;
      p.fault->along->apply(v.data(), healthy.data(), share);
      EXPECT_EQ(v, healthy) << p.fault->name << " " << share;
    }
  }
}

// Nothing that wears makes a motor stronger than a track lets it be. The reading stands at the end of the range, and so
// do the numbers that take up the rest; none of them is told by its curvature there.
TEST(Track, AReadingAtTheEndOfItsRangeErrsByWhatTheRangeHoldsBack) {
  constexpr double stronger = 1.4;
  const Track track =
      tracked("preflight_slew", slew, 40, [&](double* v) { find_fault("torque_motor_loss")->apply(v, stronger); });
  const TrackedParameter& motor = of(track, "torque_motor_loss");
  const double held_back = stronger * motor.tuned - motor.value;
  ASSERT_GT(held_back, 0.1 * motor.tuned) << "the range does not end before it";
  EXPECT_GT(motor.whole_error, 0.4 * held_back);
  EXPECT_GT(motor.whole_error, 3 * motor.std_error);
  EXPECT_FALSE(motor.told);
}

}  // namespace
}  // namespace servodx
