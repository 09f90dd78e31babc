// Simulate: the model driven by a log's inputs.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {

struct SimulationOptions {
  // [s] largest step of the integrator, above 0 and up to 0.1; empty: what keeps every sample within 0.1 % of a
  // signal's range.
  std::optional<double> step = {};
  bool reference = false;  // steps of 1e-5 s: slow, to compare with
  int threads = 0;         // 0: all cores; the result does not depend on it

  // Throws InputError that names the option, as the program calls it.
  void validate() const;
};

// Largest steps of the integrator; impact: after a jump of the command, and while the rod comes upon its stop.
struct SimulationSteps {
  double step = 0, impact_step = 0;  // [s]
};
SimulationSteps steps_of(const SimulationOptions& options);

struct Simulation {
  std::vector<double> time;           // [s] the log's
  std::vector<OutputColumn> columns;  // of each signal that the log measures and the model reports: [SI], one a sample
  std::vector<Note> notes;
  double step = 0, impact_step = 0;  // [s] that were taken
  // Null where the log does not measure this signal.
  const OutputColumn* find(Signal signal) const;
};

// `table`: nominal or tuned; the rig's facts are applied to a nominal one. Throws InputError where the log lacks every
// signal that the model reports, std::runtime_error where the simulation leaves the finite numbers.
Simulation simulate(const Log& log, const Table& table, const Rig& rig, const SimulationOptions& options = {});

// Throws InputError where the log lacks every signal that the model reports: simulate() asks for it before any work.
void require_simulated_signal(const Log& log, const Rig& rig);

// As `servodx simulate -o` writes: names, units, gains and offsets are those of the log's file, as `rig` maps them.
void write_simulation(const std::string& path, const Log& log, const Simulation& simulation, const Rig& rig = {});

}  // namespace servodx
