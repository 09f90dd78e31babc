// Verdicts of a fleet beside its truth: how many faults were found and named, how many healthy logs were accused.
//
// A truth file is a CSV with the header log,class or log,class,severity. `class` is `healthy`, a fault's label or any
// word of the file's own; `severity` is in the unit of the verdict's. A truth belongs to the log whose path ends in its
// `log`, whole parts of paths compared. Intervals are Wilson's, 95 %: logs count as independent.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "fleet/calibration.h"
#include "fleet/detectable_found.h"
#include "fleet/gather.h"
#include "servodx/fleet.h"

namespace servodx {

using CountedRate = FleetCounts::Rate;

struct Confusion {
  std::vector<std::string> classes;                           // of the truth: healthy first, then by name
  std::vector<std::string> names;                             // of the verdicts: the classes, other faults, unknown
  std::map<std::string, std::map<std::string, long>> counts;  // [class][name]
  using OfClass = FleetCounts::OfClass;
  std::map<std::string, OfClass> rates;  // by class
  Calibration calibration;
  DetectableFound detectable;
  long without_truth = 0;   // results that the truth file does not know
  long without_result = 0;  // rows of the truth file that no result is of
};

// Throws InputError where one row of the truth means several logs. `seed`: of calibration_of().
Confusion confusion_of(const FleetTable& table, const FleetTruth& truth, std::uint64_t seed = 1);

}  // namespace servodx
