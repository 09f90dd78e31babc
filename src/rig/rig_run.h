// One log from the virtual rig: settle, drive, measure. The log is what a user's rig would give; the truth beside it
// says what was wrong with the valve.
//
// The control computer runs at the log's rate: at each sample it reads the piston, sets the command and holds it until
// the next (zero-order hold), so the logged command is exactly what the driver received.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/celsius.h"
#include "rig/excitations.h"
#include "rig/fluid.h"
#include "rig/rig_faults.h"
#include "rig/rig_model.h"
#include "rig/virtual_rig.h"
#include "signals/log.h"

namespace servodx::rig {

struct RigRun {
  std::string excitation = "mixed";
  double duration = 5.0;                     // [s]
  double rate = 1000.0;                      // [Hz] of samples and of the control computer
  double temperature = 40.0 + zero_celsius;  // [K] of oil and valve
  double air = 0.005;                        // [1] free air in the oil, by volume at atmospheric pressure
  double viscosity = 1.0;                    // [1] of the oil, over what the model's law says of it
  double amplitude = 0.0;                    // [1] of rated current; 0: the excitation's own
  double frequency = 0.0;                    // [Hz] 0: the excitation's own
  std::uint64_t seed = 1;
  FaultSet faults = {};
  double onset = -1.0;                      // [s] start of faults that have none of their own; negative: from the start
  bool offset = false;                      // add the three-term null offset of Borello et al. 2009, sec. 7
  double jitter = 0.0;                      // [s] rms of the sampling instants
  bool noise = true;                        // false: perfect sensors (no lag, noise, quantum), for tests and pictures
  double step = 0.0;                        // [s] 0: the rig's own
  std::vector<std::string> channels = {};   // signals to log beside time and command; empty: the rig's usual ones
  const std::atomic<bool>* stop = nullptr;  // set: the log ends early, and its truth says so
  std::function<void(double fraction)> progress = {};
};

struct RigLog {
  std::vector<OutputColumn> columns;  // for write_log
  std::vector<std::string> comments;
  nlohmann::json truth;
};

// Sees the rig at every sample, before the log is rounded.
using Observer = std::function<void(double time, double command, const VirtualRig&)>;

// Throws InputError for an unknown excitation, fault or channel, or a number out of range.
RigLog run_rig(const RigModel& model, const RigRun& run, const Observer& observe = {});
// As above with a stimulus of the caller's own.
RigLog run_rig(const RigModel& model, const RigRun& run, const Stimulus& stimulus, const Observer& observe = {});

}  // namespace servodx::rig
