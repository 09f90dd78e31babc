// Where the result of one log of a fleet lies, and whether what lies there still holds.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "fleet/fleet_verdict.h"

namespace servodx {

inline constexpr const char* result_ending = ".json";
inline constexpr const char* page_ending = ".html";
inline constexpr const char* refusal_ending = ".refused.json";

// "h12.3f0c...": the log's name and a hash of its path as written. Logs of one name in two folders stay apart, and the
// same list gives the same names on every machine. `use`: what sets several results of one log apart.
std::string result_name(const std::string& log, const std::string& use = "");

// What a result rests on; one that rests on the same needs not be made again.
struct ResultBasis {
  std::string version, commit = {};  // of the program
  std::uint64_t seed = 1;
  std::string settings = "{}";      // JSON: the options in effect
  std::vector<std::string> inputs;  // SHA-256 of all files read, in any order
};

// none: no such result, or not of this basis.
FleetVerdict standing_verdict(const std::string& result_path, const ResultBasis& basis);

}  // namespace servodx
