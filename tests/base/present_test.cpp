// Figures of what is there.
#include "base/present.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace servodx {
namespace {

const double gone = std::nan(""), beyond = std::numeric_limits<double>::infinity();

TEST(Present, LeavesOutWhatIsNotThere) {
  const std::vector<double> x = {gone, 3, beyond, -1, gone};
  EXPECT_EQ(present(x), (std::vector<double>{3, -1}));
  EXPECT_EQ(mean_of_present(x), 1);
  EXPECT_EQ(rms_of_present(x), std::sqrt(5.0));
  EXPECT_EQ(mean_of_present(3, 5, [&](std::size_t k) { return x[k]; }), -1);
}

TEST(Present, OfNothingHasNoMeanAndNoSize) {
  for (const std::vector<double>& x : {std::vector<double>{}, std::vector<double>{gone, gone}}) {
    EXPECT_TRUE(present(x).empty());
    EXPECT_TRUE(std::isnan(mean_of_present(x)));
    EXPECT_EQ(rms_of_present(x), 0);
  }
}

}  // namespace
}  // namespace servodx
