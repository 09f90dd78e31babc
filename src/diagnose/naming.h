// What a decision names: the faults with their sizes and probabilities.
#pragma once
#include <optional>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/decide.h"
#include "diagnose/healthy_law.h"
#include "diagnose/record_law.h"
#include "faults/fault.h"

namespace servodx {

struct NamedFault {
  const Fault* fault = nullptr;
  double probability = 0;
  double severity = 0, lower = 0, upper = 0;  // [the fault's unit] 95 %; NaN: it has no size
  std::optional<RecordFinding> record = {};   // that told it, and of which signal
};

struct FaultProbability {
  const Fault* of = nullptr;  // null: healthy
  double value = 0;
};

// What there is to name from.
struct Named {
  const Assessment& assessment;
  const Decision& decision;
  const std::vector<RecordFinding>& records;
  const HealthyLaw& law;
  double gain = 0, gain_of_second = 0;  // [deviates], of the evidence
  double rate_of_records = 0;
};

// None, one, or two; the first is the verdict's.
std::vector<NamedFault> name_faults(const Named& of);

// Of every hypothesis and of what a record names. They add up to one but where two faults are named: each then has the
// chance that it is there. All 0 of an unknown state.
std::vector<FaultProbability> probabilities_of(const Named& of, const std::vector<NamedFault>& faults);

}  // namespace servodx
