// What a log gives a simulation: inputs at the sample times, where to start, and what to report. SI.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "effects/registry.h"
#include "model/state.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/rig_file.h"
#include "signals/signal.h"
#include "simulate/fast_command.h"

namespace servodx {

// A candidate: the 41 rows, the effects' parameters, then the nuisances of the log. SI.
using ParameterVector = std::vector<double>;
namespace nuisance {
// Command between samples: 0 holds the last sample, 1 runs in a line to the next.
inline constexpr int command_slope = n_values;
// Offsets of the sensors, indicated less true. [m], [Pa]
inline constexpr int spool_offset = n_values + 1;
inline constexpr int pressure_a_offset = n_values + 2;
inline constexpr int pressure_b_offset = n_values + 3;
inline constexpr int pilot_pressure_1_offset = n_values + 4;
inline constexpr int pilot_pressure_2_offset = n_values + 5;
// Where the run starts, true less measured: the first sample has the sensor's noise. [m], [Pa], [m/s]
inline constexpr int spool_start = n_values + 6;
inline constexpr int pressure_a_start = n_values + 7;
inline constexpr int pressure_b_start = n_values + 8;
inline constexpr int piston_velocity_start = n_values + 9;
}  // namespace nuisance
inline constexpr int n_candidate = n_values + 10;

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

// Signals that the model can report.
inline constexpr std::array<Signal, 12> simulated_signals = {
    Signal::spool_position,   Signal::piston_position,     Signal::pressure_a,   Signal::pressure_b,
    Signal::pilot_pressure_1, Signal::pilot_pressure_2,    Signal::flow_a,       Signal::flow_b,
    Signal::load_pressure,    Signal::valve_pressure_drop, Signal::control_flow, Signal::leakage_flow};
inline constexpr int n_simulated = static_cast<int>(simulated_signals.size());
// Position in simulated_signals, or -1.
int simulated_index(Signal s);

struct Trajectory {
  bool ok = false;
  double failed_at = 0.0;                                // [s] where it left the finite numbers, if not ok
  std::array<std::vector<double>, n_simulated> signals;  // empty unless asked for
};

// What a run is computed in. Floats take half of the time, where the machine has packs of them, and round a run to some
// 1e-5 of a signal's range: for the way of a search and for differences by wide steps, never for what is reported.
enum class Arithmetic { doubles, floats };

struct SimulateOptions {
  double step = 1.0e-3 / 3.0;        // [s] largest substep; substeps divide each sample interval evenly
  double impact_step = 1.0e-3 / 12;  // [s] after a jump of the command, and while the rod comes upon its stop
  double creep_step = 10e-3;         // [s] on a test stand while the command creeps: all that is fast is at rest
  std::array<bool, n_simulated> wanted = {true, true, true, true};
  int threads = 0;  // 0: all
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
