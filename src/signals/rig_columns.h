// [columns] of a rig file: which signal a column of a log holds, in which unit, and by which gain and offset.
#pragma once
#include <toml++/toml.h>

#include "servodx/rig.h"

namespace servodx {

// Fills columns and lines of `rig`. Throws InputError with file, line and key.
void read_columns(const toml::table& table, RigFile& rig);

}  // namespace servodx
