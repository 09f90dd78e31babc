// Numbers that decide where a tune ends: what each is for. "Not examined": chosen by hand, no run has measured what
// another value does.
#pragma once
#include <cstddef>

namespace servodx {

// A share of the whole work, from `from` to `to`.
struct Share {
  double from = 0, to = 1;
  double at(double part) const { return from + (to - from) * part; }
};

namespace tune_constants {

// How a tune's time falls to its steps, for the progress that is told: the means of five tunes by the clock (the demo,
// rigs A and B, servodx_foreign seeds 82 and 92). Results do not depend on it.
struct WorkShares {
  Share screen = {0.0, 0.04};
  Share genetic = {0.04, 0.09};
  Share starts = {0.09, 0.29};   // the local searches together
  Share weights = {0.29, 0.45};  // the best of them, the end of each log still held out
  Share effects = {0.45, 0.54};  // which of them are earned
  Share whole = {0.54, 0.92};    // on whole logs; the rows' errors come after
};
inline constexpr WorkShares work;

// The logs (tune/scope.cpp). Not examined.
inline constexpr double tuning_null_limit = 0.1;  // [of rated] fault-free logs: a null may sit anywhere that
                                                  // calibration allows
// Of the ports' width, in its logarithm, where no log holds the spool: sheets state a flow to 10 % (ISO 10770-1), taken
// as three deviates.
inline constexpr double width_tolerance = 0.1 / 3;

// The effects that are freed unless told (tune/default_effects.cpp). Not examined.
//
// [m] The quarter wave of oil at 1200 m/s is then 500 Hz: shorter lines answer above the band of logs of 1 kHz, and a
// fit would give their numbers to what else rings there. Chosen with rigs of 0.45, 0.68 and 1.08 m in view.
inline constexpr double long_line = 0.6;
// [K] Over this much the flattest and the steepest law of the usual oils differ by a factor of 1.3 in viscosity.
inline constexpr double oils_apart = 20.0;

// The genetic search (tune/breadth.cpp). Not examined.
inline constexpr double excerpt = 1.5;            // [s] of each log: the search is for valleys, not for their floor
inline constexpr double compression_scale = 3.0;  // [sigma] beyond it a residual counts by its logarithm
inline constexpr int kept_points = 2;             // distinct ones that the local stage goes on from
inline constexpr int shown_every = 10;            // generations: what is shown is counted in full
// Where its islands of a healthy valve begin, times the table's values. By hand.
namespace island {
inline constexpr double driver_bandwidth = 0.4, torque_motor_frequency = 0.7, orifice_diameter = 0.8;  // slow pilot
inline constexpr double spool_friction = 5.0, piston_friction = 3.0;                                   // much friction
inline constexpr double clearance = 2.0, amplifier_gain = 1.3;                                         // wide edges
}  // namespace island

// The local stage (tune/search.cpp): iterations, a Jacobian each, which learns from up to three steps. Chosen with the
// logs of scripts/demo and the tutorial in view.
inline constexpr int iterations_a_start = 4;         // enough to tell valleys apart
inline constexpr int iterations_a_round = 6;         // then the weights are learnt anew
inline constexpr int iterations_of_last_round = 10;  // effects are judged where it ends, or it is what is kept
inline constexpr double tells_valleys = 1e-3;        // of the cost: less promised is no other valley
// Of a cost in units of likelihood: what chance lends each number that is free. A search that promises no more of all
// of them together is there.
inline constexpr double worth_a_step = 0.5;
// Of the cost, beside `worth_a_step`, which is more of a cost below 5e5. By hand; not examined.
inline constexpr double ended_tolerance = 1e-6;
inline constexpr double as_good = 1.05;  // of the best end's cost: another start that is there, or on its way
// Of the held-out error of another fit: nearer to that part, and not by chance. By hand, with seeds 133 and 135 in
// view; half and double not examined.
inline constexpr double nearer_by = 0.97;
// Of BOBYQA where derivatives prove false, for each free value. It lays out 2n + 1 points first; as many again let it
// move.
inline constexpr long rescue_points = 4;
// Points that a search spends on an iteration, beside one for each free value: a ladder of dampings. A search without
// derivatives gets as many. By definition (optimise/box_least_squares.h).
inline constexpr int points_beside_columns = 8;

// Weights before anything is known (tune/weights.cpp). Not examined.
//
// [1/s] Samples that count as independent before anything is known of their correlation; to the end of the fit a
// channel counts for at least as many. By hand.
inline constexpr double least_independent_rate = 40;
inline constexpr double least_over_noise = 2.0;  // times the sensor's noise: no model follows closer at its start
inline constexpr double part_of_residual = 0.7;  // of its rms: the fit is on its way to less
inline constexpr double failed_over_noise =
    100;  // times the noise, where the simulation fails and there is no residual

// Effects (tune/earned.cpp). Not examined.
//
// Fall of the held-out cost, half a sum of squares, that keeps an effect: by chance alone a number gains a half, and an
// effect has one to six.
inline constexpr double least_gain = 1.0;

// Rows (tune/screen.cpp, tune/sensitivity.cpp, tune/settle.cpp). Not examined.
inline constexpr double least_effect = 2.0;      // [sigma] at a bound: a row that moves nothing anywhere is flat
inline constexpr std::size_t most_at_once = 16;  // points of a batch: memory, not results
inline constexpr double flat_error = 0.25;       // of the row's range: a row known no better is not known
inline constexpr double one_sided_within = 2.0;  // standard errors: a row so near a bound is known on one side. By hand

// What a textbook model leaves of a rig that it can follow is 2 to 5 times the noise on two rigs; 11 times made a
// diagnosis blind on a third (docs/diagnosis.md). A sensor that is quiet beyond need is no reason for doubt: then the
// part counts.
inline constexpr double unfollowed_over_noise = 8.0;
inline constexpr double unfollowed_part = 0.005;  // of stop, stroke and supply

// Is the tune good enough (tune/trust.cpp).
//
// Held-out over fitted error of the median log: as a diagnosis lets a hypothesis leave twice the usual error, and no
// more. Not examined.
inline constexpr double predicts_worse = 2.0;
inline constexpr double seen = 3.0;  // [deviates] of a fault: less stays hidden. Not examined
// Fitted error over the sensor's noise from which the model follows another rig than this: with the data sheet of the
// rig pooled errors are 1 to 22 of it, with another valve's flow and cylinder 160 to 760 (piston, pressures).
inline constexpr double another_sheet_over_noise = 50.0;

// What a recorder does between samples (tune/usual_slope.cpp): logs that it takes, and the least that is left open of
// one more log, as no two runs start alike on the recorder's clock. Not examined.
inline constexpr std::size_t enough_slopes = 3;
inline constexpr double least_slope_spread = 0.02;  // of a sample

}  // namespace tune_constants
}  // namespace servodx
