// The law of healthy excesses keeps its rate on excesses that it was not made with, and borrows where there are few.
#include "evidence/tail_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"

namespace servodx {
namespace {

constexpr UsualExcess usual{2.0, 10};

// An exponential excess of this mean, the k-th of a stream.
double excess(double mean, std::uint32_t stream, std::uint32_t k) {
  return -mean * std::log(1 - Random(7, k, stream).uniform());
}

TEST(TailLaw, KeepsItsRateOverValvesWhoseMeansScatterAsTheUsualSays) {
  // The mean of each valve is drawn from the prior: an inverse gamma of ten logs.
  constexpr double rate = 0.05;
  constexpr int valves = 4000;
  int beyond = 0;
  for (std::uint32_t v = 0; v < valves; ++v) {
    double gamma = 0;  // of shape ten: a sum of ten exponentials
    for (std::uint32_t k = 0; k < 10; ++k) gamma += excess(1, 1000 + v, k);
    const double mean = usual.mean * usual.logs / gamma;
    std::vector<double> healthy;
    for (std::uint32_t k = 0; k < 8; ++k) healthy.push_back(excess(mean, 9000 + v, k));
    beyond += excess(mean, 20000 + v, 0) > TailLaw(healthy, usual).excess_at(rate);
  }
  const double se = std::sqrt(rate * (1 - rate) / valves);
  EXPECT_NEAR(static_cast<double>(beyond) / valves, rate, 3 * se);
}

TEST(TailLaw, ChanceAndExcessAreEachOthersInverse) {
  const TailLaw law({0.5, 1.5, 4.0}, usual);
  for (const double rate : {0.001, 0.01, 0.05}) EXPECT_NEAR(law.chance(law.excess_at(rate)), rate, 1e-12);
  EXPECT_EQ(law.chance(0), 1);
  EXPECT_EQ(law.chance(-1), 1);
}

TEST(TailLaw, WhatHealthyLogsShowIsNoRarerThanTheyAre) {
  const TailLaw law({0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 30}, usual);
  EXPECT_GE(law.chance(29), 0.2) << "one of nine shows as much: two in ten";
  EXPECT_LT(law.chance(31), 0.2);
}

TEST(TailLaw, FewAlikeLogsDoNotMakeItSharperThanTheUsualAllows) {
  const TailLaw alike(std::vector<double>(12, 0.01), usual);
  EXPECT_GT(alike.excess_at(0.06), 1.0) << "a hundred times what the healthy logs show";
  const TailLaw many(std::vector<double>(1000, 0.01), usual);
  EXPECT_LT(many.excess_at(0.06), 0.1) << "a thousand logs outweigh it";
}

TEST(TailLaw, SaysHowManyLogsItTakes) {
  const TailLaw law(std::vector<double>(4, 2.0), usual);
  constexpr double asked = 0.2, share = 0.5;  // a rate that nine logs can promise
  const double excess = law.excess_at(0.11);  // nearly news
  const int logs = law.logs_needed(excess, asked, share);
  ASSERT_GT(logs, 4);
  // With so many logs of the same mean it is news, and with one less it is not.
  const auto news = [&](int n) {
    return TailLaw(std::vector<double>(static_cast<std::size_t>(n), 2.0), usual).chance(excess) <=
           rate_of_question(asked, n, share);
  };
  EXPECT_TRUE(news(logs));
  EXPECT_FALSE(news(logs - 1));
  EXPECT_EQ(law.logs_needed(100, asked, share), 0) << "news already";
  EXPECT_EQ(law.logs_needed(0.1, asked, share), -1) << "never";
}

}  // namespace
}  // namespace servodx
