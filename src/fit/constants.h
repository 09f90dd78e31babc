// Numbers that decide where a fit goes and what is told of it: what a table takes from its data sheet (fit/nominal.cpp)
// and how it meets the sheet (fit/sheet.cpp), what is free and how likely (fit/free_values.cpp), how a Bode plot is
// read (fit/bode.cpp), which numbers a log tells and how well, how wrong the model is. What each is for.
//
// Not examined: no half and no double of any was run, unless a line says so.
#pragma once
#include <array>
#include <cstddef>
#include <numbers>

namespace servodx::fit_constants {

// A table from a data sheet (fit/nominal.cpp; rows and formulas in docs/parameters.md). By hand where no reason is
// given.
namespace stated {
// Bounds about a fact, as factors of it: the spread of real parts about the sheet, and room for the faults.
//
// Measured sizes of the actuator; what moves has twice that factor.
inline constexpr double geometry = 1.1, moving = 2 * geometry;
inline constexpr double drawing = 1.6;  // bores and gaps of the pilot stage; they also absorb discharge coefficients
// 10 % tolerance of no-load flow, and of what the metering coefficient hides.
inline constexpr double catalogue_flow = 1.5;
inline constexpr double dynamics = 2.0;  // natural frequency: valves answer as with half to four fifths of the sheet's
inline constexpr double loop = 4.0;      // gain of the loop from a phase lag; loop_over_phase_lag says how it scatters
inline constexpr double volumes = 3.0;   // dead volumes
inline constexpr double supply_low = 0.25, supply_high = 1.5;  // pressure: low is room for a supply fault
// Times the stated return, and [Pa] at least: five times the most that bootstrap reservoirs have.
inline constexpr double return_high = 2.0, least_return_high = 5e6;
inline constexpr double stop_low = 0.8, stop_high = 1.4;     // of the spool
inline constexpr double motor_low = 0.05, motor_high = 2.0;  // low: the motor that lost 95 % of its gain (Borello 2009)
inline constexpr double limit_low = 0.5, limit_high = 3.0;   // current of the amplifier, of the rated
// Over and times the clearance. Wear studies reach 10 times; the fit needs room beyond.
inline constexpr double tightest = 3.0, most_worn = 12.0;
inline constexpr double mount_high = 10.0;  // compliance of the mount
inline constexpr double line_known = 4.0;   // inertance: geometry and fluid
inline constexpr double line_wide = 20.0;   // drop: what bends and a flow that is not developed add
inline constexpr double hose_high = 30.0;   // compliance of a steel line: up to a flexible hose
inline constexpr double most_glitch = 0.2;  // of the stroke: Borello 2009 studies up to 4 %
inline constexpr double most_lap = 0.06;    // of the stroke: twice the usual tolerance of a null cut
// Times the underlap that a sheet's null leakage allows, which is a guaranteed maximum.
inline constexpr double most_underlap = 2.0;

// In place of what the sheet does not give.
inline constexpr double stop_over_stroke = 1.16;  // overtravel is 10 to 20 %
inline constexpr double limit_over_rated = 1.5;   // amplifiers limit at 1.2 to 2 times rated current
inline constexpr double rated_drop = 7e6;         // [Pa] ISO 10770-1: 70 bar over both edges
inline constexpr double lapped_fit_min = 2e-6, lapped_fit_max = 5e-6;  // [m] radial, of new spools
inline constexpr double pilot_part = 0.5;                              // of the null leakage
// Of the supply, at the nozzles: above the first, nozzles that the sheet does not tell are too narrow for its leakage;
// above the second it is refused, as it leaves the orifices next to nothing.
inline constexpr double usual_pilot = 2.0 / 3, most_pilot = 0.9;
// Loop bandwidth over the frequency of 90 degrees lag. Of a small sine driver and motor have a part of the lag, and it
// is 0.27 to 0.59; of 40 % of the stroke the spool slews, and it is 0.7 to 1. Sheets rarely say which.
inline constexpr double loop_over_phase_lag = 2.0 / 3;
inline constexpr double short_tube_cd = 0.8;  // Merritt 1967 ch. 3: fixed orifices are short tubes
// Of stall force over no-load speed: a piston that loses half of its speed to viscous friction.
inline constexpr double most_viscous = 0.5;

// Lines (Merritt 1967 ch. 2 and 3).
inline constexpr double darcy_friction = 0.03;      // smooth line, Re 3e3 to 3e4
inline constexpr double fitting_losses = 2.0;       // entry, exit and bends, in velocity heads
inline constexpr double part_ahead_of_tap = 0.1;    // of a line's drop: the manifold's
inline constexpr double line_wall_over_bore = 0.1;  // of steel lines
inline constexpr double steel_modulus = 2.05e11;    // [Pa]

// A test stand: passages, hoses and gauges between the valve and its blind flanges, that no sheet tells.
inline constexpr double stand_volume = 1e-4;  // [m3] manifold and a metre of pipe at each port
inline constexpr double stand_volume_down = 100, stand_volume_up = 50;  // factors of its bounds
inline constexpr double stand_resistance = 1e14;   // [Pa s2/m6] 14 bar at 14 l/min in each line, times 4
inline constexpr double stand_compliance = 1e-11;  // [m3/Pa] a few metres of hose, at most
inline constexpr double stand_compliance_over_usual = 20;
}  // namespace stated

// The free numbers and their priors (fit/free_values.cpp; docs/model.md, "Nuisances").
namespace freed {
// One standard deviation of a row, of its range: a data sheet's bounds already say what is likely. No prior is wider.
inline constexpr double half_of_range = 0.5;

// How well a drawing holds, one standard deviation, relative.
//
// Bores below half a millimetre; the fixed orifices' with the discharge of short tubes (0.6 to 0.88).
inline constexpr double bores = 0.05;
inline constexpr double gap = 0.08;  // it is set in assembly, to 2 or 3 um
// Sheets give the clearance of a new spool as a range (2 to 5 um), and overlapped edges leak alike with less of it and
// blunter corners.
inline constexpr double clearance = 0.25;
// What no drawing states and a valve's kind says, one standard deviation of its logarithm.
inline constexpr double driver_bandwidth = 0.6;  // current amplifiers have 300 to 1000 Hz
inline constexpr double spool_friction = 0.9;    // a factor of 2.5: a threshold is stated as the most that is delivered
// The gain of the loop, alike: it follows from the valve's lag, of which driver and motor have a part, and slewing
// where the amplitude is large.
inline constexpr double loop_gain = 0.4;
// One standard deviation of what passes the piston at full supply, of the rated flow. Seals pass a few drops,
// hydrostatic bearings up to two per cent. Where the load is light, a leak and a slower valve move the piston alike,
// and the fit takes up a fifth of the flow.
inline constexpr double piston_leak = 0.01;

// A log's own.
inline constexpr double null_spread =
    0.02;                                   // [fraction of rated] nulled within it when delivered; temperature moves it
inline constexpr double usual_air = 0.005;  // [-] free, at atmospheric pressure
inline constexpr double air_spread = 0.2;   // of its range, a factor of 3.3: it differs from start to start
// Viscosity over that at 40 degC. Rigs run some 20 K about it, where a mineral oil is 2.2 times as thick, or as thin;
// -20 degC is 30 times.
inline constexpr double thinnest = 0.1, thickest = 50, usual_factor = 2.2;
inline constexpr double start_reach = 8.0;  // [sigmas] of its first sample, either way
}  // namespace freed

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
inline constexpr double bandwidth_fall = 3;                // [dB] by definition

// A figure is met within so many standard deviations.
inline constexpr double met_within = 2.0;

// Which numbers a log tells (fit/identifiability.cpp).
namespace told {
// A column's length over the part of it that the others do not span: above it they do together what this one does. By
// hand, near a rule of thumb of 20 (R package FME).
inline constexpr double collinearity_limit = 15.0;
inline constexpr double flat_limit = 1.0;         // [sigmas] over the whole interval: less moves no channel
inline constexpr double enough = 4.0;             // [sigmas] that determine a number to a quarter of its interval
inline constexpr double least_named = 0.2;        // of the column's length: what does less of it is not named. By hand
inline constexpr std::size_t most_named = 3;      // the strongest. By hand
inline constexpr double least_length = 1e-12;     // [sigmas] below, a column is none and would make the rest singular
inline constexpr double least_of_its_own = 1e-9;  // of the column's length: the same
}  // namespace told

// The profile likelihood (fit/profile.cpp).
namespace profiled {
// sqrt(3.84), as many standard deviations of a normal: 95 %. By definition.
inline constexpr double root_of_chi2 = 1.959964;
inline constexpr int refit_iterations = 6;       // the others begin where the curvature says that they go. By hand
inline constexpr double cost_tolerance = 1e-7;   // of the cost: far below the rise that is sought. By hand
inline constexpr int most_points = 6;            // a side. By hand: the root of the rise is nearly straight
inline constexpr double close = 0.03;            // of the root of the rise: the interval's end to a few per cent
inline constexpr double least_variance = 1e-12;  // of the unit interval: a number without any error has no way to go
inline constexpr double least_divisor = 1e-12;   // of distance and slope: two points that are one
inline constexpr double least_next = 0.2, most_next = 4;  // of the last distance: a line through two points may miss
                                                          // by much. By hand
}  // namespace profiled

// Errors of a fit by secants (fit/uncertainty.cpp).
namespace secant {
inline constexpr int passes = 2;                          // the second by the ways that the first has found
inline constexpr std::size_t in_a_batch = 16;             // ways: memory, not results
inline constexpr double reach = 0.3, least_reach = 1e-3;  // standard errors: beyond, a bent valley passes for its
                                                          // walls
inline constexpr double least_variance = 1e-16;           // of the unit interval: a way of no length has no
                                                          // derivative
inline constexpr double least_step = 0.1, shorter = 0.5;  // of the step to the minimum: halved, and given up below.
                                                          // By hand
}  // namespace secant

// How wrong the model is (fit/error_model.cpp).
namespace learnt {
inline constexpr double unlearnt_independent = 50;  // [1/s] samples of a channel that no log has told of. By hand
inline constexpr std::size_t fewest = 8;            // samples: fewer tell no memory. By hand
// Logs differ in how well the model fits them. A log's own variance about the pooled one is worth so many samples. By
// hand.
inline constexpr double prior_worth = 4;
// Floor and slope are thought alike in size to within a factor e before the residuals speak: logs that always move say
// nothing of the floor, and the next log may rest. A log speaks with so many independent samples. By hand.
inline constexpr double prior_spread = 1;
inline constexpr double log_worth = 20;
// The descent to floor and slope, in their logs: steps from a factor of five to one of 10 %, the last above last_step.
inline constexpr double first_step = 1.6, last_step = 0.05;
inline constexpr double least_fall = 1e-9;  // of the cost: less is rounding
inline constexpr double lowest = 12;        // below the residual's own size: e^-12 of it is nothing
}  // namespace learnt

// Twin experiments (fit/selftest.cpp).
namespace twin {
inline constexpr double null_limit = 0.1;       // [fraction of rated] as in a tune
inline constexpr double nuisance_share = 0.5;   // of the prior's width: true nuisances stay likely under it
inline constexpr double inside = 0.02;          // truths keep this far from the ends of their interval. By hand
inline constexpr int iterations = 60;           // far beyond what a fit takes: it ends by `settled`. By hand
inline constexpr int usual_iterations = 15;     // of a fit, for the progress that is told: decides nothing
inline constexpr double cost_tolerance = 1e-6;  // of the cost. By hand
// Two steps in a row that gain less end a fit: no parameter is a third of a sigma from the minimum then. What the model
// still promises is no measure here: kinks (friction, stops, laps) keep it above zero for ever.
inline constexpr double settled = 0.05;
inline constexpr int idle_steps = 2;
}  // namespace twin

// Fast logs (fit/fast_log.cpp).
namespace fast {
inline constexpr int steps_a_point = 3;      // as between the samples of 1 kHz, at which the error of the step is known
inline constexpr double samples_a_step = 2;  // from so many on steps save half; a sample of 5 kHz is a step of 0.2 ms
inline constexpr double slack = 1e-6;        // of a time: stamps are rounded
inline constexpr std::size_t fewest = 4;     // samples that a parabola is drawn through
}  // namespace fast

// Gaps in time (fit/log_gaps.cpp).
// [s] With an actuator, on a test stand: a simulation takes every step of a gap, and what the command did in it is a
// guess. By hand.
inline constexpr double longest_gap = 10.0, longest_wait = 600.0;

// The start of a log (fit/log_start.cpp). [s] Over which the piston's speed there is measured: ten steps of 1 kHz and
// a little more, as stamps are rounded. By hand.
inline constexpr double start_span = 0.0101;

}  // namespace servodx::fit_constants
