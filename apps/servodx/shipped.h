// Files embedded at build, so that an installed program needs no folder beside it.
#pragma once
#include <string_view>

namespace servodx::shipped {

extern const std::string_view table;         // params/borello2009.csv
extern const std::string_view rig_comments;  // apps/servodx/rig_template.toml

}  // namespace servodx::shipped
