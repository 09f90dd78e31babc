#include "explain/kin.h"

#include <algorithm>

#include "evidence/constants.h"
#include "explain/constants.h"

namespace servodx {
namespace {

bool is_followed(const HealthyLog& log) {
  using evidence_constants::followed_adequacy;
  return log.adequacy <= followed_adequacy * followed_adequacy;  // its is of squares
}

}  // namespace

HealthyReference with_lost_marked(const HealthyReference& all, const std::vector<TestConditions>& suspects) {
  HealthyReference out = all;
  std::vector<TestConditions> others;
  for (HealthyLog& log : out.logs) {
    if (!log.test) return all;
    const bool alike = std::any_of(suspects.begin(), suspects.end(),
                                   [&](const TestConditions& test) { return distance(*log.test, test) <= 1; });
    log.lost = !alike && !is_followed(log);
    if (!log.lost) others.push_back(*log.test);
  }
  return show_scatter_of_tests(others) ? out : all;
}

SpeakingLogs logs_that_speak(const HealthyReference& all, const std::vector<TestConditions>& suspects) {
  SpeakingLogs kin, others;
  for (const HealthyLog& log : all.logs) {
    if (!log.test || !(log.test->drive_rms > 0)) return {all};
    const auto is_like = [&](const TestConditions& test) { return is_repeat(*log.test, test); };
    const bool seen = std::any_of(others.logs.logs.begin(), others.logs.logs.end(),
                                  [&](const HealthyLog& other) { return is_like(*other.test); });
    if (std::all_of(suspects.begin(), suspects.end(), is_like))
      kin.logs.logs.push_back(log);
    else if (!seen)
      others.logs.logs.push_back(log);
  }
  kin.alike = !kin.logs.empty();
  if (kin.logs.logs.size() < explain_constants::enough_kin)
    kin.logs.logs.insert(kin.logs.logs.end(), others.logs.logs.begin(), others.logs.logs.end());
  return kin;
}

}  // namespace servodx
