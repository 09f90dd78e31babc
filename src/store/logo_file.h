// The picture that a rig file names for the head of its pages.
#pragma once
#include <string>

#include "servodx/rig.h"

namespace servodx::store {

// As a data URI; empty where none is named. Throws InputError where it is no picture.
std::string read_logo(const RigFile& rig);

}  // namespace servodx::store
