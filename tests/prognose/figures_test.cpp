// Figs. 8 to 12 of Borello et al. 2009 on the virtual rig: each degradation moves the check that the paper draws of it,
// in the paper's direction and within what our theory lets it. Fig. 13 is in trend_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "fit/log_data.h"
#include "prognose/checks.h"
#include "prognose/monitor.h"
#include "prognose/preflight.h"
#include "prognose/preflight_figures.h"
#include "rig/rig_faults.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "servodx/monitor.h"
#include "signals/log.h"
#include "support.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

rig::RigModel flight_rig() { return rig::read_rig_model(SERVODX_SOURCE_DIR "/params/rigs/borello2009.toml"); }

LogData log_of(const rig::RigRun& run) {
  const TemporaryFolder folder;
  write_log(folder / "log.csv", run_rig(flight_rig(), run).columns);
  return prepare(read_log(folder / "log.csv"), {});
}

MonitorParameters monitor_of(const LogData& data) {
  return monitor_parameters(shipped_table(), supply_of(data, shipped_table()));
}

// r and E(tau) of one test, as Figs. 8, 9 and 12 show them: a step of 10 %, and 0.5 of 20 mA at 5 Hz.
struct Shown {
  double fidelity = NAN, correlation = NAN;
};
Shown shown_with(const rig::FaultSet& faults, double duration) {
  const LogData data =
      log_of({.excitation = "preflight_slew", .duration = duration, .amplitude = 0.025, .faults = faults});
  const Preflight test = find_preflight(data);
  const MonitorParameters monitor = monitor_of(data);
  const MonitorRun at_rest = run_monitor(monitor, linear_pressure(monitor), data, test.rest_current);
  const PreflightFigures seen = figures_of(data.scenario.time, test, measured_traces(data), at_rest.spool);
  Shown out;
  if (seen.fidelity && !seen.fidelity->no_response) out.fidelity = seen.fidelity->figure.value;
  for (std::size_t i = 0; i < test.sines.size(); ++i)
    if (std::abs(test.sines[i].frequency - 5) < 0.2 && seen.correlation[i])
      out.correlation = seen.correlation[i]->value;
  return out;
}
double fidelity_with(const rig::FaultSet& faults) { return shown_with(faults, 0.4).fidelity; }
double correlation_with(const rig::FaultSet& faults) { return shown_with(faults, 1.6).correlation; }  // [m2]

// |e| [m] of one flight, the same for all faults.
double mean_error_with(const rig::FaultSet& faults) {
  const LogData data = log_of({.excitation = "flight", .duration = 5, .faults = faults});
  const MonitorParameters monitor = monitor_of(data);
  const MonitorRun run = run_monitor(monitor, linear_pressure(monitor), data);
  return mean_error(data.scenario.time, channel_of(data, Signal::spool_position)->measured, run.spool).figure.value;
}

TEST(PrognosticPaperFigure8, FidelityRisesAsTheFilterClogs) {
  const double healthy = fidelity_with({}), half = fidelity_with({{"clogged_filter", {0.5}}}),
               end = fidelity_with({{"clogged_filter", {0.75}}});
  EXPECT_GT(half, healthy);
  EXPECT_GT(end, half);
  EXPECT_LT(end / healthy, 1.7) << "the paper's axis, which begins at 1";
}

TEST(PrognosticPaperFigure9, FidelityRisesAsTheInverseOfTheTorqueGain) {
  const double healthy = fidelity_with({});
  for (const double left : {0.6, 0.2})
    EXPECT_NEAR(fidelity_with({{"torque_motor_loss", {left}}}) * left / healthy, 1, 0.3) << left;
}

// At most by half of the play, by which the ball lags on either side.
TEST(PrognosticPaperFigure10, MeanErrorRisesWithTheBacklash) {
  constexpr double play = 20e-6;
  const double healthy = mean_error_with({}), end = mean_error_with({{"feedback_wire_backlash", {play}}});
  EXPECT_GT(end, healthy);
  EXPECT_LT(end, healthy + 0.5 * play);
}

// At most by what moves the flapper to the pilot pressure that the friction holds at rest.
TEST(PrognosticPaperFigure11, MeanErrorRisesWithTheFrictionOfTheSpool) {
  constexpr double times = 20, breakaway = 2.2;  // [N] params/rigs/borello2009.toml
  const MonitorParameters m = monitor_of(log_of({.excitation = "preflight", .duration = 0.4}));
  const double healthy = mean_error_with({}), end = mean_error_with({{"sticky_spool", {times}}});
  EXPECT_GT(end, 1.2 * healthy);
  EXPECT_LT(end, healthy + (times - 1) * breakaway * m.spool_force_gain / m.wire_stiffness);
}

// The paper's clearance wears with its corners, and then E rises; a clearance alone lets it fall. It ends where the
// whole sine opens the edges, x y / 2 with y = GQ x / (A w).
TEST(PrognosticPaperFigure12, CorrelationRisesWhereTheCornersWearWithTheClearance) {
  const MonitorParameters m = monitor_of(log_of({.excitation = "preflight", .duration = 0.4}));
  const double x = 0.025 * 0.5e-3, no_lap = 0.5 * x * x * m.flow_gain / (m.piston_area * 2 * std::numbers::pi * 5);
  double before = correlation_with({});
  const double healthy = before;
  for (const double times : {3.0, 6.0, 10.0}) {
    const double worn = correlation_with({{"edge_wear", {times}}});
    EXPECT_GT(worn, 1.1 * before) << times;
    EXPECT_GT(worn, 1.2 * correlation_with({{"radial_clearance_wear", {times}}})) << times;
    EXPECT_LT(worn, no_lap) << times;
    before = worn;
  }
  EXPECT_GT(before, 3 * healthy) << "several-fold, as the paper's";
}

}  // namespace
}  // namespace servodx
