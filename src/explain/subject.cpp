#include "explain/subject.h"

#include <algorithm>
#include <cmath>

namespace servodx {

double Number::to_unit(double value) const {
  const double v = std::clamp(value, lower, upper);
  return log_scale ? std::log(v / lower) / std::log(upper / lower) : (v - lower) / (upper - lower);
}
double Number::from_unit(double u) const {
  return log_scale ? lower * std::pow(upper / lower, u) : lower + u * (upper - lower);
}

}  // namespace servodx
