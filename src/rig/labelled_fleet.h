// A labelled set of logs: several valves of one type, healthy and faulty, each log with its own excitation, oil
// temperature, air and null. Half of the logs are fault-free, four in ten have a fault from the start, one in ten a
// fault that steps in or grows within the log; sizes run from mild to severe. What log k is depends on the seed,
// k and the number of valves, not on how many logs there are or who makes them.
//
// Laid out as rigs under test are: DIR/valve_01/{healthy,fault,sudden}/*.csv, each with its truth beside it, and per
// valve rig.toml, the data sheet of the type, and truth.csv, one row a log.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rig/rig_model.h"
#include "rig/rig_run.h"

namespace servodx::rig {

struct FleetOptions {
  int logs = 0;
  int valves = 0;  // 0: one for every 30 logs
  std::uint64_t seed = 1;
  double duration = 4.0;                    // [s]
  double rate = 1000.0;                     // [Hz]
  std::optional<std::string> excitation{};  // empty: one after the other
  std::optional<double> temperature{};      // [K] empty: -20 to 65 degC
};

enum class FleetSet { healthy, fault, sudden };
enum class Grade { none, mild, medium, severe };
const char* name_of(FleetSet set);  // "healthy": of the folder too
const char* name_of(Grade grade);   // as a truth file has it

struct FleetLog {
  std::string folder;  // "valve_01"
  std::string path;    // within it: "fault/f004_mixed.csv"
  FleetSet set;
  std::string label;  // of the fault, or healthy
  Grade severity;
  double severity_value;  // 0 where healthy
  std::uint64_t valve;    // seed of another_valve()
  double null;            // [1] of rated current, beside the valve's own
  RigRun run;
};
// Throws InputError.
std::vector<FleetLog> plan_fleet(const FleetOptions& options);

// The rig's definition of one log.
RigModel model_of(const RigModel& type, const FleetLog& log);

// Runs the plan on `threads` (0: all); `write` is called from any of them, once a log. Returns which were written:
// all, unless `stop` is set.
std::vector<bool> run_fleet(const RigModel& type, const std::vector<FleetLog>& plan, int threads,
                            const std::atomic<bool>& stop,
                            const std::function<void(const FleetLog&, const RigModel&, RigLog&&)>& write,
                            const std::function<void(double fraction, long logs)>& progress);

// What a user would know of the type, as a rig file.
std::string data_sheet(const RigModel& type);
// truth.csv of the logs of one folder that were written.
std::string truth_table(const std::vector<FleetLog>& plan, const std::vector<bool>& written, const std::string& folder);

}  // namespace servodx::rig
