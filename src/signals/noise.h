// Noise of a recorded series, from the series alone.
#pragma once
#include <vector>

namespace servodx {

// Noise rms of a series, robust against motion: median absolute fourth difference over that of white noise, at least
// the quantisation of `resolution` (0: none). In the series' unit. A second difference takes a valve that moves at 50
// Hz all the log, sampled at 1 kHz, for noise of a tenth of its amplitude.
double noise_of(const std::vector<double>& x, double resolution);

}  // namespace servodx
