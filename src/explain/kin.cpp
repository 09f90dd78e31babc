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

bool is_alike(const HealthyLog& log, const TestConditions& test) { return log.test && distance(*log.test, test) <= 1; }

}  // namespace

HealthyReference shares_marked(const HealthyReference& all, const std::vector<TestConditions>& suspects) {
  const auto is_known = [&](const TestConditions& test) {
    return std::any_of(all.logs.begin(), all.logs.end(),
                       [&](const HealthyLog& log) { return is_followed(log) && is_alike(log, test); });
  };
  HealthyReference out = all;
  if (!std::all_of(suspects.begin(), suspects.end(), is_known)) return out;
  for (HealthyLog& log : out.logs)
    log.sets_no_share = !is_followed(log) && std::none_of(suspects.begin(), suspects.end(),
                                                          [&](const auto& test) { return is_alike(log, test); });
  return out;
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
