// What a rig file says that a simulation or a fit may take up, as one text of bytes: for the hash of a stage's inputs.
// The mapping of columns is left out, as a log that was read has it in its samples; so are the limits of the acceptance
// sheet, the name and the serial number.
#pragma once
#include <map>
#include <string>

#include "servodx/rig.h"

namespace servodx {

std::string content_bytes(const RigFile& rig);

// The same as words, key by key as in the file: numbers in SI. What the file does not say is left out.
using RigStatements = std::map<std::string, std::string>;
RigStatements statements_of(const RigFile& rig);

}  // namespace servodx
