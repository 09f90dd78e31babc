// Creeping sweeps of a test stand, taken as means: nothing is lost that the fit could use.
#include "fit/thin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "effects/flow_meter_lag.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/port_line.h"
#include "effects/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/support.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

constexpr double rated = 0.02, rate = 100;  // [A], [1/s]

// A triangle of +-`amplitude` whose command is read in steps, of half a per cent of rated current as a stand may.
Log sweep(double amplitude, double period, Signal measured = Signal::leakage_flow, double step = 1e-4) {
  Log log;
  log.path = "sweep.csv";
  for (int k = 0; k < static_cast<int>(period * rate); ++k) {
    const double turn = k / (period * rate) + 0.25, t = k / rate;
    log.time.push_back(t);
    const double current = amplitude * (1 - 4 * std::fabs(turn - std::floor(turn) - 0.5));
    const double toggle = 0.5 * step * (k % 2 ? 1 : -1);
    log.channels[index(Signal::command)].value.push_back(std::round((current + toggle) / step) * step);
    log.channels[index(measured)].value.push_back(1e-5 + 1e-6 * std::sin(0.1 * t));
  }
  return log;
}
RigFile rig_of_stand() {
  RigFile rig;
  rig.facts["valve.rated_current"] = rated;
  return rig;
}

TEST(Thin, ASweepIsTakenByItsRateAndNoCoarserThanTheStandIsFast) {
  const RigFile rig = rig_of_stand();
  for (const double period : {20.0, 100.0, 500.0, 2000.0}) {
    const Log log = sweep(0.2 * rated, period), thin = thinned(log, rig);
    const double step = (thin.time.back() - thin.time.front()) / static_cast<double>(thin.samples() - 1);
    const double travel = step * 4 * 0.2 / period;  // of rated
    EXPECT_LE(step, thin_time * 1.01) << period;
    EXPECT_LE(travel, thin_travel * 1.01) << period;
    EXPECT_TRUE(step > 0.7 * thin_time || travel > 0.7 * thin_travel) << period;  // and no finer than it need be
  }
}

TEST(Thin, MeansAreOfWhatIsThereAndGapsStayGaps) {
  Log log = sweep(0.2 * rated, 100);
  auto& flow = log.channels[index(Signal::leakage_flow)].value;
  for (std::size_t k = 0; k < flow.size(); k += 3) flow[k] = std::nan("");
  for (std::size_t k = 5000; k < log.time.size(); ++k) log.time[k] += 3.0;
  const Log thin = thinned(log, rig_of_stand());
  ASSERT_LT(thin.samples(), log.samples() / 10);
  ASSERT_EQ(thin.notes.size(), log.notes.size() + 1);
  EXPECT_EQ(thin.notes.back().kind, Note::Kind::resampled);
  for (std::size_t k = 0; k < thin.samples(); ++k) {
    const double t = thin.time[k], at = t > 51 ? t - 3.0 : t;
    EXPECT_NEAR(thin[Signal::leakage_flow][k], 1e-5 + 1e-6 * std::sin(0.1 * at), 2e-9) << t;
    EXPECT_FALSE(t > 50.0 && t < 53.0) << t;
  }
}

TEST(Thin, AStepOrAnActuatorIsLeftAsItIs) {
  Log step = sweep(0.2 * rated, 100);
  for (std::size_t k = 5000; k < step.samples(); ++k) step.channels[index(Signal::command)].value[k] += 0.5 * rated;
  EXPECT_EQ(thinned(step, rig_of_stand()).samples(), step.samples());
  const Log actuator = sweep(0.2 * rated, 100, Signal::piston_position);
  EXPECT_EQ(thinned(actuator, rig_of_stand()).samples(), actuator.samples());
}

TEST(Thin, TheModelSaysOfAThinnedSweepWhatItSaysOfAllItsSamples) {
  const RigFile rig = rig_of_stand();
  ParameterVector v = candidate_of(shipped_table());
  v[nuisance::command_slope] = 1.0;
  v[effect_row<FlowMeterLag>(1)] = 0.3;
  v[effect_row<MagneticHysteresis>(0)] = 0.015;
  v[effect_row<PortLine>(0)] = 2e-12;
  v[row::dead_volume_a] = 1e-3;  // a port that fills in half a second
  SimulateOptions all;
  all.wanted.fill(true);
  for (const double period : {20.0, 100.0}) {
    const Log log = sweep(0.2 * rated, period, Signal::leakage_flow, 1e-9), thin = thinned(log, rig);
    SimulateOptions coarse = all;
    coarse.creep_step = creep_step_of({log}, rig);
    const Trajectory full = simulate(prepare(log, rig).scenario, v, all),
                     few = simulate(prepare_thinned(log, rig).scenario, v, coarse);
    ASSERT_TRUE(full.ok && few.ok);
    for (const Signal s : {Signal::leakage_flow, Signal::load_pressure}) {
      const auto& q = full.signals[static_cast<std::size_t>(simulated_index(s))];
      const auto& p = few.signals[static_cast<std::size_t>(simulated_index(s))];
      const auto [low, high] = std::minmax_element(q.begin(), q.end());
      const std::size_t group = (log.samples() + thin.samples() - 1) / thin.samples();
      double square = 0, worst = 0;
      for (std::size_t k = 0; k < p.size(); ++k) {
        double mean = 0;
        const std::size_t to = std::min(q.size(), (k + 1) * group);
        for (std::size_t j = k * group; j < to; ++j) mean += q[j] / static_cast<double>(to - k * group);
        const double off = std::fabs(p[k] - mean) / (*high - *low);
        square += off * off, worst = std::max(worst, off);
      }
      RecordProperty(std::string(info(s).name), std::to_string(worst));
      EXPECT_LT(std::sqrt(square / static_cast<double>(p.size())), 2e-3) << info(s).name << ' ' << period;
      EXPECT_LT(worst, 2e-2) << info(s).name << ' ' << period;
    }
  }
}

}  // namespace
}  // namespace servodx
