#include "base/median.h"

#include <gtest/gtest.h>

namespace servodx {
namespace {

TEST(Median, IsTheUpperOfTwoInTheMiddle) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 3, 2}), 3);
  EXPECT_EQ(median({}), 0);
}

TEST(Quantile, IsAValueThatIsThereTheLowerBetweenTwo) {
  const std::vector<double> v = {5, 1, 4, 2, 3};
  EXPECT_EQ(quantile(v, 0), 1);
  EXPECT_EQ(quantile(v, 0.5), 3);
  EXPECT_EQ(quantile(v, 0.7), 3);
  EXPECT_EQ(quantile(v, 1), 5);
  EXPECT_EQ(quantile({4, 1, 3, 2}, 0.5), 2);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

}  // namespace
}  // namespace servodx
