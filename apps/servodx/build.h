// What this program is: version, commit of its sources, instruction set that its simulations use on this machine.
#pragma once
#include <string>
#include <string_view>

namespace servodx {

extern const std::string_view build_commit;  // made at each build (cmake/commit.cmake); "unknown" without a repository

std::string version_line();  // "servodx 1.2.3 (commit 0123456789, avx2)"

}  // namespace servodx
