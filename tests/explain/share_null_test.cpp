// Shares of the misfit beside what is usual of their own cause.
#include "explain/share_null.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "evidence/tail_law.h"
#include "explain/constants.h"

namespace servodx {
namespace {

constexpr double everywhere = NAN;  // of the oil

std::vector<SharesOfLog> repeated(int logs, const std::vector<std::pair<std::string, double>>& shares) {
  SharesOfLog log{{}, everywhere};
  for (const auto& [effect, share] : shares) log.of_effect[effect] = share;
  return std::vector(static_cast<std::size_t>(logs), log);
}

TEST(ShareNull, ACauseThatGainsOnMostHealthyLogsHasToGainMoreThanOneThatGainsOnNone) {
  const ShareNull healthy(repeated(12, {{"often", 0.15}}), everywhere);
  const double rate = 0.5 / 13;
  EXPECT_GT(healthy.chance("often", 0.22), rate);
  EXPECT_LE(healthy.chance("never", 0.22), rate);
  EXPECT_GT(healthy.chance("never", 0.05), rate) << "a little is what the model's error gives any cause";
}

// Otherwise each log would shrink its own ratio, the more the fewer they are.
TEST(ShareNull, AHealthyLogStandsBesideTheUsualOfTheOthers) {
  std::vector<Excesses> healthy(5);
  healthy.front()["once"] = 0.7;
  const double prior = explain_constants::usual_logs;
  const double others = explain_constants::usual_share * prior / (prior + 4);
  EXPECT_NEAR(UsualExcesses(healthy).largest_ratio(healthy.front()), 0.7 / others, 1e-9);
  EXPECT_EQ(UsualExcesses(healthy).largest_ratio(healthy.back()), 0);
}

TEST(ShareNull, WhatHealthyLogsShowOfAnyCauseIsNoRarerThanTheyAre) {
  std::vector<SharesOfLog> healthy = repeated(11, {});
  healthy.front().of_effect["once"] = 0.9;
  const ShareNull null(healthy, everywhere);
  EXPECT_GE(null.chance("once", 0.6), 2.0 / 12);
  EXPECT_GE(null.chance("another", 0.6), 2.0 / 12) << "a name that none has shown may be the next that one shows";
}

// Causes gain each about a mean of its own, and the largest of a log's is chosen among all.
TEST(ShareNull, HealthyLogsAreAccusedAtTheRateWhateverTheMeansOfTheirCauses) {
  constexpr int trials = 2000, logs = 12;
  const double rate = rate_of_question(0.01, logs, explain_constants::of_shares);
  int accused = 0;
  for (int t = 0; t < trials; ++t) {
    Random random(71, static_cast<std::uint32_t>(t));
    std::vector<double> mean;
    for (int c = 0; c < 16; ++c) mean.push_back(0.002 * std::pow(50, random.uniform(0, 1)));
    const auto draw = [&] {
      SharesOfLog log{{}, everywhere};
      for (std::size_t c = 0; c < mean.size(); ++c)
        log.of_effect["cause " + std::to_string(c)] = 1 - std::exp(mean[c] * std::log(random.uniform(0, 1)));
      return log;
    };
    std::vector<SharesOfLog> healthy;
    for (int i = 0; i < logs; ++i) healthy.push_back(draw());
    const ShareNull null(healthy, everywhere);
    double least = 1;
    for (const auto& [effect, share] : draw().of_effect) least = std::min(least, null.chance(effect, share));
    accused += least <= rate;
  }
  EXPECT_LE(accused, rate * trials + 2.5 * std::sqrt(rate * trials));
}

}  // namespace
}  // namespace servodx
