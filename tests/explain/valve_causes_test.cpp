// Which causes are sought of a valve, decided from facts that are made up here: no log is read and nothing is fitted.
#include "explain/valve_causes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "effects/armature_angle.h"
#include "effects/effect.h"
#include "effects/flow_meter_lag.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/mains_pickup.h"
#include "effects/registry.h"
#include "effects/row_effects.h"
#include "effects/stiction.h"
#include "effects/unexplained.h"
#include "effects/viscosity_change.h"
#include "explain/sought_cause.h"
#include "explain/subject.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "faults/sizes.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

const std::string source = SERVODX_SOURCE_DIR;

struct Shipped {
  Table table = read_table(source + "/params/borello2009.csv");
  ParameterVector tuned = candidate_of(table);
  CauseFacts facts{table, tuned};
  Shipped() { facts.compared = {Signal::spool_position, Signal::piston_position}; }
};

const EffectInfo& effect(const std::string& name) {
  return *std::find_if(effect_list().begin(), effect_list().end(), [&](const EffectInfo& e) { return e.name == name; });
}

template <class F>
long count(const std::vector<SoughtCause>& all, F f) {
  return std::count_if(all.begin(), all.end(), [&](const SoughtCause& c) { return f(c.cause); });
}

TEST(ValveCauses, EachIsTriedAtSizesWithinItsBoundsAndNeverWhereItIs) {
  const Shipped s;
  const std::vector<SoughtCause> all = valve_causes(s.facts);
  ASSERT_GT(all.size(), 40u);
  for (const auto& [cause, values] : all) {
    SCOPED_TRACE(cause.effect + " at " + cause.where);
    ASSERT_EQ(cause.numbers.size(), values.size());
    ASSERT_FALSE(cause.probes.empty());
    for (const auto& alternative : cause.probes)
      for (const std::vector<double>& probe : alternative) {
        ASSERT_EQ(probe.size(), values.size());
        bool moved = false;
        for (std::size_t j = 0; j < probe.size(); ++j) {
          moved |= probe[j] != values[j].start;
          const double rounding = 1e-12 * (values[j].upper - values[j].lower);
          EXPECT_GE(probe[j], values[j].lower - rounding) << values[j].name;
          EXPECT_LE(probe[j], values[j].upper + rounding) << values[j].name;
        }
        EXPECT_TRUE(moved);
      }
  }
}

TEST(ValveCauses, RowHasThePlaceOfTheEffectThatItIs) {
  for (const RowEffect& e : row_effects())
    for (const int at : e.rows) EXPECT_EQ(parameter_list[static_cast<std::size_t>(at)].place, e.where) << e.name;
}

TEST(ValveCauses, EffectIsSoughtWhereTheLogsCouldTellIt) {
  Shipped s;
  EXPECT_EQ(sought_as(effect(Stiction::name), s.facts), SoughtAs::whole);
  EXPECT_EQ(sought_as(effect(MainsPickup::name), s.facts), SoughtAs::line_by_line);
  EXPECT_EQ(sought_as(effect(FlowMeterLag::name), s.facts), SoughtAs::meter_by_meter);
  EXPECT_EQ(sought_as(effect(Unexplained::name), s.facts), SoughtAs::nothing);
  EXPECT_EQ(sought_as(effect(ViscosityChange::name), s.facts), SoughtAs::whole);
  s.facts.oil_known = false;
  EXPECT_EQ(sought_as(effect(ViscosityChange::name), s.facts), SoughtAs::nothing);
  for (const EffectInfo& e : effect_list()) {
    if (!e.stand_only || sought_as(e, s.facts) == SoughtAs::meter_by_meter) continue;
    s.facts.on_stand = false;
    EXPECT_EQ(sought_as(e, s.facts), SoughtAs::nothing) << e.name;
    s.facts.on_stand = true;
    EXPECT_EQ(sought_as(e, s.facts), e.as_made || e.shapes_rows ? SoughtAs::nothing : SoughtAs::whole) << e.name;
  }
}

TEST(ValveCauses, MeasuredPressureIsNoCause) {
  Shipped s;
  EXPECT_TRUE(is_sought_alone(row::supply_pressure, s.facts));
  s.facts.supply_measured = true;
  EXPECT_FALSE(is_sought_alone(row::supply_pressure, s.facts));
  EXPECT_FALSE(is_sought_alone(row::servovalve_null, s.facts));  // a log's own
  EXPECT_FALSE(is_sought_alone(row::lap_pa, s.facts));           // a row effect's
}

TEST(ValveCauses, ConstructionIsRareWhereHealthyLogsAreKnown) {
  EXPECT_EQ(prior_of_effect(effect(ArmatureAngle::name), false), 1.0);
  EXPECT_LT(prior_of_effect(effect(ArmatureAngle::name), true), 1.0);
  EXPECT_EQ(prior_of_effect(effect(Stiction::name), true), 1.0);
}

TEST(ValveCauses, SensorThatNoLogComparesIsNoSuspect) {
  Shipped s;
  const auto of_pressure = [](const Cause& c) { return c.where == "sensor:pressure_a"; };
  EXPECT_EQ(count(valve_causes(s.facts), of_pressure), 0);
  s.facts.compared.insert(Signal::pressure_a);
  EXPECT_EQ(count(valve_causes(s.facts), of_pressure), 3);  // pick-up, gain, lag
}

TEST(ValveCauses, PickUpHasAPhaseInEachLogAndTheFrequencyThatTheRigStates) {
  Shipped s;
  s.facts.logs = 2;
  s.facts.mains_frequency = 60.0;
  for (const auto& [cause, values] : valve_causes(s.facts)) {
    if (cause.effect != MainsPickup::name || !cause.places.empty()) continue;
    EXPECT_EQ(values.size(), 5u);
    EXPECT_EQ(values.back().log, 1);
    for (const auto& alternative : cause.probes) {
      EXPECT_EQ(alternative.size(), 4u);
      for (const std::vector<double>& probe : alternative) EXPECT_NEAR(probe[0], 60.0, 0.2);
    }
  }
}

TEST(ValveCauses, PickUpOfTheSensorsGroundIsOneCauseWithALineOnEach) {
  const auto of_ground = [](const CauseFacts& facts) {
    std::vector<Cause> out;
    for (const SoughtCause& c : valve_causes(facts))
      if (c.cause.effect == MainsPickup::name && !c.cause.places.empty()) out.push_back(c.cause);
    return out;
  };
  Shipped s;
  s.facts.logs = 2;
  const std::vector<Cause> found = of_ground(s.facts);
  ASSERT_EQ(found.size(), 1u);
  const Cause& c = found.front();
  EXPECT_FALSE(is_of_sensor(c)) << "judged by all channels";
  ASSERT_EQ(c.places.size(), c.numbers.size());
  ASSERT_EQ(c.numbers.size(), 2 * 1 + 2 * 2 * 2u) << "a frequency each, and of each log a cosine and a sine each";
  for (const char* channel : {"sensor:spool_position", "sensor:piston_position"})
    EXPECT_EQ(std::count(c.places.begin(), c.places.end(), channel), 5) << channel;
  for (const auto& together : c.probes) EXPECT_EQ(together.size(), 8u);
  s.facts.compared = {Signal::spool_position};
  EXPECT_TRUE(of_ground(s.facts).empty()) << "one sensor's line is its own";
}

TEST(ValveCauses, ALeakIsSoughtAsFarAsTheFaultGoesOnAValveOfThisSize) {
  Shipped s;
  const auto farthest = [&] {
    for (const auto& [cause, values] : valve_causes(s.facts))
      if (values.size() == 1 && values.front().at == row::cross_piston_leakage) return values.front().upper;
    return 0.0;
  };
  const Fault& leak = *find_fault("cylinder_leakage");
  const double usual = farthest();
  EXPECT_DOUBLE_EQ(usual, sizes_of(leak, s.tuned.data()).worst);
  s.tuned[row::port_width] *= 10;
  EXPECT_DOUBLE_EQ(farthest(), 10 * usual);
}

TEST(ValveCauses, SizesGoOneByOneThenTogetherThenWithATypicalShape) {
  const std::vector<CauseNumber> numbers = {{{"size", 0, 0, 10, false, 1}, "m", true, {2, 3}},
                                            {{"other", 1, 0, 10, false, 5}, "N", true, {7}},
                                            {{"shape", 2, 0, 1, false, 0.5}, "-", false, {}, 0.25}};
  const std::vector<std::vector<std::vector<double>>> plain = {
      {{2, 5, 0.5}}, {{3, 5, 0.5}}, {{1, 7, 0.5}}, {{2, 5, 0.5}, {1, 7, 0.5}}};
  auto expected = plain;
  for (auto alternative : plain) {
    for (std::vector<double>& probe : alternative) probe[2] = 0.25;
    expected.push_back(alternative);
  }
  EXPECT_EQ(probes_of(numbers), expected);
}

TEST(ValveCauses, AShapeThatTuningHasFoundMayMoveByItsErrorAndOneThatItHasNotFreely) {
  Shipped s;
  Row fading;
  fading.name = "hysteresis_fading", fading.nominal = 0.9, fading.std_error = 0.04;
  s.table.rows.push_back(fading);
  s.tuned[static_cast<std::size_t>(effect_row<MagneticHysteresis>(2))] = 0.9;
  const std::vector<SoughtCause> all = valve_causes(s.facts);
  const auto hysteresis = std::find_if(all.begin(), all.end(),
                                       [](const SoughtCause& c) { return c.cause.effect == MagneticHysteresis::name; });
  ASSERT_NE(hysteresis, all.end());
  EXPECT_EQ(hysteresis->values.size(), std::size_t{MagneticHysteresis::n_parameters});
  EXPECT_EQ(hysteresis->cause.ties, (std::vector<std::vector<double>>{{0, 0, 1 / 0.04}}));
}

}  // namespace
}  // namespace servodx
