// Where a log lacks samples: single ones that are missing from an input, and gaps in time.
//
// A simulation takes every step of a gap, and over a long one valve and oil go where no sample says: such a log is
// refused. A test stand may be read point by point. Left out: resampling; what is missing from a measured signal stays
// missing.
#pragma once
#include <vector>

#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {

// Missing samples of an input are bridged in a line; the ends hold.
std::vector<double> bridged(const std::vector<double>& time, std::vector<double> input);

inline constexpr double gap_memory = 10e-3;  // [s] several time constants of a first stage

// The command that passed in a gap is not known, and the valve remembers it for some milliseconds. As long as the gap
// was, at most `gap_memory`, what comes after is not compared: never more than half of a log is lost to it. Sample by
// sample, not 0 where it is so.
std::vector<char> after_gaps(const std::vector<double>& time);

// Throws InputError.
void refuse_long_gaps(const Log& log, Ports ports);

}  // namespace servodx
