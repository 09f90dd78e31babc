// Prognostic paper, sections 3 and 7: backlash and a weak wire take the closed loop's stability. Margins of the
// linearised model, limit cycles by describing functions beside the virtual rig's, and failure levels by margin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "faults/registry.h"
#include "model/state.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "prognose/loop_margins.h"
#include "prognose/monitor.h"
#include "prognose/performance_limits.h"
#include "prognose/trend_options.h"
#include "rig/excitations.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "signals/log.h"
#include "simulate/scenario.h"
#include "support.h"

namespace servodx {
namespace {

const Supply flight{207e5, 5e5, {}, 0.02};
constexpr double hold = 0.5e-3;  // [s] of a controller at 1 kHz

// The virtual rig's laps, clearance and friction, as its file has them: what a tune would find.
Table table_of_the_rig() {
  Table t = shipped_table();
  t[row::lap_pa].nominal = 9e-6, t[row::lap_at].nominal = 10e-6;
  t[row::lap_pb].nominal = 10.5e-6, t[row::lap_bt].nominal = 8.5e-6;
  t[row::radial_clearance].nominal = 3e-6;
  t[row::spool_friction].nominal = 1.5;
  return t;
}

ParameterVector with(const PositionLoop& loop, const char* fault, double severity) {
  ParameterVector v = loop.healthy();
  find_fault(fault)->apply(v.data(), severity);
  return v;
}

TEST(PrognosticPaperStability, AnIntegratorAloneHasNinetyDegreesAtItsVelocityGain) {
  const PositionLoop loop(shipped_table(), flight, 15);
  const Margins m = loop.margins(loop.healthy(), 1e-4);
  // Far below the valve's bandwidth: crossing at 15 rad/s, little lag, and the resonance of the oil far away.
  EXPECT_NEAR(m.phase_frequency, 15 / 6.283, 0.1);
  EXPECT_GT(m.phase, 80);
  EXPECT_LT(m.phase, 90);
  EXPECT_GT(m.gain, 20);
  // Twice the gain is 6 dB, and a delay is its angle.
  const PositionLoop faster(shipped_table(), flight, 30);
  EXPECT_NEAR(m.gain - faster.margins(faster.healthy(), 1e-4).gain, 20 * std::log10(2.0), 0.01);
  const PositionLoop late(shipped_table(), flight, 15, 5e-3);
  EXPECT_NEAR(m.phase - late.margins(late.healthy(), 1e-4).phase, 360 * 5e-3 * m.phase_frequency, 0.2);
}

TEST(PrognosticPaperStability, BacklashAndALostWireTakeBothMargins) {
  const PositionLoop loop(shipped_table(), flight, 50, hold);
  const double amplitude = judged_amplitude(shipped_table(), flight);
  EXPECT_NEAR(amplitude, 20e-6, 2e-6);  // 4 % of 0.5 mm, less what the flow force takes
  for (const auto& [fault, severities] :
       {std::pair{"feedback_wire_backlash", std::vector<double>{0, 5e-6, 10e-6, 20e-6, 30e-6}},
        std::pair{"feedback_wire_lost", std::vector<double>{1, 0.7, 0.5, 0.3, 0.2}}}) {
    Margins before = loop.margins(loop.healthy(), amplitude);
    for (std::size_t k = 1; k < severities.size(); ++k) {
      const Margins m = loop.margins(with(loop, fault, severities[k]), amplitude);
      EXPECT_LT(m.gain, before.gain) << fault << " " << severities[k];
      EXPECT_LT(m.phase, before.phase) << fault << " " << severities[k];
      before = m;
    }
  }
  // A healthy valve does not cycle.
  EXPECT_FALSE(loop.limit_cycle(loop.healthy(), 5e-4));
}

struct Cycle {
  double frequency = 0, spool = 0, piston = 0;  // [Hz], [m], [m]
};
// The virtual rig under proportional control [A/m], kicked by half a millimetre; the last second.
Cycle of_the_rig(double gain, double backlash) {
  rig::RigRun run;
  run.duration = 2;
  run.noise = false;
  if (backlash > 0) run.faults["feedback_wire_backlash"] = {backlash};
  const rig::Stimulus kicked{
      .command = [=](double t, double x) { return gain * ((t > 0.3 && t < 0.5 ? 0.5e-3 : 0.0) - x); },
      .setpoint = {},
      .load = {}};
  const auto log = run_rig(rig::read_rig_model(SERVODX_SOURCE_DIR "/params/rigs/borello2009.toml"), run, kicked);
  Cycle c;
  for (const OutputColumn& column : log.columns) {
    const std::vector<double> last(column.value.end() - 1000, column.value.end());
    const auto [low, high] = std::minmax_element(last.begin(), last.end());
    const double middle = 0.5 * (*low + *high);
    if (column.signal == Signal::piston_position) c.piston = 0.5 * (*high - *low);
    if (column.signal != Signal::spool_position) continue;
    c.spool = 0.5 * (*high - *low);
    for (std::size_t k = 1; k < last.size(); ++k) c.frequency += last[k - 1] < middle && last[k] >= middle;
  }
  return c;
}

// Amplitude of the spool within a tenth. The rig's friction holds on longer than it drags, which slows the cycle: its
// frequency lies up to a third below the first harmonic's, and the piston goes further by as much.
TEST(PrognosticPaperStability, BacklashCyclesAsTheDescribingFunctionSays) {
  const Table table = table_of_the_rig();
  for (const auto& [gain, backlash] : {std::pair{3.0, 40e-6}, std::pair{6.0, 30e-6}, std::pair{6.0, 40e-6}}) {
    const PositionLoop loop(table, flight, 15 * gain, hold);
    EXPECT_NEAR(loop.gain(), gain, 0.05 * gain);  // rated current 20 mA drives 300 mm/s: 1 A/m is 15 1/s
    const auto predicted = loop.limit_cycle(with(loop, "feedback_wire_backlash", backlash), 5e-4);
    ASSERT_TRUE(predicted);
    const Cycle seen = of_the_rig(gain, backlash);
    EXPECT_NEAR(predicted->spool / seen.spool, 1, 0.1) << gain << " " << backlash;
    EXPECT_NEAR(predicted->frequency / seen.frequency, 1.3, 0.25) << gain << " " << backlash;
    EXPECT_NEAR(predicted->piston / seen.piston, 0.7, 0.2) << gain << " " << backlash;
    RecordProperty("cycle", std::to_string(seen.frequency));
  }
  EXPECT_LT(of_the_rig(3.0, 0).spool, 1e-6);
}

TEST(PrognosticPaperStability, ALimitOfMarginIsTheWearThatLeavesIt) {
  const Table table = shipped_table();
  const PositionLoop loop(table, {207e5, 5e5, {}, 0.02}, 50);
  const double amplitude = judged_amplitude(table, {207e5, 5e5, {}, 0.02});
  TrendSettings by_gain, by_phase;
  add_limit(read_limit("margin=6dB"), table, 50, by_gain);
  const double backlash = *by_gain.failure.at("parameter:9").second;
  EXPECT_NEAR(loop.margins(with(loop, "feedback_wire_backlash", backlash), amplitude).gain, 6, 0.3);
  add_limit(read_limit("margin=45deg"), table, 50, by_phase);
  for (const char* row : {"parameter:1", "parameter:9", "parameter:14"})
    EXPECT_TRUE(by_phase.failure.at(row).second) << row;
  EXPECT_LT(*by_phase.failure.at("parameter:9").second, backlash);
  // A weak motor makes the loop slower and no less stable: its own level stays.
  EXPECT_FALSE(by_phase.failure.contains("parameter:3"));
}

TEST(PrognosticPaperStability, MarginsThatCannotBeAreRefused) {
  TrendSettings options;
  for (const char* text : {"margin=6", "margin=dB", "margin=-3dB", "margin=95deg", "margin=59dB"})
    EXPECT_THROW(add_limit(read_limit(text), shipped_table(), 15, options), InputError) << text;
  EXPECT_THROW(add_limit(read_limit("margin=6dB"), shipped_table(), 0, options), InputError);
}

}  // namespace
}  // namespace servodx
