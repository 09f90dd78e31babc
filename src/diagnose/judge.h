// The verdict about one log: an assessment beside a baseline.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/decide.h"
#include "diagnose/lateral_force.h"
#include "diagnose/moved.h"
#include "diagnose/naming.h"
#include "diagnose/record_law.h"
#include "evidence/conditions.h"
#include "faults/fault.h"
#include "servodx/actions.h"
#include "servodx/diagnose.h"
#include "servodx/operating_point.h"

namespace servodx {

class HealthyLaw;

// What stands first in a log that cannot be told from healthy ones.
struct Suspicion {
  const Fault* fault = nullptr;
  double severity = 0, lower = 0, upper = 0;  // [the fault's unit] 95 %
  double rate = 1;                            // of false alarms at which it would be said, by the tail's law
  int logs = 0;                               // healthy ones that set the limit
  int logs_needed = 0;                        // until it would be said at the rate they can promise; 0: more do not
                                              // help by themselves, -1: no number does
};

// The least severity of a fault that would not have passed as healthy in 95 of 100 such logs.
struct Detectable {
  const Fault* fault = nullptr;
  std::optional<double> severity;  // [the fault's unit] none: this log would not have shown the worst of it
};

// What the search for missing physics makes of a log that no fault explains.
using BeyondFaults = Verdict::Beyond;

struct Diagnosis {
  std::string log;
  VerdictKind verdict = VerdictKind::healthy;
  Doubt doubt = Doubt::none;
  double error = 0, threshold = 0, p_value = 1;
  int baseline_logs = 0;
  // Set where no log of the baseline is of a test like this one: the nearest. The threshold was set by other tests.
  struct Unlike {
    std::string log;
    TestConditions test;
  };
  std::vector<ConditionRow> conditions;  // where it was recorded, beside sheet and baseline
  std::optional<Unlike> unlike;
  int others = 0;                  // healthy logs of other tests that it was compared with; 0: with the baseline's own
  int repeats = 0;                 // fault-free repeats of its own test, where it was compared with those alone
  const Fault* fault = nullptr;    // the one named, the first of `faults`
  std::vector<NamedFault> faults;  // none, one or two
  std::optional<Suspicion> suspicion;           // of a healthy verdict
  std::vector<Detectable> detectable;           // of each fault that was looked for by a fit
  std::vector<FaultProbability> probabilities;  // all 0 of an unknown state: that none of them holds is certain
  std::vector<const Fault*> ambiguous_with;     // null: healthy
  struct {
    double value = 0, lower = 0, upper = 0;  // [the fault's unit]
  } severity;
  std::optional<double> onset;     // [s]
  const Fault* nearest = nullptr;  // null and rows are of this hypothesis: the verdict's, of an unknown state the
                                   // most probable; null: healthy
  double null = 0;                 // [fraction of rated]
  std::vector<MovedRow> moved;
  Action action;                                // what the fault named, or the verdict, asks for
  std::optional<FrictionBesideForce> friction;  // of a named fault that moves the spool's
  std::optional<BeyondFaults> beyond;           // of an unknown verdict, where it was asked for
  std::vector<RecordFinding> records;           // all that are beyond what healthy logs show
  Assessment assessment;
};

// What the rules of the verdict look at.
Evidence evidence_of(const Assessment& assessment, const DetectionBaseline& baseline, const HealthyLaw& law,
                     const std::vector<RecordFinding>& records);

// What the records tell beyond what healthy logs show.
std::vector<RecordFinding> records_of(const Assessment& assessment, const DetectionBaseline& baseline);

Diagnosis judge(Assessment assessment, const DetectionBaseline& baseline);

}  // namespace servodx
