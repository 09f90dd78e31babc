// Limits of what is read, far beyond what any bench writes; docs/logs.md states them.
#pragma once
#include <cstddef>
#include <string>

namespace servodx {

inline constexpr std::size_t longest_name = 4096;                     // [byte] as of a path
inline constexpr std::size_t largest_toml = std::size_t{16} << 20;    // [byte] a rig file has some thousand
inline constexpr std::size_t largest_table = std::size_t{16} << 20;   // [byte] 41 rows and what tuned them have 20 kB
inline constexpr std::size_t largest_history = std::size_t{1} << 30;  // [byte] as CSV: some five million figures
// A baseline has 90 kB and 3000 values a log, results less: some 700 logs, and 300.
inline constexpr std::size_t largest_json = std::size_t{64} << 20;  // [byte]
inline constexpr long most_json_values = 1'000'000;                 // each costs some 200 bytes once read

// As read_file (base/csv.h). A file of more than `most` bytes is refused, and no more of it is read.
std::string read_file_within(const std::string& path, std::size_t most);

}  // namespace servodx
