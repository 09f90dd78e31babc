// What text and page of a diagnosis say in the same words.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/judge.h"
#include "diagnose/moved.h"
#include "diagnose/naming.h"
#include "diagnose/record_law.h"
#include "evidence/conditions.h"
#include "faults/fault.h"
#include "fit/replay.h"

namespace servodx::report {

// What of rig file, channels and the log itself makes a verdict by this baseline doubtful.
std::vector<std::string> doubts_beside_baseline(const Diagnosis& d);
// Of a sensor that the rig file or the wiring turns about: "the columns 'pressure_a' and 'pressure_b' are exchanged";
// "" of any other verdict.
std::string mistake_in_words(const Diagnosis& d);

// Standard error of the log's null, of rated current; none where it is not known.
std::optional<double> error_of_null(const Diagnosis& d);
std::string null_in_words(const Diagnosis& d);  // "-0.72 +- 0.1 % of rated"

// Null where the assessment holds none.
const HypothesisResult* result_of(const Diagnosis& d, const Fault* hypothesis);
double probability_of(const Diagnosis& d, const Fault* hypothesis);
// By label; an unknown state is a label of its own.
std::map<std::string, double> labelled_probabilities(const Diagnosis& d);
std::vector<const Fault*> ambiguous_by_label(const Diagnosis& d);
std::vector<std::string> ambiguous_labels(const Diagnosis& d);

// What the hypotheses say the log should be, under their labels.
std::vector<Candidate> candidates_of(const std::vector<HypothesisPrediction>& explanations);

// The rate of false alarms that a baseline promises, and how many more logs the rate asked for takes.
std::string statement_of(const DetectionBaseline& baseline);

// "p = 0.03", or, where no log of the baseline is as far off, "p = 0.1, the least that 9 logs can show".
std::string chance_words(const Diagnosis& d);

// "18.6 times the tuned friction (10.3 to 33.4, 95 %)". At the mildest that is called the fault the fit has found none
// of it: as a hypothesis beside others "none of it seen"; named all the same, "at its least, 15 % ...".
std::string size_words(const HypothesisResult& hypothesis);
std::string size_words(const Diagnosis& d);  // of the fault named; "" without a size

// What a record tells: "the supply pressure is 0.75 of what healthy logs have", "pressure_a shows one value ...".
std::string record_in_words(const RecordFinding& finding);
// The sensor that is meant; "" where no one is.
std::string channel_of(const NamedFault& fault);
std::string of_channel(const Diagnosis& d);  // " of pressure_a", where the fault named is a sensor's
// "cylinder_leakage, 1.2e-12 m3/s/Pa (...), 98 %" of a second fault beside the first.
std::string second_in_words(const NamedFault& fault);

// What stands first in a log that cannot be distinguished from healthy ones.
std::string suspicion_in_words(const Suspicion& suspicion);
// What `explain` makes of a log that no fault explains.
std::string beyond_in_words(const BeyondFaults& beyond);
// Faults that this log would have shown, with the least of each, "clogged filter from 0.72"; and those it would not.
struct DetectableWords {
  std::vector<std::string> shown, hidden;
};
DetectableWords detectable_words(const Diagnosis& d);
// "drive spans 43.1 mA at about 5.6 Hz, oil 41 degC"
std::string test_words(const TestConditions& test);
// Empty where a log of the baseline is of such a test.
std::string unlike_words(const Diagnosis& d);
std::string compared_words(const Diagnosis& d);  // empty: it was compared with all of the baseline's own logs

// The rows that the fault moved; those of health's own, each farthest first.
struct MovedParts {
  std::vector<MovedRow> fault, health;
};
MovedParts moved_parts(const Diagnosis& d);

}  // namespace servodx::report
