#include "report/diagnose/next_calls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnose/assessment.h"
#include "diagnose/blame.h"
#include "diagnose/decide.h"
#include "diagnose/judgeable.h"
#include "faults/fault.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/diagnose/verdict_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"

namespace servodx::report {
namespace {

// The likeliest of what cannot be ruled out.
const Fault* rival_of(const Diagnosis& d) {
  return *std::max_element(d.ambiguous_with.begin(), d.ambiguous_with.end(),
                           [&](const Fault* a, const Fault* b) { return probability_of(d, a) < probability_of(d, b); });
}

// As `servodx plan` takes it: a fault that was fitted, at the size that was found.
std::string planned_fault(const Diagnosis& d, const Fault* fault) {
  const HypothesisResult* fitted = result_of(d, fault);
  if (!fitted || fitted->at_least || !std::isfinite(fitted->severity)) return label_of(fault);
  return fmt::format("{}={}", label_of(fault), digits(fitted->severity));
}

// Log, rig and table, as the calls that follow a verdict take them.
std::string given(const CallNames& names) {
  return "--params " + shell_word(names.table) + (names.rig.empty() ? "" : " --rig " + shell_word(names.rig));
}

std::string logs_of(const Diagnosis& d) {
  if (d.assessment.logs.empty()) return d.log.empty() ? "LOG" : shell_word(d.log);
  std::vector<std::string> words;
  for (const std::string& log : d.assessment.logs) words.push_back(shell_word(log));
  return join(words, " ");
}

}  // namespace

std::string separating_test_of(const Diagnosis& d, const CallNames& names) {
  if (!d.fault || d.ambiguous_with.empty()) return "";
  const Fault* rival = rival_of(d);
  // Only what a fit shows can be planned for. No test parts twins but a record that tells one of them.
  const bool twins = rival && (rival->twin == d.fault || d.fault->twin == rival);
  if (twins && rival->told_by) return std::string(rival->test);
  if (!result_of(d, d.fault) || (rival && !result_of(d, rival)) || twins) return std::string(d.fault->test);
  const std::string wish = rival ? "--between " + planned_fault(d, d.fault) + "," + planned_fault(d, rival)
                                 : "--faults " + planned_fault(d, d.fault);
  const std::string like = d.assessment.logs.empty() ? logs_of(d) : shell_word(d.assessment.logs.front());
  return "servodx plan " + wish + " " + given(names) + " --like " + like + " --seconds 2 -o command.csv";
}

std::vector<std::string> next_calls(const Diagnosis& d, const CallNames& names) {
  if (d.verdict != VerdictKind::unknown) return {};
  const std::string logs = logs_of(d) + " " + given(names);
  const std::string look = "servodx check-log " + logs;
  if (d.assessment.unjudgeable != Unjudgeable::no || blame_of(d) == Blame::log) return {look};
  return {look, "servodx explain " + logs + " --baseline " + shell_word(names.baseline) +
                    " -o extended.csv --report explain.html"};
}

}  // namespace servodx::report
