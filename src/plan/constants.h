// Numbers that decide a planned test. Chosen by hand unless said; what they do was looked at on the two virtual rigs
// of docs/plan.md, and halving or doubling one was not examined unless said.
#pragma once
#include <array>

#include "base/normal.h"

namespace servodx::plan_constants {

// The test's form (segments.cpp).
inline constexpr double lead = 0.06;  // [s] rest before the first piece: spool and pressures as they start
inline constexpr double unseen =
    0.04;  // [s] of it: a run begins with chambers alike and the rod at rest, whatever the null
inline constexpr double tail = 0.04;   // [s] rest behind the last: what it stirred dies away within the log
inline constexpr double piece = 0.24;  // [s] about: long enough for one cycle of the slowest shape worth playing
inline constexpr int fewest_pieces = 1, most_pieces = 16;
inline constexpr double samples_a_cycle = 8;  // a faster shape is no shape any more
inline constexpr double fastest = 30.0;       // [Hz] full steps at 70 Hz left twice the error that tuning logs leave
// [1 of the current limit] from within the clearance of a ball to the stop of the slew.
inline constexpr std::array<double, 6> amplitudes = {0.03, 0.08, 0.2, 0.4, 0.7, 1.0};
inline constexpr std::array<double, 4> rates = {4, 8, 15, 30};  // [Hz]
inline constexpr double least_amplitude = 0.01;                 // [1 of rated current]

// The figures (lanes.cpp, plan.cpp, goal.cpp).
inline constexpr int grid = 4;               // severities of a rival, on either side, in the search
inline constexpr int fine_grid = 12;         // the same where the least severity is looked for
inline constexpr double grid_end = 0.85;     // of the range: what is worse is seen without a test
inline constexpr double longest_step = 0.5;  // of the unit interval: a nuisance's secant
inline constexpr double deviates_of_95_one_sided = normal_95_one_sided;  // of a normal distribution

// What a distance is worth (goal.cpp): seven deviates are worth half of all, as a finding takes four and a name some
// more that the model's own error eats. A plain logarithm let a stuck spool of a hundred deviates outweigh a filter of
// three.
inline constexpr double half_worth = 50;      // [deviates^2]
inline constexpr double beyond_doubt = 0.02;  // of its logarithm: so that of two sure tests the surer is better

// The search (piece_search.cpp, test_bench.cpp).
inline constexpr double change = 1.5;              // factor of an amplitude or a rate
inline constexpr int draws = 2;                    // pieces drawn for each place in a round
inline constexpr double margin = 0.03;             // of a limit, kept free
inline constexpr double tolerance_deviates = 2.0;  // of a healthy valve's tolerances that the limits hold for
inline constexpr double worth_a_round = 1e-3;      // of information: less ends the search
inline constexpr int batch = 6;                    // tests simulated at once: memory, not the result

// Below it oil parts: gas comes out and columns collapse. [Pa] gauge, an atmosphere below ours
inline constexpr double no_tension = -1.0e5;

// Of the way to the stop: a stroke limit where none is given.
inline constexpr double usual_stroke = 0.75;

}  // namespace servodx::plan_constants
