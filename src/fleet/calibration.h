// Whether stated probabilities are what they say: of names stated with 80 %, 80 of 100 have to be right.
//
// The expected calibration error is the mean over all statements of |mean stated - part right| of their bin (C. Guo,
// G. Pleiss, Y. Sun, K. Q. Weinberger, "On calibration of modern neural networks", ICML 2017); bins are tenths, the
// last one in three. Chance alone makes it more than nothing: `by_chance` is how much, where every probability is the
// true one.
//
// Its interval is a bootstrap over the statements, which count as independent. An error that is redrawn is larger than
// the one drawn from by about as much as that one exceeds the true one. So the lower end is moved down by twice the
// difference, and is 0 where chance alone makes as much. The upper end is left as drawn, and takes in what Wilson's
// interval leaves open of all statements together: where all are right, no draw shows that one may be wrong. Tried on
// made-up statements with known errors it holds these in 92 to 99 of 100 sets of 150 and more, in 82 and more of 20.
#pragma once
#include <cstdint>
#include <vector>

#include "servodx/fleet.h"

namespace servodx {

using Calibration = FleetCounts::Calibration;

struct Statement {
  double probability = 0;
  bool is_right = false;
};

// What is no probability is left out. The same seed and order give the same bits.
Calibration calibration_of(std::vector<Statement> statements, std::uint64_t seed);

}  // namespace servodx
