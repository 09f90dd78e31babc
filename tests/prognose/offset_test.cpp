// Prognostic paper, section 6: "spool position and current at rest give the offset, which is compensated". r of a valve
// whose null lies elsewhere is then the r of the same valve at its null.
#include <gtest/gtest.h>

#include <cmath>

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

// Parts that keep the spool where it came from: dry friction of the spool, hysteresis of the iron.
enum class Memory { none, of_the_rig };

double r_with(const rig::FaultSet& faults, Memory memory) {
  rig::RigModel model = rig::read_rig_model(SERVODX_SOURCE_DIR "/params/rigs/borello2009.toml");
  if (memory == Memory::none) {  // softer bristles with it, which the rig's steps still bear
    model.spool_coulomb = model.spool_breakaway = 5e-3;
    model.spool_bristle_stiffness = 1e4, model.spool_bristle_damping = 5;
    model.motor_coercive_mmf = 0;
  }
  rig::RigRun run;
  run.excitation = "preflight_slew";
  run.duration = 0.4;
  run.faults = faults;
  const TemporaryFolder folder;
  write_log(folder / "log.csv", run_rig(model, run).columns);
  const LogData data = prepare(read_log(folder / "log.csv"), {});
  const Preflight test = find_preflight(data);
  const MonitorParameters monitor = monitor_parameters(shipped_table(), supply_of(data, shipped_table()));
  const MonitorRun at_rest = run_monitor(monitor, linear_pressure(monitor), data, test.rest_current);
  const auto r = figures_of(data.scenario.time, test, measured_traces(data), at_rest.spool).fidelity;
  return r && !r->no_response ? r->figure.value : NAN;
}

TEST(PrognosticPaperSection6, FidelityAfterOffsetCompensationIsThatWithoutOffset) {
  const double without = r_with({}, Memory::none), weak = r_with({{"torque_motor_loss", {0.5}}}, Memory::none);
  EXPECT_GT(weak / without, 1.5);
  for (const double null : {-0.05, 0.02, 0.05}) {
    EXPECT_NEAR(r_with({{"null_shift", {null}}}, Memory::none) / without, 1, 0.01) << null;
    EXPECT_NEAR(r_with({{"null_shift", {null}}, {"torque_motor_loss", {0.5}}}, Memory::none) / weak, 1, 0.02) << null;
  }
}

// With friction and hysteresis the spool rests on the side that it came from, and the step begins there. The rig's
// whole hysteresis is 2.3 % of rated current: a quarter of the paper's step, an eighth on either side.
TEST(PrognosticPaperSection6, WithHysteresisItHoldsToHalfOfThatOverTheStep) {
  constexpr double hysteresis = 0.023, step = 0.10;  // of rated current
  const double without = r_with({}, Memory::of_the_rig);
  for (const double null : {-0.05, 0.02, 0.05})
    EXPECT_NEAR(r_with({{"null_shift", {null}}}, Memory::of_the_rig) / without, 1, 0.5 * hysteresis / step) << null;
}

}  // namespace
}  // namespace servodx
