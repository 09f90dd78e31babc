// One pass over a signal against each question asked by itself, wherever the pass is cut.
#include "signals/one_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"

namespace servodx::test {
namespace {

// Levels of a coarse converter, so that neighbours repeat; missing samples, lone spikes.
std::vector<double> signal(std::size_t size, std::uint32_t seed) {
  Random random(11, seed, 0, 0);
  std::vector<double> x;
  double at = 0;
  for (std::size_t i = 0; i < size; ++i) {
    at += random.normal();
    const double kind = random.uniform();
    x.push_back(kind < 0.1 ? NAN : 0.01 * std::round(at) + (kind > 0.95 ? 3.0 * random.normal() : 0.0));
  }
  return x;
}

Sweep asked_one_by_one(const std::vector<double>& x) {
  Sweep s;
  for (const double v : x) {
    if (std::isnan(v)) continue;
    s.low = std::min(s.low, v);
    s.high = std::max(s.high, v);
  }
  const auto both = [&](std::size_t i) { return !std::isnan(x[i]) && !std::isnan(x[i + 1]); };
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if (!both(i)) continue;
    const double step = std::abs(x[i + 1] - x[i]);
    s.repeats += step == 0;
    s.largest_step = std::max(s.largest_step, step);
    if (step > 0) s.least_step = std::min(s.least_step, step);
  }
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    if (!both(i - 1) || !both(i)) continue;
    const double nearest = std::min(std::abs(x[i] - x[i - 1]), std::abs(x[i] - x[i + 1]));
    if (x[i] > std::max(x[i - 1], x[i + 1]) || x[i] < std::min(x[i - 1], x[i + 1])) s.lone = std::max(s.lone, nearest);
  }
  return s;
}

void expect_same(const Sweep& a, const Sweep& b, std::size_t size) {
  EXPECT_EQ(a.low, b.low) << size;
  EXPECT_EQ(a.high, b.high) << size;
  EXPECT_EQ(a.least_step, b.least_step) << size;
  EXPECT_EQ(a.largest_step, b.largest_step) << size;
  EXPECT_EQ(a.lone, b.lone) << size;
  EXPECT_EQ(a.repeats, b.repeats) << size;
}

TEST(Sweep, TellsWhatEachQuestionByItselfWouldWhereverItIsCut) {
  Random random(12, 0, 0, 0);
  for (std::size_t size = 0; size < 3 * Sweep::stretch; size = size < 40 ? size + 1 : 2 * size + 1)
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
      const std::vector<double> x = signal(size, seed);
      const Sweep expected = asked_one_by_one(x);
      expect_same(sweep_of(x), expected, size);
      Sweep cut;
      for (std::size_t from = 0, to; from < size; from = to) {
        to = std::min(size, from + 1 + random.below(static_cast<std::uint32_t>(size / 3 + 1)));
        cut.take(x, from, to);
      }
      expect_same(cut, expected, size);
    }
}

}  // namespace
}  // namespace servodx::test
