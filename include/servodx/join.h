// Two recorders of one test, each with its own clock: the second's put on the first's,
//     t1 = offset + (1 + skew) t2,
// by a signal that both recorded. Coarse: the liveliest piece of the second, correlated with all of the first (by
// increments, which have a sharp peak). Then piece by piece outwards, so that a skew does not smear long logs. Last:
// Gauss and Newton on all samples, with gain and bias of the shared signal free, as sensors or scalings may differ.
// The errors stated are those of the pieces' scatter about the straight line, residuals being far from white.
//
// Valid for clocks that run evenly (a constant skew up to 1000 ppm) and a shared signal that does not repeat itself.
// Leaves out: clocks that wander or step; recorders that share no signal.
#pragma once
#include <optional>

#include "servodx/log.h"

namespace servodx {

struct ClockFit {
  Signal by = Signal::command;
  double offset = 0, offset_error = 0;  // [s] and its standard error, at the middle of the overlap
  double skew = 0, skew_error = 0;      // [-]
  double correlation = 0;               // of the shared signal after alignment
  int pieces = 0;                       // that the errors stand on
};

struct JoinOptions {
  std::optional<Signal> by = {};    // empty: the shared signal that fixes the clock best
  std::optional<double> near = {};  // [s] where the offset is known roughly: for signals that repeat
  double near_within = 0.5;         // [s]

  // Throws InputError that names the option, as the program calls it.
  void validate() const;
};

// The first log with the second's further signals on its clock, cut to where both ran. Position, pressure and the like
// run in a line between the second's samples, demands are held; a sample that falls into a gap of the second is
// missing. Throws InputError where the two share no signal, or it does not settle the clock.
Log join_recorders(const Log& first, const Log& second, const JoinOptions& options, ClockFit& clock);

}  // namespace servodx
