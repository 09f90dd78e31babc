// The usual time step of a log, and from what on samples are missing between two stamps.
#pragma once
#include <vector>

namespace servodx {

// Median of the steps between stamps, the upper one of two. [s] Needs two stamps.
double usual_step(const std::vector<double>& time);

inline constexpr double gap_over_step = 1.8;  // a step this much over the usual one lost a sample

}  // namespace servodx
