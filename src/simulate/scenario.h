// What a log gives a simulation: inputs at the sample times, where to start, and what to report. SI.
#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "model/shown.h"
#include "model/state.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/signal.h"
#include "simulate/fast_command.h"
#include "simulate/nuisance.h"

namespace servodx {

// A candidate: the 41 rows, the effects' parameters, then the nuisances of the log (nuisance.h). SI.
using ParameterVector = std::vector<double>;

struct Scenario {
  std::vector<double> time;       // [s] the points at which a run is reported: the samples, or some of a fast log
  std::vector<double> command;    // [A]
  FastCommand fast;               // of a log of many samples a step; `command` then holds the means between points
  bool current_measured = false;  // `command` is the coil current: it drives the model behind the amplifier
  std::vector<double> supply_pressure;  // [Pa] empty: the table's
  std::vector<double> return_pressure;  // [Pa] empty: the table's
  std::vector<double> load_force;       // [N] empty: none
  Oil oil;
  bool oil_known = true;  // its temperature was logged, or is known otherwise
  // What joins the control ports: the actuator, nothing, or a tube (a valve on a test stand).
  Ports ports = Ports::actuator;
  double rated_current = 0.02;          // [A]
  std::optional<double> command_slope;  // what the rig file says of the command between samples; empty: the candidate's
  // Measured at the first sample, where the log has it.
  std::optional<double> spool_start, pressure_a_start, pressure_b_start, piston_start;
  double piston_velocity_start = 0.0;  // [m/s]
};

// Signals that the model can report, in the order of the list of what it shows.
inline constexpr std::array simulated_signals = {
#define X(name) Signal::name,
    SERVODX_SHOWN(X)
#undef X
};
inline constexpr int n_simulated = static_cast<int>(simulated_signals.size());
// Position in simulated_signals, or -1.
constexpr int simulated_index(Signal s) {
  const auto it = std::find(simulated_signals.begin(), simulated_signals.end(), s);
  return it == simulated_signals.end() ? -1 : static_cast<int>(it - simulated_signals.begin());
}

struct Trajectory {
  bool ok = false;
  double failed_at = 0.0;                                // [s] where it left the finite numbers, if not ok
  std::array<std::vector<double>, n_simulated> signals;  // empty unless asked for
};

// What a run is computed in. Floats take half of the time, where the machine has packs of them, and round a run to some
// 1e-5 of a signal's range: good to rank candidates by, not for differences, and never for what is reported.
enum class Arithmetic { doubles, floats };

struct SimulateOptions {
  double step = 1.0e-3 / 3.0;        // [s] largest substep; substeps divide each sample interval evenly
  double impact_step = 1.0e-3 / 12;  // [s] after a jump of the command, and while the rod comes upon its stop
  double creep_step = 10e-3;         // [s] on a test stand while the command creeps: all that is fast is at rest
  std::array<bool, n_simulated> wanted = {true, true, true, true};  // spool, piston, both pressures
  int threads = 0;                                                  // 0: all
  Arithmetic arithmetic = Arithmetic::doubles;
};

// In floats and by longer substeps, for a third of the time: good to rank candidates, not for derivatives.
inline SimulateOptions ranking_steps(SimulateOptions o) {
  o.step = 0.5e-3;
  o.arithmetic = Arithmetic::floats;
  return o;
}

// Within 0.1 % of a signal's range of the reference (1e-5 s) at every sample of every shipped log: for what is looked
// at sample by sample. The steps above, for fits and searches, are within 1 %, 0.1 % rms (tests/laws/reference_test).
inline SimulateOptions fine_steps() {
  SimulateOptions o;
  o.step = 1e-4;
  o.impact_step = 1e-5;  // the spool rings between its two oil columns at some 13 kHz for a millisecond
  return o;
}

}  // namespace servodx
