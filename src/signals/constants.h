// The numbers that decide what is said of a log as it was read, and how two recorders' logs are joined: value, unit and
// what each is for.
//
// They change no verdict. Chosen by hand; not examined: no half and no double of any was run.
#pragma once
#include <cstddef>

namespace servodx::signals_constants {

// Values that can hardly be believed (plausible.cpp).
inline constexpr double spike_over_range = 0.5;   // a lone sample this far off both neighbours, per central range
inline constexpr double spike_over_noise = 30.0;  // and this many times the usual step
inline constexpr double frozen_part = 0.1;        // of the log without a change
inline constexpr std::size_t frozen_least = 50;   // samples
inline constexpr double frozen_drive = 0.05;      // of the drive's range is swept meanwhile
inline constexpr double frozen_usual_run = 3.0;   // a live channel repeats a value for fewer samples, on average
inline constexpr double no_excitation = 0.005;    // drive range per rated current
// A spool is through in 10 to 30 ms; a stand's slow sweeps are another matter.
inline constexpr double slowest = 50.0;              // [Hz]
inline constexpr double fastest = 200e3;             // [Hz] beyond what loggers of valves take
inline constexpr double longest_log = 1e5;           // [s] a day
inline constexpr double farthest_clock = 1e11;       // [s] beyond three thousand years no clock counts
inline constexpr double least_of_stroke = 5e-4;      // a piston that uses less has another unit, or another column
inline constexpr double no_supply = 5e5;             // [Pa] what a return line holds
inline constexpr std::size_t scale_samples = 10000;  // looked at, of a long log

// What only the user can say of a column (column_questions.cpp).
inline constexpr double unsigned_below = 0.02;  // of the highest value that a signed one may lack of zero
inline constexpr double aside = 0.5;            // of what the piston moves: it is this far from the middle
// [m] a piston that goes so far to one side of the middle alone may begin at its end
inline constexpr double long_way = 0.02;
inline constexpr double transmitter[] = {3.5e-3, 21e-3};  // [A] 4 to 20 mA and what they overshoot
inline constexpr double most_of_transmitter = 25e-3;      // [A] of one that has a sign; a motor takes more
inline constexpr double tick = 1e-7;                      // [s] what the clocks of Windows and .NET count
inline constexpr double flat_pressure = 0.4;              // of the highest value, that a pump's or a tank's varies by
inline constexpr double low_pressure = 0.25;              // of the highest value, that a tank's stays below
inline constexpr std::size_t steps_looked_at = 10000;
// [bar or degC] a return line holds less than that, oil in a tank is warmer; the column's lowest value tells
inline constexpr double tank_is_warm = 15;

// Logs of two recorders (recorders.cpp).
inline constexpr double piece_time = 8.0;         // [s] long enough to be unlike its neighbours, short against a skew
inline constexpr int most_pieces = 40;            // searched outwards from the liveliest
inline constexpr int fewest_pieces = 4;           // to state an error
inline constexpr double largest_skew = 1e-3;      // [-]
inline constexpr double least_correlation = 0.7;  // of increments in a piece
inline constexpr double rival = 0.9;              // another lag with this share of the best correlation: it repeats
inline constexpr double far_apart = 3.0;          // usual steps between two samples: nothing is said between them

}  // namespace servodx::signals_constants
