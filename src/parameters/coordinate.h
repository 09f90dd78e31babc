// A number that a fit may move: its range, its scale and what is likely of it; and the way to the unit interval and
// back.
//
// Linear: value = lower + u (upper - lower). Logarithmic, for positive ranges: value = lower (upper / lower)^u.
#pragma once
#include <limits>
#include <string>

namespace servodx {

struct Row;

struct Coordinate {
  std::string name = {}, unit = {};
  double lower = 0, upper = 1;                                // [unit]
  bool log_scale = false;                                     // needs lower > 0
  double start = 0;                                           // [unit]
  double prior_sd = std::numeric_limits<double>::infinity();  // [of the unit interval] around `start`; infinite: none

  // A value beyond the range is put at its end. [-]
  double to_unit(double value) const;
  // Never beyond the range, however its ends round. [unit]
  double from_unit(double u) const;
  // How far the range reaches: in the unit, or in the logarithm of the value.
  double range() const;
  // d value / d u. [unit]
  double slope(double value) const;
};

// A row of a parameter table as the free number that starts at its nominal value.
Coordinate coordinate(const Row& row);

// Whether a fit left a number free: nearer than this to an end of its interval, the bound holds it, and curvature says
// nothing of how well it is known.
inline constexpr double wall_width = 1e-6;  // [of the unit interval] chosen by hand; not examined
constexpr bool off_walls(double u) { return u > wall_width && u < 1 - wall_width; }

}  // namespace servodx
