#include "build.h"

#include <fmt/format.h>

#include "servodx/instruction_set.h"

namespace servodx {

std::string version_line() {
  return fmt::format("servodx {} (commit {}, {})", SERVODX_VERSION, build_commit, instruction_set());
}

}  // namespace servodx
