// The one list of a log's nuisances that are no row of the table and no effect: what differs from log to log and is no
// fault. Their places in a candidate and the free values of a fit (fit/free_values.h) are made of it; docs/model.md
// says of each where it is free and why its prior is as wide (a test holds the page to the list).
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include "effects/registry.h"

namespace servodx {

// clang-format off
// X(name, unit, lower, upper, prior mean, prior sd as a fraction of upper - lower, meaning). Both bounds 0: they follow
// from the noise of the log (start_values), and a prior of a quarter of them is 4 of its sigmas.
// Offsets: 1 % of a stroke bounds that of the spool sensor, its spread is a tenth of that; pressure sensors have a
// quarter per cent of a 400 bar range.
#define SERVODX_NUISANCES(X) \
  X(command_slope,           "-",   0.0,   1.0,  0.5, 1.0,  "command between samples: 0 holds the last, 1 runs in a line to the next") \
  X(spool_offset,            "m",   -5e-6, 5e-6, 0.0, 0.1,  "spool sensor, indicated less true: against the hydraulic null") \
  X(pressure_a_offset,       "Pa",  -3e5,  3e5,  0.0, 0.15, "sensor of pressure A, indicated less true") \
  X(pressure_b_offset,       "Pa",  -3e5,  3e5,  0.0, 0.15, "sensor of pressure B, indicated less true") \
  X(pilot_pressure_1_offset, "Pa",  -3e5,  3e5,  0.0, 0.15, "sensor of pilot pressure 1, indicated less true") \
  X(pilot_pressure_2_offset, "Pa",  -3e5,  3e5,  0.0, 0.15, "sensor of pilot pressure 2, indicated less true") \
  X(spool_start,             "m",   0.0,   0.0,  0.0, 0.25, "spool where the run starts, true less measured") \
  X(pressure_a_start,        "Pa",  0.0,   0.0,  0.0, 0.25, "pressure A where the run starts, true less measured") \
  X(pressure_b_start,        "Pa",  0.0,   0.0,  0.0, 0.25, "pressure B where the run starts, true less measured") \
  X(piston_velocity_start,   "m/s", 0.0,   0.0,  0.0, 0.25, "speed of the piston where the run starts, true less measured")
// clang-format on

struct NuisanceInfo {
  std::string_view name, unit;  // SI
  double lower, upper;          // [unit]
  double prior_mean;            // [unit]
  double prior_sd;              // fraction of upper - lower
  std::string_view meaning;
};
inline constexpr std::array nuisance_list = {
#define X(name, unit, lower, upper, mean, sd, meaning) NuisanceInfo{#name, unit, lower, upper, mean, sd, meaning},
    SERVODX_NUISANCES(X)
#undef X
};
inline constexpr int n_nuisances = static_cast<int>(nuisance_list.size());

// Position in a candidate, behind the rows and the parameters of the effects.
namespace nuisance {
enum class Place : int {
#define X(name, unit, lower, upper, mean, sd, meaning) name,
  SERVODX_NUISANCES(X)
#undef X
};
#define X(name, unit, lower, upper, mean, sd, meaning) \
  inline constexpr int name = n_values + static_cast<int>(Place::name);
SERVODX_NUISANCES(X)
#undef X
}  // namespace nuisance
inline constexpr int n_candidate = n_values + n_nuisances;

// `at`: position in a candidate.
constexpr const NuisanceInfo& nuisance_info(int at) { return nuisance_list[static_cast<std::size_t>(at - n_values)]; }

}  // namespace servodx
