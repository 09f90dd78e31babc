// A baseline that a command judges by, and what is to be said of it.
#pragma once
#include <string>

#include "invocation.h"
#include "servodx/baseline.h"
#include "servodx/rig.h"

namespace servodx {

// Notes where the file is of an earlier version, and where it was made with a rig file and the call names none.
Baseline baseline_beside(Invocation& invocation, const std::string& path, const RigFile& rig);

}  // namespace servodx
