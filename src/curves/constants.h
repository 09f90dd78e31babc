// The numbers that decide whether a log shows a standard figure of a valve: value, unit and what each is for.
//
// Chosen by hand where no reason is given; not examined: no half and no double of any was run.
#pragma once
#include <cstddef>
#include <cstdint>

namespace servodx::curves_constants {

// Sweeps of the command (sweep.cpp).
inline constexpr double turn = 0.01;           // of rated: the command has turned when it came back by this
inline constexpr double least_range = 0.02;    // of rated
inline constexpr double curve_step = 0.0025;   // of rated
inline constexpr double fastest_sweep = 5.0;   // [1/s] rated current per time: beyond, the curve is the dynamics'
inline constexpr double covered = 0.6;         // of the steps of the range that the command must visit
inline constexpr double alike_branches = 1.5;  // longest over shortest, of a periodic sweep

// Figures of the curves (curves.cpp).
inline constexpr double slow = 0.2;           // [1/s] rated current per time: what is faster is noted
inline constexpr double fastest = 1.0;        // [1/s] 2.5 ms of a valve's lag make half a per cent of hysteresis
inline constexpr double inner_outputs = 0.9;  // of the outputs that both branches reach: hysteresis is looked for there
inline constexpr int hysteresis_levels = 60;  // of them
inline constexpr std::size_t resolution_reach = 2000;  // samples: meters are coarser where they read more
// Of rated: beyond, nothing is said of a figure of some tenths of a per cent.
inline constexpr double coarsest_threshold = 0.01;
// Of the sweep: at its ends the loop closes, and the mean of its branches bends.
inline constexpr double inner_sweep = 0.95;
inline constexpr double lively = 10.0;  // [Hz] a slow sweep has no response to speak of

// Frequency response (frequency_response.cpp).
inline constexpr double cycles = 10.0;  // a window
inline constexpr int per_decade = 24;   // frequencies
// Of the largest input: what leaks through the windows' skirts of a strong neighbour is no excitation.
inline constexpr double quiet_input = 1e-4;

// Uncertainty (sheet_uncertainty.cpp).
inline constexpr std::uint32_t draws = 40;         // the standard deviation is known to 11 %
inline constexpr std::uint32_t fewest_draws = 20;  // that show the figure
inline constexpr double coverage = 2.0;            // k of an expanded uncertainty (GUM)
inline constexpr std::uint64_t seed = 1;           // fixed: a figure's uncertainty is a property of the log

}  // namespace servodx::curves_constants
