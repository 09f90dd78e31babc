// A rig file.
#include "harness.h"
#include "servodx/rig.h"

namespace servodx::fuzz {

void read(std::string_view input) { make_rig("rig.toml", std::string(input)); }

}  // namespace servodx::fuzz
