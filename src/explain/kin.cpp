#include "explain/kin.h"

#include <algorithm>

#include "evidence/constants.h"
#include "explain/constants.h"
#include "fit/own_air.h"

namespace servodx {
namespace {

bool is_followed(const HealthyLog& log) {
  using evidence_constants::followed_adequacy;
  return log.adequacy <= followed_adequacy * followed_adequacy;  // its is of squares
}

bool is_alike(const HealthyLog& log, const TestConditions& test) { return log.test && distance(*log.test, test) <= 1; }

}  // namespace

bool takes_all_air(const HealthyLog& log) { return log.air >= (1 - explain_constants::at_end) * most_own_air; }

HealthyReference shares_marked(const HealthyReference& all, const std::vector<TestConditions>& suspects, bool all_air) {
  const auto is_known = [&](const TestConditions& test) {
    return std::any_of(all.logs.begin(), all.logs.end(),
                       [&](const HealthyLog& log) { return is_followed(log) && is_alike(log, test); });
  };
  const bool known = std::all_of(suspects.begin(), suspects.end(), is_known);
  HealthyReference out = all;
  for (HealthyLog& log : out.logs) {
    const bool alike = std::any_of(suspects.begin(), suspects.end(), [&](const auto& t) { return is_alike(log, t); });
    log.sets_no_share = (known && !is_followed(log) && !alike) || (!all_air && takes_all_air(log));
  }
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
