// How sizes scatter over healthy logs: the two faces of it, and the line that follows the oil.
#include "explain/size_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace servodx {
namespace {

// Alternately above and below a middle of 5 by so many standard errors, these given; in one oil.
std::vector<SizeOnLog> sizes(double off, const std::vector<double>& errors) {
  std::vector<SizeOnLog> out;
  for (std::size_t i = 0; i < errors.size(); ++i)
    out.push_back({5 + (i % 2 ? off : -off) * errors[i], errors[i] * errors[i], 0});
  return out;
}

TEST(SizeScatter, SizesThatAgreeWithinTheirErrorsScatterByNothingElse) {
  const SizeScatter s = scatter_of(sizes(0.5, {1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(s.tau2, 0);
  EXPECT_EQ(s.phi2, 1);
  EXPECT_NEAR(s.mean, 5, 1e-9);
  EXPECT_NEAR(s.variance(4), 4, 1e-9);
}

TEST(SizeScatter, ScatterInProportionToTheErrorsIsTakenAsSuch) {
  const SizeScatter s = scatter_of(sizes(10, {0.01, 0.01, 0.1, 0.1, 1, 1, 10, 10}));
  EXPECT_EQ(s.tau2, 0);
  EXPECT_GT(s.phi2, 50);
}

TEST(SizeScatter, ScatterAlikeOnAllLogsIsTakenAsSuch) {
  std::vector<SizeOnLog> made;
  for (int i = 0; i < 8; ++i) made.push_back({5.0 + (i % 2 ? 2 : -2), std::pow(10.0, -2 - i / 2), 0});
  const SizeScatter s = scatter_of(made);
  EXPECT_EQ(s.phi2, 1);
  EXPECT_GT(s.tau2, 4);
  EXPECT_LT(s.tau2, 8);
}

TEST(SizeScatter, AnOilThatIsNotKnownChangesNothingButTheLine) {
  std::vector<SizeOnLog> made;
  for (int i = 0; i < 8; ++i) made.push_back({5.0 + (i % 2 ? 2 : -2), std::pow(10.0, -2 - i / 2), 0});
  const SizeScatter in_one_oil = scatter_of(made);
  for (SizeOnLog& z : made) z.thickness = std::numeric_limits<double>::quiet_NaN();
  const SizeScatter unknown = scatter_of(made);
  EXPECT_DOUBLE_EQ(unknown.tau2, in_one_oil.tau2);
  EXPECT_DOUBLE_EQ(unknown.phi2, in_one_oil.phi2);
  EXPECT_DOUBLE_EQ(unknown.log_likelihood, in_one_oil.log_likelihood);
}

TEST(SizeScatter, ALineThroughTheOilIsTakenWhereItIsWorthItsNumber) {
  std::vector<SizeOnLog> made;
  for (int i = 0; i < 12; ++i) made.push_back({3 * 0.1 * i + (i % 2 ? 0.01 : -0.01), 1e-4, 0.1 * i});
  const SizeScatter line = scatter_of(made);
  EXPECT_NEAR(line.slope, 3, 0.05);
  EXPECT_NEAR(line.at(2.0), 6, 0.1);
  for (SizeOnLog& z : made) z.thickness = std::numeric_limits<double>::quiet_NaN();
  const SizeScatter mean = scatter_of(made);
  EXPECT_EQ(mean.slope, 0);
  EXPECT_GT(mean.variance(1e-4), 0.5) << "what follows the oil scatters where the oil is not known";
}

}  // namespace
}  // namespace servodx
