// A log made ready to be fitted: its inputs as a scenario, its measured channels with noise and weight.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "fit/recorder.h"
#include "parameters/table.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/filters.h"
#include "signals/log.h"
#include "signals/low_pass.h"
#include "simulate/scenario.h"

namespace servodx {

struct FitChannel {
  Signal signal;
  int simulated = -1;            // position in simulated_signals
  std::vector<double> measured;  // [SI] NaN where missing
  double noise = 0;              // [SI] rms of the sensor noise, from fourth differences, at least the quantisation's
  Filter filter;                 // applied to measurement and simulation alike, that is, to their difference
  std::optional<LowPass> low_pass = {};  // of the rig, ahead of its recorder: the simulation has to pass it too

  // What the recorder would have seen of a simulated signal: in place, and as a copy.
  void show(std::vector<double>& run) const {
    if (low_pass && run.size() == measured.size()) (*low_pass)(run);
  }
  std::vector<double> shown(std::vector<double> run) const {
    show(run);
    return run;
  }
};

long present_samples(const FitChannel& channel);

struct LogData {
  std::string path, sha256;
  Scenario scenario;
  std::vector<FitChannel> channels;
  std::vector<Note> notes;
  Fluid fluid = {};  // of the rig: how its oil follows a temperature that the log does not hold
  int alike = 1;     // logs of a fit, itself among them, that run one programme: there the model errs alike
  std::optional<CommandSlope> command_slope = {};  // what is likely of it, where the scenario does not state it
};

// The piston integrates every error of flow: below the corner its slow drift tells little and would hide what the rest
// tells. A velocity error of 0.1 mm/s is as large at 1 Hz as the sensor noise of known rigs, 13 um.
inline constexpr double piston_high_pass = 1.0;  // [Hz]

// [K] mean of what the log measured of its oil; none where it did not.
std::optional<double> measured_oil_temperature(const Log& log);

// The rig file's mains frequency is notched out, and its low-pass is put on what is simulated. What follows a gap in
// time is not compared until the valve has forgotten what passed in it.
LogData prepare(const Log& log, const RigFile& rig, const Recorder& recorder = {});

// Refuses a log without any signal that the model reports.
void require_channels(const LogData& log);

// Samples [from, to) as a log of their own, started from what is measured at `from`.
LogData slice(const LogData& log, std::size_t from, std::size_t to);

}  // namespace servodx
