// The least that a log was said to show of a fault, beside what was found: `detectable` promises that 95 of 100 faults
// of that size are not called healthy.
//
// Sizes are counted from health on the fault's own scale: twice the bound is twice the way, of a logarithmic scale
// twice the logarithm. The promise is of a fault that is there from the first sample on; truths of others are better
// left without a severity.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "fleet/gather.h"
#include "servodx/fleet.h"

namespace servodx {

using DetectableFound = FleetCounts::DetectableFound;

// A log whose fault is known, with its size.
struct BoundCase {
  std::string label;
  enum class Bound { unstated, none, known } bound = Bound::unstated;  // none: the log would not show the worst of it
  double times = 0;                                                    // true size over a known bound
  bool is_found = false, is_named = false;
};

// None: the class is no fault of the list, or its scale does not hold the severity.
std::optional<BoundCase> bound_case_of(const FleetRow& row, const std::string& label, double severity);

DetectableFound detectable_found_of(const std::vector<BoundCase>& cases);

}  // namespace servodx
