// The numbers that decide what checks and trends say: value, unit and what each is for.
//
// Where a line names no source, the number was chosen by hand and not examined: no half and no double of it was run.
// What stands behind all of them together is the study of 200 lives (docs/accuracy.md), made with these values.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/normal.h"
#include "fit/problem.h"

namespace servodx::prognose_constants {

// The preflight test in the command.
inline constexpr double least_jump = 0.02;       // [of rated] that begins a step; tests of the paper have 0.1
inline constexpr double rest_band = 0.005;       // [of rated] within which a command is at rest
inline constexpr double least_swing = 0.005;     // [of rated] between turning points of a sine
inline constexpr double equal_periods = 0.15;    // half periods of one sine differ by less
inline constexpr double purity = 0.1;            // rms left of a sine over its own
inline constexpr double held_within = 0.2;       // of a step: so near its top the command is still held
inline constexpr double taken_back = 0.5;        // of a step: so much of it is left at most once it is taken back
inline constexpr std::size_t shortest_hold = 5;  // samples of a step
inline constexpr std::size_t edge_samples = 2;   // after a step's end: its edge may be caught on the way
// Of a guess from the turning points: between these a sine's frequency is sought, in so many golden sections.
inline constexpr double lowest_frequency = 0.9, highest_frequency = 1.1;
inline constexpr int golden_sections = 30;    // to 1e-7 of it
inline constexpr double period_grace = 0.05;  // of a period, that a cycle may begin early or end late: some samples
inline constexpr int least_cycles = 2;        // of a sine
inline constexpr long least_of_sine = 8;      // samples that tell one: four numbers are fitted

// The checks.
inline constexpr int error_batches = 10;       // of |e|, whose means scatter as its standard error says
inline constexpr double settled_band = 0.1;    // [of |e|] within which its running mean has settled
inline constexpr double settled_by = 0.5;      // [of the log] by when it must have
inline constexpr double step_reached = 0.95;   // of its end: r is taken up to there (Borello 2009, sec. 6)
inline constexpr double least_motion = 0.02;   // [of the monitor's] of a spool that responded
inline constexpr double noise_deviations = 3;  // of the sensor's noise, that such motion stands above
inline constexpr double frequency_steps = 20;  // [1/Hz] in which a sine's frequency is told: two tests, one name

// The oil's temperature, estimated.
inline constexpr double coldest_celsius = -40, hottest_celsius = 100;  // [degC] range of hydraulic oils in aircraft
inline constexpr double celsius_step = 10;                             // [K] a misfit's trough is wider
inline constexpr int oil_iterations = 6;                               // of a fit of nuisances alone
inline constexpr double oil_null_limit = 0.05;                         // [of rated] of its null

// Parameters, tracked.
inline constexpr double severity_prior_sd = 0.5;   // [of a severity's range] about health: weak, it only holds what
                                                   // a log cannot tell
inline constexpr double along_prior_sd = 0.25;     // [of its range] about what is likely: worn edges show it to 0.01,
                                                   // new ones not at all; no other width was run
inline constexpr double well_worn = 0.5;           // [of its range] where it is sought too, beside what is likely
inline constexpr std::size_t starts_followed = 3;  // those of least misfit
inline constexpr int first_iterations = 4;         // of each start
inline constexpr int last_iterations = 16;         // of the best end
inline constexpr double short_of_half_way = 0.2;   // [of the unit interval] a fault's start from half way, to health
inline constexpr double track_cost_tolerance = 1e-4;  // of the cost: a severity's error is far wider
inline constexpr double difference_step =
    step_through_contacts;              // [of the unit interval] through contacts and frictions
inline constexpr double healthier = 3;  // [spreads] by which a row may come out better than tuned
// What is lost of may be larger than the model has it, to half of the drop over a clean filter: sqrt(2) - 1.
inline constexpr double larger_clean = 0.41421356237309515;
inline constexpr double told_beyond = 2;  // [standard errors] from where the valve began: then a log tells a row's wear
inline constexpr int unit_halvings = 50;  // of a severity's unit interval: to rounding

// Seeded-fault tests.
inline constexpr double apart = 0.05;           // of their range: what lies closer was meant to be the same
inline constexpr std::size_t least_valves = 3;  // that a spread between valves takes
inline constexpr double least_scatter = 1e-6;   // of the range of sizes: readings may agree to rounding

// The scale of a filter's readings.
inline constexpr double at_end = 1.001;         // times the least drop: a reading nearer than this has no more to fall
inline constexpr double laminar_part = 0.5;     // of the drop over a fine screen, at 40 degC
inline constexpr double left_by_bores = 1.0;    // [clean drops] one deviation: what bores known to 2 % leave open
inline constexpr double left_by_screen = 0.25;  // the same of the screen's own size
inline constexpr double no_such_screen = 2;     // [deviations] from the table's clean drop

// Points as they are told.
inline constexpr std::size_t least_checks = 6;   // for a word on a trend: base, size, law and noise are four
inline constexpr std::size_t most_points = 100;  // longer histories are averaged in blocks
inline constexpr std::size_t neighbours = 3;     // to either side of a check
inline constexpr double outlying = 4;            // [spreads] from its neighbours at which a check is set aside
inline constexpr int newton_steps = 2;           // of the likelihood of readings at the end of their scale
inline constexpr double least_bend = 1e-3;       // of that likelihood: a reading far below its end says next to nothing

// What is supposed of a growth.
inline constexpr double matters_of_paper = 0.5;    // of a paper's check, in its logarithm: half as much again
inline constexpr double least_way = 0.5;           // of the way to the fault's own failure: a level near health keeps
                                                   // nothing from growing past it
inline constexpr double noise_of_stated = 0.3;     // of the stated errors, at least: they repeat in part
inline constexpr double noise_of_scale = 1e-4;     // of a growth that matters, at least: checks may agree to rounding
inline constexpr double temperature_swing = 0.3;   // of the figure, by a unit of log viscosity; by its square a third:
                                                   // over three decades of viscosity twice itself
inline constexpr double oil_in_growth = 0.15;      // over three e-folds of viscosity: half of itself
inline constexpr double oil_in_drop = 0.3;         // how much of a screen's drop is laminar is on no data sheet: twice
                                                   // itself over three e-folds
inline constexpr double expectation_spread = 0.5;  // the model's expectation is taken at its word within a half
inline constexpr double beside_spread = 0.5;       // [clean drops] bores known to 2 % leave open as much as a clean
                                                   // screen takes; in thick oil, where it takes most, half of that
inline constexpr double oil_scatter = 0.15;        // of what the oil does to a growth, from check to check

// Margins of the position loop (loop_margins.cpp).
namespace loop {
inline constexpr double interval = 1e-4;               // [s] of the linear model: its fastest poles are beyond interest
inline constexpr int samples = 20;                     // settled from the first on
inline constexpr int frequencies = 160;                // from the lowest to the highest: 3 % apart
inline constexpr double lowest = 0.1, highest = 1000;  // [Hz]
inline constexpr double no_friction = 1e-6;            // of the row's own: the asperities' spring goes with it
inline constexpr int harmonic_points = 32;             // of a half wave, for its first harmonic
inline constexpr int cycles_scanned = 24, cycle_halvings = 20;         // of a limit cycle's amplitude
inline constexpr int severities_scanned = 12, severity_halvings = 16;  // of the range: to 1.3e-6 of it
inline constexpr double judged_share = 0.04;  // [of rated current] amplitude that a margin is judged at
// [of the radial clearance] amplitude that the flow at null is taken at without laps: there it is in proportion still
inline constexpr double null_amplitude = 0.02;
inline constexpr double least_wire = 1e-6;  // of its stiffness: a wire that backlash has let go
// The least limit cycle is looked for just beyond the backlash, in which nothing moves; [m] where there is none.
inline constexpr double beyond_backlash = 1.001, least_cycle = 1e-9;
}  // namespace loop

// The grid of growths.
// Onsets as parts of the record, and their weights: wear usually begins with use. Between coarser ones a growth that
// began late looks like one that accelerates.
inline constexpr auto all_onsets = [] {
  std::array<std::pair<double, double>, 18> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = {0.05 * static_cast<double>(k), k ? 4.0 / 17.0 : 4.0};
  return all;
}();
// Times the noise that is expected: a decade to either side, four steps each.
inline constexpr std::array<double, 9> noise_levels = {0.1, 0.18, 0.32, 0.56, 1, 1.8, 3.2, 5.6, 10};
// Wander over the whole record, in parts of the growth that matters: no law is quite the wear's, and what lies between
// two of those tried is off them by a hundredth at most. A healthy figure may wander by the lesser two.
inline constexpr std::array<double, 3> wanders = {0.005, 0.03, 0.1};
inline constexpr std::size_t healthy_wanders = 2;
// Of the stated errors: most of one may be what the model's form gets wrong, which is the same from check to check.
inline constexpr std::array<double, 2> repeated_parts = {1.0, 0.3};
// A part lost so far, where it is one, by what the drop has grown: what is between two of them its size tells.
inline constexpr auto losses = [] {
  std::array<double, 13> drops{};
  for (std::size_t k = 0; k < drops.size(); ++k) drops[k] = k ? 1.5 * drops[k - 1] : 0.2;
  return drops;
}();
inline constexpr double least_tilted = 0.02;  // [scale] of a growth at which the oil's part in it is looked for
inline constexpr double hopeless = 14;        // [nats] below the best noise level at which no further one is looked at
inline constexpr double negligible = 1e-4;    // weight below which a component is left out

// Lives.
inline constexpr double all_draws = 4000;         // shared among the components by their weights
inline constexpr int least_draws = 16;            // of each component
inline constexpr int most_tries = 20;             // a draw: those to the wrong side of a one-sided prior are left out
inline constexpr std::uint32_t life_stream = 21;  // of random numbers, by definition
inline constexpr int life_hours = 200;            // that a life keeps: 90 % intervals rest on ten beyond either end

// Alerts and causes.
inline constexpr double latest_warning = 0.25;  // of the way to failure: three quarters are left to act in
inline constexpr double per_checks = 100;       // the false-alarm rate of a valve is stated over this many checks
inline constexpr double one_sided = normal_95_one_sided;  // [deviations] 95 % of a normal distribution
inline constexpr double as_far = 0.5;        // of the furthest on its way to failure: what may be the cause instead
inline constexpr double least_width = 1e-6;  // [h] an interval has one
inline constexpr double open_width = 1e6;    // times its lower end: of an interval that never ends
inline constexpr int least_for_tangent = 4;  // checks: a quadratic through three points is no fit

// What a user calls failed (performance_limits.cpp).
//
// Of E(tau) at a slower spool: over so many time constants, 95 % of a step by definition, in so many steps.
inline constexpr double fidelity_span = 3.0;
inline constexpr int fidelity_steps = 3000;
inline constexpr double most_gain_margin = 60;  // [dB] that may be asked for: beyond, a slip of the pen

}  // namespace servodx::prognose_constants
