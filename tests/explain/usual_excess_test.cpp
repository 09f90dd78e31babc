// What healthy logs of other valves show of each cause.
#include "explain/usual_excess.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "explain/constants.h"
#include "explain/share_null.h"

namespace servodx {
namespace {

TEST(UsualExcess, OfWhatWasNotCountedIsThatOfAllCauses) {
  EXPECT_EQ(usual_excess("no effect"), explain_constants::usual_share);
}

TEST(UsualExcess, AGainTakesMoreOfAnyModelsErrorThanALineOfTheMains) {
  EXPECT_GT(usual_excess("sensor_gain_error"), 2 * usual_excess("mains_pickup"));
  EXPECT_GT(usual_excess("mains_pickup"), 0) << "what no log has shown may be the next that one shows";
}

// Without it a rig's few logs would judge both alike.
TEST(UsualExcess, IsWhatAFewHealthyLogsBeginFrom) {
  const std::vector<SharesOfLog> nothing(5, SharesOfLog{{}, std::nan("")});
  const ShareNull null(nothing, std::nan(""));
  EXPECT_LT(3 * null.chance("mains_pickup", 0.2), null.chance("sensor_gain_error", 0.2));
}

}  // namespace
}  // namespace servodx
