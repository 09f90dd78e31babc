// The verdict about one log: an assessment beside a baseline.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/decide.h"

namespace servodx {

struct Diagnosis {
  std::string log;
  VerdictKind verdict = VerdictKind::healthy;
  double error = 0, threshold = 0, p_value = 1;
  int baseline_logs = 0;
  // Set where no log of the baseline is of a test like this one: the nearest. The threshold was set by other tests.
  struct Unlike {
    std::string log;
    TestConditions test;
  };
  std::optional<Unlike> unlike;
  const Fault* fault = nullptr;  // the one named
  struct Probability {
    const Fault* of = nullptr;  // null: healthy
    double value = 0;
  };
  std::vector<Probability> probabilities;    // all 0 of an unknown state: that none of them holds is certain
  std::vector<const Fault*> ambiguous_with;  // null: healthy
  struct {
    double value = 0, lower = 0, upper = 0;  // [the fault's unit]
  } severity;
  std::optional<double> onset;     // [s]
  const Fault* nearest = nullptr;  // null and rows are of this hypothesis: the verdict's, of an unknown state the
                                   // most probable; null: healthy
  double null = 0;                 // [fraction of rated]
  std::vector<MovedRow> moved;
  Assessment assessment;
};

// What the rules of the verdict look at.
Evidence evidence_of(const Assessment& assessment, const Baseline& baseline);

Diagnosis judge(Assessment assessment, const Baseline& baseline);

}  // namespace servodx
