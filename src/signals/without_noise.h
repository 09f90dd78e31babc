// Takes the white noise off a measured input before it drives a simulation. A lightly damped load answers the noise of
// a force or supply sensor as if it were real, and a fit then invents damping that the rig does not have.
//
// Whittaker's smoother: the series z with the least |x - z|^2 + lambda |second difference of z|^2; lambda by
// generalised cross-validation (Craven & Wahba, Numer. Math. 31, 1979), so the data say what is noise. Zero phase; a
// straight line passes unchanged; a series without noise passes nearly unchanged. Even spacing is assumed: jitter
// shifts the curvature, not the values. Limits: one lambda for the whole series, so one sharp corner keeps the noise
// elsewhere.
#pragma once
#include <span>
#include <vector>

namespace servodx {

// x: no missing values. Fewer than 8 samples come back as they are.
std::vector<double> without_noise(std::span<const double> x);

}  // namespace servodx
