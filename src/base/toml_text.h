// TOML from outside the program: rig files, virtual rigs, certificates, actions, what a tune left in a table.
//
// toml++ stops at 256 nested brackets, but follows a dotted name level by level, and frees what it made in the same
// way: [a.a.a] with 100,000 levels overflows the stack. So levels are counted before it reads: those of a section's
// header, of the keys below it, and of arrays and tables within values, together.
#pragma once
#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace servodx {

inline constexpr int deepest_toml = 100;  // levels, as of JSON; what servodx reads has fewer than five

// Throws InputError with file and line where the text nests deeper, holds a name or a text longer than longest_name
// (base/reading_limits.h), or is no TOML; `mend` says what to write.
toml::table parse_toml(std::string_view text, const std::string& path, const std::string& mend);

}  // namespace servodx
