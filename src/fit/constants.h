// Numbers that decide how a table meets its data sheet (fit/sheet.cpp) and how a Bode plot is read (fit/bode.cpp): what
// each is for.
//
// No half and no double of any was run.
#pragma once
#include <array>
#include <numbers>

namespace servodx::fit_constants {

// How well a sheet's dynamics hold, one standard deviation: valves of a type differ from the typical curve by about
// this much, and a printed curve is read no better.
inline constexpr double rise_time_tolerance = 0.1;                       // of the time
inline constexpr double gain_tolerance = 0.5;                            // [dB]
inline constexpr double lag_tolerance = 5.0 * std::numbers::pi / 180.0;  // [rad]

// The step: read where the spool has made this part of its way. So does the virtual rig, as sheets do.
inline constexpr double risen = 0.9;
inline constexpr double rest_before_step = 0.5;  // of the stated time: the pilot stage comes to rest
inline constexpr double seen_after_step = 10.0;  // of the stated time: a valve that is far slower still shows its way
inline constexpr int samples_a_rise = 100;       // 90 % is read between two of them, on a line

// The sine: after as many cycles as it is read over. 60 ms let a valve's slowest mode die out.
inline constexpr double settled_after = 0.06;  // [s]
inline constexpr int least_cycles = 2;
inline constexpr int samples_a_cycle = 50;  // a line between them is off by 0.1 % of the sine
// Low frequency, to which gains are relative: 5 Hz, or a tenth of the lowest stated. ISO 10770-1 takes 5 Hz or less.
inline constexpr double low_frequency = 5.0;  // [Hz]
inline constexpr double low_part = 0.1;

// The sensitivity of the figures to a row: this much more of it.
inline constexpr double nudge = 1.1;

// The search ends where it promises less than this part of a misfit that is a few tolerances: nothing that one reads.
inline constexpr double sheet_cost_tolerance = 1e-4;

// A Bode plot: from where every valve follows to where the spool of the fastest stands still, ten points a decade: a
// corner is read to a few per cent between two of them.
inline constexpr double bode_lowest = 2.0, bode_highest = 400.0;  // [Hz]
inline constexpr int bode_frequencies = 24;
// Backlash and friction of a few per cent of the stroke show at a tenth of rated current; a weak pilot stage shows
// where the spool is to slew, at the +-40 % of catalogues.
inline constexpr std::array bode_amplitudes = {0.1, 0.4};  // [fraction of rated current]

// A figure is met within so many standard deviations.
inline constexpr double met_within = 2.0;

}  // namespace servodx::fit_constants
