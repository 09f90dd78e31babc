#include "prognose/valve_history.h"

#include <cmath>

#include "faults/fault.h"
#include "faults/registry.h"
#include "prognose/check_name.h"
#include "prognose/track.h"

namespace servodx {

std::vector<double> tracked_in(const Recording& recording) {
  std::vector<double> values;
  for (const Progressive& p : progressive_faults()) {
    values.push_back(std::nan(""));
    for (const Check& c : recording.checks)
      if (c.cause == p.fault->name) values.back() = c.value;
  }
  return values;
}

bool resets(EventKind kind, const Check& check) {
  const Fault* fault = find_fault(check.cause);
  switch (kind) {
    case EventKind::filter_changed:
      return (fault && fault->renewed_by == kind) || check.name.kind() == CheckKind::fidelity;
    case EventKind::note:
      return false;
    default:
      return true;
  }
}

}  // namespace servodx
