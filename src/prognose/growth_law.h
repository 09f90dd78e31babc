// How what wears grows: the laws that are tried, and a part that is lost beside the drop over it.
//
// g(s) of the part s of the time since the onset: power laws s^p (p = 1 is the linear one) and exponentials, g(1) = 1.
// Over what is left of a part (a filter's area) the drop at the same flow is 1 / (1 - lost)^2 of that over the whole
// one: turbulent, through holes of one kind. Leaves out laws that bend twice.
#pragma once
#include <array>
#include <cmath>

namespace servodx {

struct GrowthLaw {
  double power = 1;     // s^power
  double exponent = 0;  // else (exp(k s) - 1) / (exp(k) - 1)
  double weight = 1;    // before any data
  double at(double s) const {
    if (s <= 0) return 0;
    return exponent > 0 ? std::expm1(exponent * s) / std::expm1(exponent) : std::pow(s, power);
  }
  double inverse(double u) const {
    return exponent > 0 ? std::log1p(u * std::expm1(exponent)) / exponent : std::pow(u, 1 / power);
  }
  double slope_at_1() const { return exponent > 0 ? exponent * std::exp(exponent) / std::expm1(exponent) : power; }
};

// Wear at constant duty is linear; dirt and chemistry are not known to be. Linear has as much weight as the others.
inline constexpr std::array<GrowthLaw, 13> growth_laws = {{{0.5, 0, 1},
                                                           {0.6, 0, 1},
                                                           {0.72, 0, 1},
                                                           {0.85, 0, 1},
                                                           {1.0, 0, 12},
                                                           {1.2, 0, 1},
                                                           {1.4, 0, 1},
                                                           {1.7, 0, 1},
                                                           {2.0, 0, 1},
                                                           {2.5, 0, 1},
                                                           {3.0, 0, 1},
                                                           {1, 2.5, 1},
                                                           {1, 5.0, 1}}};

// The drop over what is open of a part over that of the whole one; and how much more than that.
inline double drop_beyond_whole(double lost) { return 1 / ((1 - lost) * (1 - lost)) - 1; }
inline double lost_at_drop(double drop) { return 1 - 1 / std::sqrt(drop); }
inline double drop_per_lost(double drop) { return 2 * drop * std::sqrt(drop); }

}  // namespace servodx
