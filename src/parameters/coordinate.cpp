#include "parameters/coordinate.h"

#include <algorithm>
#include <cmath>

#include "servodx/table.h"

namespace servodx {

double Coordinate::to_unit(double value) const {
  const double v = std::clamp(value, lower, upper);
  return log_scale ? std::log(v / lower) / std::log(upper / lower) : (v - lower) / (upper - lower);
}

double Coordinate::from_unit(double u) const {
  // A power may round past the end, and a table that says so is refused.
  return std::clamp(log_scale ? lower * std::pow(upper / lower, u) : lower + u * (upper - lower), lower, upper);
}

double Coordinate::range() const { return log_scale ? std::log(upper / lower) : upper - lower; }

double Coordinate::slope(double value) const { return log_scale ? value * range() : range(); }

Coordinate coordinate(const Row& row) { return {row.name, row.unit, row.lower, row.upper, row.log_scale, row.nominal}; }

}  // namespace servodx
