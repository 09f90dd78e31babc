// One sample of a log that grows.
#pragma once
#include <array>
#include <limits>

#include "servodx/log.h"

namespace servodx {

struct Sample {
  double time = 0;                      // [s]
  std::array<double, n_signals> value;  // [SI] by index(Signal); NaN: not there
  Sample() { value.fill(std::numeric_limits<double>::quiet_NaN()); }

  double operator[](Signal s) const { return value[static_cast<std::size_t>(index(s))]; }
  double& operator[](Signal s) { return value[static_cast<std::size_t>(index(s))]; }
};

}  // namespace servodx
