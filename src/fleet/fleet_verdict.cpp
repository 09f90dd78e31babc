#include "fleet/fleet_verdict.h"

namespace servodx {

const char* word_of(FleetVerdict verdict) {
  switch (verdict) {
    case FleetVerdict::none:
      return "";
    case FleetVerdict::healthy:
      return "healthy";
    case FleetVerdict::fault:
      return "fault";
    case FleetVerdict::unknown:
      return "unknown";
  }
  return "";
}

FleetVerdict verdict_named(const std::string& word) {
  for (const FleetVerdict verdict : {FleetVerdict::healthy, FleetVerdict::fault, FleetVerdict::unknown})
    if (word == word_of(verdict)) return verdict;
  return FleetVerdict::none;
}

}  // namespace servodx
