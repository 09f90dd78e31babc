// Where a series changes its variance, by what the change gains in likelihood.
#include "diagnose/onset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "base/two_pi.h"
#include "diagnose/constants.h"

namespace servodx {
namespace {

constexpr std::size_t quiet = 2000, loud = 2000;

std::vector<double> stepping_up(double times) {
  std::vector<double> square(quiet, 1.0);
  square.resize(quiet + loud, times);
  return square;
}

// ln of the likelihood of normal deviates with these squares, at the variance that suits them best.
double log_likelihood(std::vector<double>::const_iterator from, std::vector<double>::const_iterator to) {
  const auto n = static_cast<double>(to - from);
  const double variance = std::accumulate(from, to, 0.0) / n;
  double sum = 0;
  for (; from != to; ++from) sum += -0.5 * (std::log(two_pi * variance) + *from / variance);
  return sum;
}

// Of all samples; so many as are independent gain in proportion.
double gain_of_change(const std::vector<double>& square) {
  const auto at = square.begin() + quiet;
  return log_likelihood(square.begin(), at) + log_likelihood(at, square.end()) -
         log_likelihood(square.begin(), square.end());
}

TEST(VarianceStep, IsFoundFromTheStatedGainInLogLikelihoodOn) {
  for (const double times : {4.5, 9.0, 100.0}) {
    const std::vector<double> square = stepping_up(times);
    const double of_one = gain_of_change(square) / static_cast<double>(square.size());
    const double enough = diagnose_constants::change_gain / of_one;
    EXPECT_EQ(variance_step_up(square, 1.01 * enough), quiet) << times;
    EXPECT_FALSE(variance_step_up(square, 0.99 * enough)) << times;
  }
}

TEST(VarianceStep, OfLessThanTwiceTheRmsIsNone) {
  constexpr double independent = 4000;
  EXPECT_FALSE(variance_step_up(stepping_up(3.9), independent));
  EXPECT_EQ(variance_step_up(stepping_up(4.1), independent), quiet);
}

}  // namespace
}  // namespace servodx
