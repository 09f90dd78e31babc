// What a preflight test can tell of wear: the errors that the fit of the parameters states, on logs of the model's own.
#include "prognose/track.h"

#include <gtest/gtest.h>

#include "base/random.h"
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

// Stated error of one wearing parameter after a test of the valve that wears so.
double stated_error(const std::string& test, double duration, const std::string& fault, double severity,
                    double celsius) {
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
  find_fault(fault)->apply(worn.data(), severity);
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
  const Track track = track_parameters(log, table, {.threads = 1, .last = {}});
  for (const TrackedParameter& p : track.parameters)
    if (p.fault->name == fault) return p.std_error;
  return std::nan("");
}

struct Wear {
  const char* fault;
  double severity, celsius;
};
class PreflightTest : public testing::TestWithParam<Wear> {};

// Reversals at full current tell the filter, the slow triangle the clearance.
TEST_P(PreflightTest, OfWearTellsItTwiceAsWellAsThePapersAndTheTriangleTheClearance) {
  const auto [fault, severity, celsius] = GetParam();
  const double paper = stated_error("preflight", 0.8, fault, severity, celsius),
               slew = stated_error("preflight_slew", 1.51, fault, severity, celsius),
               wear = stated_error("preflight_wear", 2.75, fault, severity, celsius);
  EXPECT_LT(wear, 0.5 * paper);
  if (std::string_view(fault) == "clogged_filter") {
    EXPECT_LT(slew, 0.5 * paper);
  } else {
    EXPECT_LT(wear, 0.7 * slew);
  }
}

INSTANTIATE_TEST_SUITE_P(, PreflightTest,
                         testing::Values(Wear{"clogged_filter", 0.375, 40}, Wear{"clogged_filter", 0.375, -15},
                                         Wear{"radial_clearance_wear", 2.5, 40},
                                         Wear{"radial_clearance_wear", 2.5, -15}));

}  // namespace
}  // namespace servodx
