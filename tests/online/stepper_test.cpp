// The stepper: the same bits as one run over the log, in whatever parts, through saved states.
#include "servodx/stepper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "effects/magnetic_hysteresis.h"
#include "effects/registry.h"
#include "effects/transport_delay.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "servodx/data_sheet.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "shipped_data.h"
#include "simulate/run_in_parts.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

constexpr std::size_t samples = 700;

LogData short_log() { return slice(shipped_data("healthy/h12_mixed"), 0, samples); }

StepperInputs inputs_at(const Scenario& s, std::size_t k) {
  StepperInputs in{.time = s.time[k], .command = s.command[k]};
  if (!s.supply_pressure.empty()) in.supply_pressure = s.supply_pressure[k];
  if (!s.return_pressure.empty()) in.return_pressure = s.return_pressure[k];
  if (!s.load_force.empty()) in.load_force = s.load_force[k];
  return in;
}

StepperOptions options_of(const Log& log) {
  StepperOptions options;
  double sum = 0;
  for (double t : log[Signal::oil_temperature]) sum += t;
  options.oil_temperature = sum / static_cast<double>(log.samples());
  return options;
}

struct Bench {
  LogData data = short_log();
  Table table = shipped_table();
  Rig rig = shipped_rig();
  StepperOptions options = options_of(shipped_log("healthy/h12_mixed"));
  Trajectory whole;

  Bench() {
    SimulateOptions how;
    whole = simulate(data.scenario, candidate_of(apply_rig_facts(table, rig)), how);
  }
  Stepper begin() const {
    const Scenario& s = data.scenario;
    return Stepper(table, rig, inputs_at(s, 0),
                   {s.spool_start, s.piston_start, s.pressure_a_start, s.pressure_b_start, s.piston_velocity_start},
                   options);
  }
  // Samples [from, to) in parts of `part`; what the four sensors show is held against the whole run.
  void go(Stepper& stepper, std::size_t from, std::size_t to, std::size_t part) const {
    for (std::size_t k = from; k < to; k += part) {
      std::vector<StepperInputs> next;
      for (std::size_t i = k; i < std::min(to, k + part); ++i) next.push_back(inputs_at(data.scenario, i));
      ASSERT_TRUE(stepper.step(next));
      for (Signal s : options.outputs) {
        const auto shown = stepper.outputs(s);
        ASSERT_EQ(shown.size(), next.size());
        for (std::size_t i = 0; i < shown.size(); ++i)
          ASSERT_EQ(shown[i], whole.signals[static_cast<std::size_t>(simulated_index(s))][k + i])
              << name_of(s) << " " << k + i;
      }
    }
  }
};

TEST(Stepper, AnyPartsGiveTheBitsOfTheWholeRun) {
  const Bench bench;
  for (std::size_t part : {std::size_t{1}, std::size_t{10}, std::size_t{333}}) {
    Stepper stepper = bench.begin();
    for (Signal s : bench.options.outputs)
      ASSERT_EQ(stepper.output(s), bench.whole.signals[static_cast<std::size_t>(simulated_index(s))][0]);
    bench.go(stepper, 1, samples, part);
  }
}

TEST(Stepper, ASavedStateGoesOnWithTheSameBits) {
  const Bench bench;
  Stepper first = bench.begin();
  bench.go(first, 1, 301, 10);
  const std::string state = first.state();
  Stepper second = Stepper::resume(bench.table, bench.rig, state, bench.options);
  EXPECT_EQ(second.time(), first.time());
  EXPECT_EQ(second.output(Signal::spool_position), first.output(Signal::spool_position));
  bench.go(second, 301, samples, 7);
}

// Effects remember too: a delay line, a hysteresis.
TEST(Stepper, TheMemoryOfEffectsIsPartOfTheState) {
  const LogData data = short_log();
  ParameterVector candidate = candidate_of(shipped_table());
  candidate[effect_row<TransportDelay>(0)] = 2.3e-3;
  candidate[effect_row<MagneticHysteresis>(0)] = 0.02;
  SimulateOptions how;
  const Trajectory whole = simulate(data.scenario, candidate, how);
  Scenario part = data.scenario;
  const auto cut = [&](std::size_t from, std::size_t to) {
    for (auto of : {&Scenario::time, &Scenario::command, &Scenario::supply_pressure, &Scenario::return_pressure,
                    &Scenario::load_force})
      if (const auto& all = data.scenario.*of; !all.empty())
        (part.*of).assign(all.begin() + static_cast<long>(from), all.begin() + static_cast<long>(to));
  };
  cut(0, 1);
  Trajectory shown;
  std::unique_ptr<RunInParts> run = run_in_parts(part, candidate, shown, how);
  for (std::size_t k = 1; k < samples; k += 50) {
    const std::size_t to = std::min(samples, k + 50);
    cut(k - 1, to);
    const std::string memory = run->memory();
    run = run_in_parts(part, candidate, shown, how);
    ASSERT_TRUE(run->recall(memory));
    ASSERT_FALSE(run->recall(memory + "x"));
    for (auto& signal : shown.signals)
      if (!signal.empty()) signal.resize(to - k + 1);
    ASSERT_TRUE(run->go_on());
    for (std::size_t i = k; i < to; ++i) ASSERT_EQ(shown.signals[0][i - k + 1], whole.signals[0][i]) << i;
  }
}

TEST(Stepper, AStateOfAnotherTableIsRefused) {
  const Bench bench;
  Stepper stepper = bench.begin();
  const std::string state = stepper.state();
  Table other = bench.table;
  other[other.find("spool_friction")].nominal *= 1.01;
  EXPECT_THROW(Stepper::resume(other, bench.rig, state, bench.options), InputError);
  EXPECT_THROW(Stepper::resume(bench.table, bench.rig, "{}", bench.options), InputError);
  EXPECT_THROW(Stepper::resume(bench.table, bench.rig, R"({"schema": "one"})", bench.options), InputError);
  EXPECT_THROW(Stepper::resume(bench.table, bench.rig, state.substr(0, state.size() / 2), bench.options), InputError);
}

TEST(Stepper, TimeThatDoesNotIncreaseIsRefusedAndChangesNothing) {
  const Bench bench;
  Stepper stepper = bench.begin();
  bench.go(stepper, 1, 11, 10);
  StepperInputs late = inputs_at(bench.data.scenario, 5);
  EXPECT_THROW(stepper.step(late), InputError);
  bench.go(stepper, 11, 31, 10);
}

TEST(Stepper, AShiftedRodIsShownShifted) {
  const Bench bench;
  Stepper stepper = bench.begin(), moved = bench.begin();
  moved.shift_rod(1e-3);
  const StepperInputs next = inputs_at(bench.data.scenario, 1);
  stepper.step(next), moved.step(next);
  EXPECT_NEAR(moved.output(Signal::piston_position) - stepper.output(Signal::piston_position), 1e-3, 1e-5);
}

}  // namespace
}  // namespace servodx
