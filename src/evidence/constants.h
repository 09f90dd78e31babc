// The numbers that decide what a log says of a hypothesis and what healthy logs say of that: value, unit and what each
// is for.
//
// Chosen by hand where no reason is given; not examined: no half and no double of any was run, unless said. What stands
// behind all of them together are the studies of the verdicts (docs/accuracy.md), made with these values.
#pragma once
#include <cstddef>

namespace servodx::evidence_constants {

// Tests that are alike (conditions.cpp, operating_point.cpp).
inline constexpr double like_span = 2.0, like_band = 4.0;  // ratios of the drive's span and of its frequency
inline constexpr double like_temperature = 15.0;           // [K]
// A loop that closes over sensor noise changes a drive's numbers by some per cent from run to run.
inline constexpr double same_size = 1.15, same_band = 1.3;  // ratios

// The frequency of a drive is that of the sine that decorrelates as fast: whose mean square change reaches this part of
// the variance, a tenth of its end value. A sine is there after 0.072 of its period. By hand.
inline constexpr double decorrelated = 0.2;
inline constexpr std::size_t fewest_of_drive = 8;  // samples
// Programmes from which on logs show how the model's error changes from test to test: fewer have no scatter. By
// definition; no other number was tried.
inline constexpr std::size_t programmes_that_scatter = 3;

// So far beyond what the fault-free logs show, or the sheet says, a test is another one. A pump's setting drifts by
// some per cent; a return line's pressure goes with the flow; a load or a drive that is larger by half reaches where no
// fault-free log was.
inline constexpr double like_supply = 0.05, like_return_part = 0.5, like_return = 3e5;  // of it; of it; [Pa]
inline constexpr double like_size = 0.5;                                                // of the largest

// Times as wrong as usual, beyond which the model does not follow a log: three quarters of the squared error is then
// nothing that tuning knew. Usual is the worst channel on the logs that tuned (diagnose/healthy_law.cpp), or all
// channels on the other healthy logs (explain/kin.cpp).
inline constexpr double followed_adequacy = 2.0;

// How healthy logs scatter (log_scatter.cpp).
inline constexpr std::size_t fewest_of_spread = 3;  // logs that tell a spread
inline constexpr double least_variance = 1e-6;      // of logarithms: figures that are equal to rounding

// How healthy excesses follow a condition (excess_trend.cpp).
inline constexpr std::size_t fewest_for_a_trend = 6;  // logs: shares and sizes alike
inline constexpr double little_excess = 0.01;         // a share of a hundredth and none are alike
inline constexpr double usual_trend = 1;     // of a slope, its prior's width: in oil twice as thick twice the excess
inline constexpr double steepest_trend = 3;  // twice the viscosity, eight times the excess: more is one log's
inline constexpr int trend_halvings = 40;    // to the last digits

// Promises and probabilities (heldout_gain.cpp, posterior.cpp, rank_promise.cpp, tail_law.cpp).
// Of its effect, that the model of a cause or of a fault errs: a textbook model's. Two that both explain a large effect
// to within that are not told apart by what is left. Halved, doubled: no verdict changes of the bench that
// diagnose/constants.h speaks of.
inline constexpr double effect_error = 0.1;
inline constexpr int tail = 20;                 // a draw in so many lies below the interval, and one above
inline constexpr double rate_rounding = 1e-12;  // of rates that are equal on paper
inline constexpr double count_rounding = 1e-9;  // of counts of logs that are whole on paper
inline constexpr int most_logs = 1000;          // asked for: beyond, the answer is that no number of logs does

}  // namespace servodx::evidence_constants
