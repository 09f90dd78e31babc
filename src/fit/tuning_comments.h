// What a tune of earlier versions wrote among a table's comments: "moving average: ...", "model error ...", "tuned by ...", in this order.
// A table that was tuned several times by a version that appended holds several such sets: the last is the newest, and
// belongs to the rows. Comments of people are none of these lines.
#pragma once
#include <string>
#include <vector>

namespace servodx {

inline constexpr const char* average_key = "moving average";
inline constexpr const char* error_key = "model error";
inline constexpr const char* tuned_by_key = "tuned by";

// The lines of the newest set; empty for a table that no tune made.
std::vector<std::string> newest_tuning(const std::vector<std::string>& comments);

// The comments that no tune wrote.
std::vector<std::string> without_tunings(const std::vector<std::string>& comments);

}  // namespace servodx
