// What fault-free logs score, and the threshold that promises a false-alarm rate.
//
// The score of a log is the largest gain of any fault over health, in deviates; what no fault explains is its adequacy.
// healthy_law.h makes limits of them.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/record_figures.h"
#include "evidence/conditions.h"
#include "faults/fault.h"
#include "servodx/operating_point.h"

namespace servodx {

struct ByName {
  bool operator()(const Fault* a, const Fault* b) const { return a->name < b->name; }
};
using FaultGains = std::map<const Fault*, double, ByName>;  // of each fault over health

struct DetectionBaseline {
  double threshold =
      0;  // of the score [deviates], for a suspect whose test is like none that the model does not follow
  double asked = 0.01, promised = 0, promised_95 = 0;  // false-alarm rates
  int logs = 0;                                        // that the model follows: these set the threshold
  int logs_needed = 0;
  struct Score {
    std::string log, sha256;
    double score = 0, adequacy = 0;
    FaultGains gains = {};
    std::optional<TestConditions> test = {};           // files of earlier versions have none
    std::vector<RecordFigure> figures = {};            // the same
    OperatingPoint point = {};                         // the same
    std::string content = {};                          // content_hash of the log; the same
    std::optional<HypothesisPrediction> healthy = {};  // not in the file: for the report
  };
  std::vector<Score> scores;
  // Healthy logs of other tests, those that tuned the table among them: how the model errs where no log above is of the
  // suspect's test. They promise nothing.
  std::vector<Score> others;
  bool of_other_tests = false;  // the scores stand in for logs of a test that the baseline does not hold
  bool of_repeats = false;      // the scores are those of the logs that repeat the suspect's test
  double adequacy_limit = 0;    // largest adequacy of a healthy log
  double null_limit = 0.05;
  std::string tuned_sha256;  // content_hash of the table it was made with; earlier versions wrote that of its file
};

// `usual`: what each fault gains on fault-free logs, on average; a fault that health shows too must gain the more.
double score_of(const Assessment& assessment, const FaultGains& usual);

// Mean gain of each fault over the baseline's logs, but for log `left_out` (-1: none).
FaultGains usual_gains(const DetectionBaseline& baseline, int left_out = -1);

// Scores every log by the others, and sets threshold and promise for the rate asked. Empty without assessments.
DetectionBaseline baseline_of(const std::vector<Assessment>& healthy, double false_alarm,
                              const std::vector<Assessment>& others = {});

// Whether the rate promised is the rate asked for.
bool keeps_rate(const DetectionBaseline& baseline);

// Whether the baseline's own logs know how the model errs on such a test: they hold it, or tests like it among several.
bool knows_test(const DetectionBaseline& baseline, const TestConditions& test);

// What speaks of a suspect of this test: its repeats, where the baseline holds a few, as there the model errs as it
// errs there. Other tests would set a limit that no repeat comes near. Else the baseline, where its logs know such a
// test or there are no others. Repeats of one programme know that programme alone; several know tests like theirs. Else
// the scores are the others', of a test like this where some are; where none is, all of them, and one for each
// programme of the baseline's own. `left_out`: of the others, -1: none.
DetectionBaseline baseline_for(const TestConditions& test, const DetectionBaseline& baseline, int left_out = -1);

// The log of the baseline whose test is nearest, where none is of a test like this one. Empty also where the baseline
// does not say what tests it holds.
const DetectionBaseline::Score* nearest_of_unlike(const TestConditions& test, const DetectionBaseline& baseline);

}  // namespace servodx
