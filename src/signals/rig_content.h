// What a rig file says that a simulation or a fit may take up, as one text of bytes: for the hash of a stage's inputs.
// The mapping of columns is left out, as a log that was read has it in its samples; so are the limits of the acceptance
// sheet, the name and the serial number.
#pragma once
#include <string>

#include "servodx/rig.h"

namespace servodx {

std::string content_bytes(const RigFile& rig);

}  // namespace servodx
