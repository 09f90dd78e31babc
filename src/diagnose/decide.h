// The rules of the verdict: evidence in, decision out. No fit, no log, no registry.
//
//   error at or below the threshold              healthy; a fault that is the most probable is suspected
//   a finding that names a fault outright        that fault
//   the gain is beyond the threshold, and the most probable is a fault that explains enough   that fault
//   else                                         unknown
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "faults/fault.h"
#include "faults/gross_finding.h"

namespace servodx {

enum class VerdictKind { healthy, fault, unknown };

struct HypothesisEvidence {
  const Fault* fault = nullptr;  // null: healthy
  double probability = 0;        // beside the other hypotheses
  double adequacy = 0;           // whitened rms of the worst channel; 1 as on the tuning logs
  bool at_worst = false;         // its size stands at the far end of the range
  double gain = 0;               // of likelihood over health
};

struct Evidence {
  double error = 0, threshold = 0;  // deviates from health
  double gain = 0;                  // of these, what the best fault explains: a name needs evidence of its own
  double usual_adequacy = 0;        // the largest of the baseline's logs
  GrossFinding gross = GrossFinding::none;
  std::vector<HypothesisEvidence> hypotheses;  // healthy first; at least that one
};

enum class SeveritySource { none, fit, seen_outright };

struct Decision {
  VerdictKind verdict = VerdictKind::healthy;
  std::size_t hypothesis = 0;          // the one named; of an unknown state the most probable; else health
  std::vector<double> probabilities;   // of each hypothesis; all 0 of an unknown state
  std::vector<std::size_t> ambiguous;  // hypotheses that cannot be ruled out beside the fault named
  SeveritySource severity = SeveritySource::none;
  std::optional<std::size_t> suspected;  // of a healthy log: the fault that stands first all the same
};

Decision decide(const Evidence& evidence);

// Whether a hypothesis leaves little enough: a fault is known less well than health, and the less the larger it is. A
// size at the end of its range stands there because something else pulls: then only health's measure counts.
bool explains_enough(const HypothesisEvidence& fault, double healthy_adequacy, double usual_adequacy);

}  // namespace servodx
