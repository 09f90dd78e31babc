// A command from a file as what drives the rig: `servodx plan` writes such files, and so does any log.
//
// Each value is held until the next. With a setpoint and a loop's gain, the control computer closes a proportional
// position loop, as `flight` does; the current that it asks for is what the log then holds.
#pragma once
#include <optional>
#include <string>

#include "rig/excitations.h"
#include "rig/rig_model.h"

namespace servodx::rig {

struct PlayedCommand {
  Stimulus stimulus;
  double duration = 0;  // [s]
  double rate = 0;      // [Hz]
  std::string sha256;
};

// `loop_gain` [A/m]; empty: the command is played as it is. Throws InputError for a file without even samples, and for
// a loop without a setpoint.
PlayedCommand played_command(const std::string& path, const RigModel& model, std::optional<double> loop_gain);

}  // namespace servodx::rig
