#include "base/random.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace servodx {
namespace {

// Known answers of the authors' Random123 library.
TEST(Random, PhiloxGivesThePublishedBlocks) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (PhiloxBlock{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t f = 0xffffffff;
  EXPECT_EQ(philox4x32({f, f, f, f}, {f, f}), (PhiloxBlock{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (PhiloxBlock{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, AStreamDependsOnItsNameOnly) {
  Random first(7, 1, 2, 3);
  std::vector<std::uint32_t> drawn;
  for (int i = 0; i < 100; ++i) drawn.push_back(first());
  Random other(7, 1, 2, 4), again(7, 1, 2, 3);
  for (int i = 0; i < 100; ++i) {
    other();
    EXPECT_EQ(again(), drawn[i]);
  }
}

TEST(Random, StreamsOfDifferentNamesDiffer) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed : {0ull, 1ull, 1ull << 32})
    for (std::uint32_t a : {0u, 1u})
      for (std::uint32_t b : {0u, 1u})
        for (std::uint32_t c : {0u, 1u}) EXPECT_TRUE(first.insert(Random(seed, a, b, c).bits64()).second);
}

TEST(Random, UniformAndNormalHaveTheirMoments) {
  Random random(3);
  const int n = 200000;
  double u = 0, uu = 0, z = 0, zz = 0, zzzz = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform();
    ASSERT_GE(x, 0.0);
    ASSERT_LT(x, 1.0);
    u += x;
    uu += x * x;
    const double g = random.normal();
    z += g;
    zz += g * g;
    zzzz += g * g * g * g;
  }
  const double standard_errors = 5.0 / std::sqrt(n);
  EXPECT_NEAR(u / n, 1.0 / 2, standard_errors * std::sqrt(1.0 / 12));
  EXPECT_NEAR(uu / n, 1.0 / 3, standard_errors * std::sqrt(4.0 / 45));
  EXPECT_NEAR(z / n, 0.0, standard_errors);
  EXPECT_NEAR(zz / n, 1.0, standard_errors * std::sqrt(2.0));
  EXPECT_NEAR(zzzz / n, 3.0, standard_errors * std::sqrt(96.0));
}

TEST(Random, BelowReachesEveryNumberAlike) {
  Random random(5);
  std::vector<int> count(7);
  for (int i = 0; i < 70000; ++i) ++count.at(random.below(7));
  for (int each : count) EXPECT_NEAR(each, 10000, 5 * 93);
}

}  // namespace
}  // namespace servodx
