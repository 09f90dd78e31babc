// The rules of the verdict: evidence in, decision out. No fit, no log, no registry.
//
//   nothing to judge                 unknown, with the reason
//   a mistake explains the log       unknown, with the mistake: as it was read no hypothesis leaves nearly as little
//   nothing moves as the log does    unknown
//   broken sensor                    that sensor, where the others move as the valve would
//   unusual supply or driver         that, and beside it the fault of the valve that the rules below name. Not where a
//                                    finding names that outright: such a valve draws what no healthy one draws. Nor
//                                    where it leaves the log unlike health and no fault explains that
//   unusually noisy sensor           that, unless the rules below name a fault of the valve
//   error at or below the threshold  healthy; a fault that is the most probable is suspected
//   a finding names a fault          that fault
//   a second fault gains enough      both, where together they explain enough
//   a fault gains enough             that fault, where it is the most probable and explains enough
//   else                             unknown
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/judgeable.h"
#include "faults/fault.h"
#include "faults/gross_finding.h"
#include "faults/record.h"

namespace servodx {

enum class VerdictKind { healthy, fault, unknown };

// Why a log is unknown.
enum class Doubt {
  none,         // it is not
  unjudgeable,  // there is nothing to judge
  misread,      // a healthy valve leaves less of it, read otherwise, than any hypothesis as it was read
  unrelated,    // no hypothesis moves as the log does
  no_fault,     // it is unlike health, and nothing in the list explains it well enough
};

struct HypothesisEvidence {
  const Fault* fault = nullptr;  // null: healthy
  double probability = 0;        // beside the other hypotheses
  double adequacy = 0;           // whitened rms of the worst channel; 1 as on the tuning logs
  bool at_worst = false;         // its size stands at the far end of the range, and that is no end of the fault
  double gain = 0;               // of likelihood over health
  double motion_left = 0;        // of what moves in the log (diagnose/motion.h)
};

// The best pair of faults.
struct PairEvidence {
  std::size_t first = 0, second = 0;  // of the hypotheses; the likelier alone first
  double gain = 0;                    // over the first alone [deviates]
  double adequacy = 0;
  bool at_least = false, at_worst = false;  // the size of one of them
};

// A fault that a record of the log tells without the model, beyond what healthy logs show.
struct RecordEvidence {
  Record of = Record::supply;
  bool broken = false;  // a sensor that does what no healthy one does: what the fits say of such a log is worth nothing
};

// The log, read as it would be were one mistake made about it.
struct ReadingEvidence {
  double motion_left = 1;
  bool of_a_sensor = false;  // the mistake is what a broken sensor shows as well: a sign, two columns
};

struct Evidence {
  double error = 0, threshold = 0;  // deviates from health
  double gain = 0;                  // of these, what the best fault explains: a name needs evidence of its own
  double usual_adequacy = 0;        // the largest of the baseline's logs
  bool known_test = true;           // the baseline holds such a test: how the model errs on it is known
  GrossFinding gross = GrossFinding::none;
  Unjudgeable unjudgeable = Unjudgeable::no;
  std::vector<HypothesisEvidence> hypotheses;  // healthy first; at least that one
  std::optional<PairEvidence> pair = {};
  std::vector<RecordEvidence> records = {};  // the surest first
  std::optional<ReadingEvidence> reading = {};
  double others_left = 0;  // of the motion of the sensors that are not broken, by the tuned valve
};

enum class SeveritySource { none, fit, seen_outright, record };

struct Decision {
  VerdictKind verdict = VerdictKind::healthy;
  Doubt doubt = Doubt::none;
  std::size_t hypothesis = 0;          // the one named; of an unknown state the most probable; else health
  std::vector<double> probabilities;   // of each hypothesis; all 0 of an unknown state
  std::vector<std::size_t> ambiguous;  // hypotheses that cannot be ruled out beside the fault named
  SeveritySource severity = SeveritySource::none;
  std::optional<std::size_t> beside;     // of a pair: the second fault
  std::optional<std::size_t> record;     // that names the fault
  bool valve_too = false;                // of a record's: the valve has the fault of `hypothesis` beside it
  std::optional<std::size_t> suspected;  // of a healthy log: the fault that stands first all the same
};

Decision decide(const Evidence& evidence);

// Whether a hypothesis leaves little enough: a fault is known less well than health, and the less the larger it is. Of
// a test that the baseline does not hold the model's own error may be all that is unlike health: there a fault also has
// to take more than it leaves. A size at the end of its range stands there because something else pulls: then only
// health's measure counts.
bool explains_enough(const HypothesisEvidence& fault, const Evidence& evidence);

}  // namespace servodx
