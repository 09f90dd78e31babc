// The front door of `simulate`: a log's inputs drive the model, the log's measured signals come back.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "base/require_setting.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/simulate.h"
#include "servodx/table.h"
#include "signals/file_column.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

constexpr double reference_step = 1e-5;  // [s] where the integrator's error is far below every sensor's

// The steps of a simulation that is looked at sample by sample.
SimulateOptions how_to(const SimulationOptions& options) {
  SimulateOptions to = fine_steps();
  to.threads = options.threads;
  if (options.reference) to.step = to.impact_step = to.creep_step = reference_step;
  if (options.step) {
    to.impact_step = std::min(to.impact_step, *options.step);
    to.step = to.creep_step = *options.step;
  }
  return to;
}

}  // namespace

void SimulationOptions::validate() const {
  require_setting(!step || (*step > 0 && *step <= 0.1), "--step", "must lie between 0 and 0.1 s",
                  "give it in seconds: 1e-4");
  require_setting(!step || !reference, "--reference", "sets the step, as --step does", "give one of them");
  require_threads(threads);
}

SimulationSteps steps_of(const SimulationOptions& options) {
  options.validate();
  const SimulateOptions how = how_to(options);
  return {how.step, how.impact_step};
}

void require_simulated_signal(const Log& log, const Rig& rig) { require_channels(prepare(log, rig)); }

const OutputColumn* Simulation::find(Signal signal) const {
  const auto at = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.signal == signal; });
  return at == columns.end() ? nullptr : &*at;
}

Simulation simulate(const Log& log, const Table& table, const Rig& rig, const SimulationOptions& options) {
  options.validate();
  const LogData data = prepare(log, rig);
  require_channels(data);
  SimulateOptions how = how_to(options);
  how.wanted.fill(false);
  for (const FitChannel& c : data.channels) how.wanted[static_cast<std::size_t>(c.simulated)] = true;
  Trajectory run = simulate(data.scenario, candidate_of(apply_rig_facts(table, rig)), how);
  if (!run.ok)
    throw std::runtime_error(
        fmt::format("the simulation left the finite numbers at {} s; check {} or give a smaller --step", run.failed_at,
                    table.path.empty() ? "the table" : table.path));
  Simulation out;
  out.time = log.time;
  for (const FitChannel& c : data.channels) {
    std::vector<double>& simulated = run.signals[static_cast<std::size_t>(c.simulated)];
    c.show(simulated);
    out.columns.push_back(output_column(log, c.signal, std::move(simulated)));
  }
  out.notes = data.notes;
  out.step = how.step, out.impact_step = how.impact_step;
  return out;
}

void write_simulation(const std::string& path, const Log& log, const Simulation& simulation, const Rig& rig) {
  std::vector<FileColumn> columns = {file_column(log, rig, output_column(log, Signal::time, simulation.time))};
  for (const OutputColumn& c : simulation.columns) columns.push_back(file_column(log, rig, c));
  write_columns(path, columns);
}

}  // namespace servodx
