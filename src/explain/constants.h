// The numbers that decide what `explain` says: value, unit, why, and what half and twice of it do.
//
// "Bench" is the three explain cases of scripts/digest: a sticky spool without a baseline, a worn clearance and two
// healthy logs beside one. "Not examined": no half and no double was run.
#pragma once
#include <cstddef>

namespace servodx::explain_constants {

// Hold out.
inline constexpr int folds = 5;    // a fifth of the time is left out at once: one Gauss-Newton step still finds the
                                   // minimum of the rest. Not examined
inline constexpr int blocks = 15;  // of time, over all logs together: three a fold, longer than a residual remembers.
                                   // Not examined
inline constexpr int stand_blocks = 4 * blocks;  // a sweep says most in the few seconds near null. Not examined
inline constexpr int bootstrap_draws = 1000;     // the 5 % and 95 % quantiles then scatter by a seventh of a standard
                                                 // error. Not examined
inline constexpr double gauss_newton_damping = 1e-6;  // of the diagonal: a number that no row shows stays. Not examined
inline constexpr double gauss_newton_least = 1e-9;    // the same where the diagonal is zero. Not examined
inline constexpr int wall_rounds = 8;                 // walls met one after another. Not examined
inline constexpr double failed_square = 1e12;         // held-out square of a run that fails: never chosen. Not examined

// Score and fit.
inline constexpr double at_wall = 1e-6;          // [of the unit interval] so near a bound a number is held by it.
                                                 // Not examined
inline constexpr double least_square = 1e-12;    // a probe's answer below this is rounding. Not examined
inline constexpr int base_iterations = 12;       // of the fit without causes; chosen by hand. Not examined
inline constexpr int quick_iterations = 4;       // of a candidate, the base's derivatives kept. Not examined
inline constexpr int full_iterations = 4;        // after the quick ones, all derivatives anew. Not examined
inline constexpr double difference_step = 1e-3;  // [of the unit interval] through contacts and frictions, as in
                                                 // `diagnose`. Not examined
inline constexpr double cost_tolerance = 1e-4;   // of the cost: a candidate is compared, not published. Not examined
inline constexpr int curve_dampings = 3;         // tried at once: a curve's kernel runs no wide batch, so each costs a
                                                 // run. Moves time only. Not examined

// Forward.
inline constexpr int fitted = 8;               // causes with a name that are fitted, each round. Not examined
inline constexpr int judged = 4;               // of these, judged on held-out data. Not examined
inline constexpr int rare_share = 2;           // rarer causes get this part of either. Not examined
inline constexpr int standing_tried = 2;       // causes that are no news, fitted to be said to stand. Not examined
inline constexpr int most_causes = 3;          // a fourth name would rest on what three left. Not examined
inline constexpr int curves_fitted = 3;        // learnt curves, fitted and judged: each has seven knots. Not examined
inline constexpr double both_questions = 0.5;  // of the level, each: is a size news, and is the log. By definition
inline constexpr double odds = 5.99;       // 2 ln 20: at odds below twenty to one a cause does as well. Not examined
inline constexpr double most_of_it = 0.5;  // of the held-out misfit: a first name that removes less leaves most of
                                           // what is wrong without one. Not examined
inline constexpr double alarm_by_mark = 0.05;  // of nothing being wrong where no level is asked

}  // namespace servodx::explain_constants
