// Verdicts of a fleet beside its truth: how many faults were found and named, how many healthy logs were accused.
//
// A truth file is a CSV with the header log,class or log,class,severity. `class` is `healthy`, a fault's label or any
// word of the file's own; `severity` is in the unit of the verdict's. A truth belongs to the log whose path ends in its
// `log`, whole parts of paths compared. Intervals are Wilson's, 95 %: logs count as independent.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "fleet/gather.h"
#include "servodx/fleet.h"

namespace servodx {

struct CountedRate {
  long counted = 0, of = 0;
};

struct Confusion {
  std::vector<std::string> classes;                           // of the truth: healthy first, then by name
  std::vector<std::string> names;                             // of the verdicts: the classes, other faults, unknown
  std::map<std::string, std::map<std::string, long>> counts;  // [class][name]
  struct OfClass {
    CountedRate detected;  // not found healthy; of the class healthy these are false alarms
    CountedRate named;     // by the class's own word
    CountedRate sized;     // of those named whose truth has a severity: it lies within the interval
  };
  std::map<std::string, OfClass> rates;  // by class
  long without_truth = 0;                // results that the truth file does not know
  long without_result = 0;               // rows of the truth file that no result is of
};

// Throws InputError where one row of the truth means several logs.
Confusion confusion_of(const FleetTable& table, const FleetTruth& truth);

}  // namespace servodx
