// The numbers that decide what the engine of `explain` says: value, unit and what each is for.
//
// All were chosen by hand. No half and no double of any was run, so none has evidence but the studies of the whole
// (docs/explain.md), which were made with these values.
#pragma once
#include <cstddef>

#include "fit/problem.h"

namespace servodx::explain_constants {

// Hold out.
inline constexpr int folds = 5;                       // a fifth of the time is left out at once
inline constexpr int blocks = 15;                     // of time, over all logs together: three a fold
inline constexpr int blocks_of_sweep = 4;             // times as many on a test stand: null is passed in a moment
inline constexpr int bootstrap_draws = 1000;          // for the 5 % and 95 % quantiles of a held-out gain
inline constexpr double gauss_newton_damping = 1e-6;  // of the diagonal: a number that no row shows stays
inline constexpr double gauss_newton_least = 1e-9;    // the same where the diagonal is zero
inline constexpr int wall_rounds = 8;                 // walls met one after another
inline constexpr double failed_square = 1e12;         // held-out square of a run that fails: never chosen

// Score and fit.
inline constexpr double least_square = 1e-12;                     // a probe's answer below this is rounding
inline constexpr int base_iterations = 12;                        // of the fit without causes; chosen by hand
inline constexpr int quick_iterations = 4;                        // of a candidate, the base's derivatives kept
inline constexpr int full_iterations = 4;                         // after the quick ones, all derivatives anew
inline constexpr double difference_step = step_through_contacts;  // [of the unit interval] through contacts and
                                                                  // frictions, as in `diagnose`
inline constexpr double cost_tolerance = 1e-4;                    // of the cost: a candidate is compared, not published
inline constexpr int dampings = 4;        // tried at once, a decade apart: the least pack holds so many
inline constexpr int curve_dampings = 3;  // tried at once: a curve's kernel runs no wide batch, so each costs a
                                          // run

// Forward.
inline constexpr int fitted = 8;                // causes with a name that are fitted, each round
inline constexpr int judged = 4;                // of these, judged on held-out data
inline constexpr int leading = 2;               // of these, by what they gain alone: an answer and its twin
inline constexpr int rare_share = 2;            // rarer causes get this part of either
inline constexpr int standing_tried = 2;        // causes that are no news, where their shares are not asked
inline constexpr double least_worth = 0.05;     // of the held-out misfit: without healthy data to compare with, a name
                                                // that removes less answers nothing
inline constexpr double of_shares = 0.5;        // of the rate of false alarms; sizes and what is left have the rest
inline constexpr int most_causes = 3;           // a fourth name would rest on what three left
inline constexpr int curves_fitted = 3;         // learnt curves, fitted and judged: each has seven knots
inline constexpr double both_questions = 0.5;   // of the level, each: is a size news, and is the log. By definition
inline constexpr double odds = 5.99;            // 2 ln 20: at odds below twenty to one a cause does as well
inline constexpr double chance_at_odds = 0.05;  // the same as a chance
inline constexpr double alarm_by_mark = 0.05;   // of nothing being wrong where no level is asked

// The null of shares (explain/share_null.h): -ln(1 - share) of one cause of a healthy log, on the mean over all causes;
// the largest ratio of a healthy log to what is usual of its cause, on the mean; and the logs that either counts for.
// The means are those of 27 logs of the baselines of rigs A and B and of seeds 138 and 144, in view
// (bench/foreign/usual_excess, docs/lab/blind_rigs.md).
inline constexpr double usual_share = 0.017;
inline constexpr double usual_ratio = 11.0;
inline constexpr double usual_logs = 10;

// Verdict.
inline constexpr double worth_saying = 0.5;   // chance: what healthy logs show less often than not is said
inline constexpr double arrived = 3;          // times the noise: a tune that leaves more has not arrived
inline constexpr double much_of_block = 0.2;  // of what passes through a block, chosen by hand
inline constexpr double most_of_it = 0.5;     // of the held-out misfit: a name that removes less leaves most of it

inline constexpr double questions = 3;  // size, share, and what is left, by Bonferroni. By definition

// What healthy logs show of a cause's size (explain/beside_healthy.cpp).
inline constexpr double all_but = 1e-9;  // of a misfit: nothing removes all
inline constexpr double law_logs = 10;   // the normal law of sizes counts as much as so many logs

// The valve (explain/valve.cpp, explain/valve_causes.cpp, explain/valve_weights.cpp).
//
// The logs are of the rig that was tuned: its rows are known as well as the tuned table says, and not better than this
// part of their range. Freed further, they take up what a missing effect does, differently on every log.
inline constexpr double least_sd = 2e-3;
inline constexpr double wide_sd = 0.1;       // [of the range] re-tuning alone, to compare with
inline constexpr double row_prior = 0.1;     // a row that was held for a reason, beside an effect that has a name
inline constexpr double effect_growth = 10;  // an effect may grow beyond what this rig shows when healthy by this
inline constexpr double longest_memory = 1 - 1e-6;  // of a channel's residual, from sample to sample
// Laps, corners and hysteresis are about a per cent of rated current wide: so finely a sweep tells them apart.
inline constexpr double sweep_detail = 0.01;  // [of rated current]
inline constexpr double at_end = 1e-3;        // [of the range] a number that stands at its end. Not examined
// What healthy logs have had of a log's own numbers is where they go: beyond, by Student's law, at this chance; and at
// least over this part of their range, as a fit needs some.
inline constexpr double beyond_healthy = 0.01;
inline constexpr double least_own_range = 1e-3;
inline constexpr std::size_t enough_healthy = 3;  // healthy logs that say what is usual of a channel or a number

// Sizes at which a cause is scored (explain/sought_cause.cpp, explain/valve_causes.cpp, explain/sensor_causes.cpp): one
// where the response is nearly a line, and others, as it bends.
namespace tried {
inline constexpr double near_row = 0.05, far_row = 0.25;           // [of its range] of a row, to either side
inline constexpr double smaller = 0.25, larger = 4, largest = 16;  // of an effect's typical size, beside that itself
inline constexpr double along_a_little = 2, along_far = 5;         // of a row that grows with an effect
// Factor on a log's own air, and its ends: from what is usual, 0.5 %, beyond either end of a log's own (fit/own_air.h).
inline constexpr double air[] = {2.0, 0.5, 8.0};
inline constexpr double least_air = 0.02, most_air = 50.0;
inline constexpr double grids[] = {50.0, 60.0};  // [Hz] where the rig file states none
inline constexpr double grid_off = 0.15;         // [Hz] to either side: a grid strays by a tenth or two
}  // namespace tried

// The replay of the blocks (explain/blocks.cpp, explain/block_replay.cpp).
inline constexpr double window = 20e-3;            // [s] short against a stroke, long against the noise of a position
inline constexpr std::size_t fewest_windows = 10;  // of a series
inline constexpr double offset_range = 10;         // [sigma] that a series may be off on the mean
inline constexpr double knot_at_rest = 1e-6;       // of a curve's curvature: a knot that no log reaches stays at rest

// What is missing over time (explain/missing.cpp).
inline constexpr std::size_t most_samples = 20000;  // of all logs; of more, every second and so on
inline constexpr double odds_of_a_place = 20;       // at which a place is preferred to none, or to another
// How far a run's start may be off where no sensor says: the spool's, a chamber's pressure.
inline constexpr double start_of_spool = 0.05;    // [of the stop's travel]
inline constexpr double start_of_pressure = 0.2;  // [of the supply]
// [of a channel's noise] Behind a high-pass: where the signal stood before its first sample is not known at all.
inline constexpr double start_of_filter = 1e3;

// Healthy logs of the suspect's own test from which on they speak alone (explain/kin.cpp): fewer tell a scatter worse
// than other tests do. Not examined.
inline constexpr std::size_t enough_kin = 6;

// Healthy logs that say what a residual is like (explain/usual_error.h): fewer have no middle one. By definition.
inline constexpr std::size_t fewest_usual = 3;

// Between command and coil current (explain/drive.cpp). Not examined.
namespace drive {
inline constexpr double of_level = 0.1;      // of the level of sizes, beyond it: a driver is a question of its own
inline constexpr std::size_t fewest = 100;   // samples of a log that is looked at
inline constexpr double first_error = 1e-2;  // of the command's span, until the residual is seen
inline constexpr double least_error = 1e-6;  // of the same: a current that was computed has no noise
// Of the command. The gain is free and no cause: a driver may be set to a fifth of it as to five times.
inline constexpr double least_gain = 0.2, most_gain = 5.0;
inline constexpr double slowest = 2.0, at_once = 5000.0;  // [Hz] of the lag: beyond, no log tells it from none
// Sizes at which a score looks. Of the delay's typical size, 1 ms; and [Hz].
inline constexpr double tried_delays[] = {1.0, 0.25, 4.0};
inline constexpr double tried_bandwidths[] = {200.0, 1000.0, 40.0};  // and five times as fast, five times as slow
}  // namespace drive

// What is shown of a residual (explain/show.cpp).
namespace shown {
inline constexpr double near_event = 0.03;    // [s] a valve has answered a jump or a reversal by then
inline constexpr double jump = 0.03;          // [of rated current] of the command, from sample to sample
inline constexpr double white_band = 2.58;    // over sqrt(n): 99 % of white noise
inline constexpr int lags = 50;               // over which residuals are correlated
inline constexpr int spectrum_samples = 256;  // of a Hann window
inline constexpr std::size_t map_parts = 8;   // that a residual's map is cut into, of as many samples each
inline constexpr double least_told = 0.25;    // of the excess: a place that holds less says little
inline constexpr double least_lift = 0.2;  // share ln(share / part of the time): below it the excess is spread evenly
}  // namespace shown

// The walk of a missing input (explain/smoother.cpp, kalman_filter.h).
namespace smoother {
inline constexpr std::size_t blocks = 16;            // of time, of each run
inline constexpr std::size_t search_samples = 1500;  // of all runs: the intensity is searched for on so many
// Of the logarithm of the walk's variance: a factor of ten in intensity.
inline constexpr double step = 4.6, finest = 0.5;
inline constexpr int longest_path = 12;        // steps
inline constexpr std::size_t fewest_news = 8;  // samples: fewer tell no memory
inline constexpr double little = 0.01;         // of a channel's noise: so little from pass to pass, and it has settled
// The path begins where the walk gets so many times the typical over the run.
inline constexpr double most_typical = 1e3, most_by_slope = 1e5;
}  // namespace smoother

}  // namespace servodx::explain_constants
