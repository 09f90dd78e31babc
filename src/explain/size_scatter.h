// How a cause's sizes scatter over healthy logs, as random effects.
//
// How far they scatter beyond their standard errors has two faces: alike on all logs (tau: DerSimonian & Laird 1986),
// or in proportion to the standard error, where a test that hardly shows a cause lends it whatever else is wrong (Birge
// 1932). The likelier of the two is taken. Where the model's answer to the oil's temperature is off, sizes follow the
// oil: a line in the logarithm of its viscosity is taken where it is worth its number (Schwarz 1978), and the sizes
// scatter about that.
#pragma once
#include <cmath>
#include <vector>

#include "base/tiny.h"

namespace servodx {

struct SizeOnLog {
  double size = 0, square = 0, thickness = 0;  // [of the probe], its standard error squared, ln of the viscosity
};

struct SizeScatter {
  double tau2 = 0, phi2 = 1;
  double mean = 0, mean_variance = 0, slope = 0, slope_variance = 0, middle = 0, degrees = 1;
  double log_likelihood = -1e300;  // twice
  double variance(double square) const { return tau2 + phi2 * square + tiny; }
  double at(double thickness) const { return mean + (std::isfinite(thickness) ? slope * (thickness - middle) : 0.0); }
  double variance_at(double thickness) const {
    const double off = std::isfinite(thickness) ? thickness - middle : 0.0;
    return mean_variance + off * off * slope_variance;
  }
};

// At least three sizes, all of them finite; a thickness that is not known is no number.
SizeScatter scatter_of(const std::vector<SizeOnLog>& sizes);

}  // namespace servodx
