// Levels that a figure may pass, on either side.
#pragma once
#include <optional>

namespace servodx {

struct Level {
  std::optional<double> lower, upper;  // [unit of the check]
  bool passed_by(double value) const { return (upper && value > *upper) || (lower && value < *lower); }
};

}  // namespace servodx
