// The rules of the alert on made-up evidence, a row a case: no fit, no history.
#include "prognose/alert_rule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "prognose/level.h"
#include "prognose/trend_state.h"

namespace servodx {
namespace {

const Level none, over_2{{}, 2}, over_4{{}, 4}, over_8{{}, 8}, under_minus_4{-4, {}}, under_minus_8{-8, {}};
const Level outside_2{-2, 2}, outside_4{-4, 4};
constexpr double at_start = 0, beyond_threshold = 3, beyond_warning = 5, beyond_failure = 9;

struct Case {
  std::string name;
  TrendEvidence evidence;  // confirmed, away, threshold, warning, failure, last, now
  TrendState state;
  bool blind, predicted, alert;
};

const std::vector<Case> cases = {
    {"nothing moves",
     {false, false, over_2, over_4, over_8, at_start, at_start},
     TrendState::healthy,
     false,
     false,
     false},
    {"one check beyond the threshold is watched",
     {false, false, over_2, over_4, over_8, beyond_threshold, at_start},
     TrendState::watch,
     false,
     false,
     false},
    {"at the threshold it is not beyond it",
     {false, false, over_2, over_4, over_8, 2, at_start},
     TrendState::healthy,
     false,
     false,
     false},
    {"one check beyond failure raises no alert",
     {false, false, over_2, over_4, over_8, beyond_failure, beyond_failure},
     TrendState::watch,
     false,
     false,
     false},
    {"a trend short of the warning is watched and given a life",
     {true, false, over_2, over_4, over_8, at_start, beyond_threshold},
     TrendState::watch,
     false,
     true,
     false},
    {"a trend at the warning has not passed it",
     {true, false, over_2, over_4, over_8, 4, 4},
     TrendState::watch,
     false,
     true,
     false},
    {"a trend beyond the warning",
     {true, false, over_2, over_4, over_8, beyond_warning, beyond_warning},
     TrendState::warning,
     false,
     true,
     true},
    {"the curve counts, not the last check",
     {true, false, over_2, over_4, over_8, at_start, beyond_warning},
     TrendState::warning,
     false,
     true,
     true},
    {"a trend beyond failure",
     {true, false, over_2, over_4, over_8, beyond_failure, beyond_failure},
     TrendState::failed,
     false,
     true,
     true},
    {"a figure that falls fails below",
     {true, false, outside_2, under_minus_4, under_minus_8, -beyond_failure, -beyond_failure},
     TrendState::failed,
     false,
     true,
     true},
    {"without a failure level a trend still warns, to either side",
     {true, false, outside_2, outside_4, none, -beyond_warning, -beyond_warning},
     TrendState::warning,
     false,
     true,
     true},
    {"away from failure is no way to it",
     {true, true, over_2, over_4, over_8, beyond_warning, beyond_warning},
     TrendState::watch,
     false,
     false,
     false},
    {"health scatters beyond failure: one check says nothing",
     {false, false, over_8, over_4, over_4, beyond_failure, at_start},
     TrendState::blind,
     true,
     false,
     false},
    {"health scatters as far as failure",
     {false, false, over_4, over_4, over_4, at_start, at_start},
     TrendState::blind,
     true,
     false,
     false},
    {"the same of a figure that falls",
     {false, false, under_minus_8, under_minus_4, under_minus_4, -beyond_failure, at_start},
     TrendState::blind,
     true,
     false,
     false},
    {"blind to one check is not blind to a trend",
     {true, false, over_8, over_4, over_8, beyond_warning, beyond_warning},
     TrendState::warning,
     true,
     true,
     true},
};

TEST(AlertRule, EachCaseIsDecidedAsTheRulesSay) {
  for (const Case& c : cases) {
    const AlertDecision made = decide(c.evidence);
    EXPECT_EQ(static_cast<int>(made.state), static_cast<int>(c.state)) << c.name;
    EXPECT_EQ(made.blind, c.blind) << c.name;
    EXPECT_EQ(made.predicted, c.predicted) << c.name;
    EXPECT_EQ(made.alert, c.alert) << c.name;
  }
}

// No evidence whatever raises an alert, or tells a failure, without a confirmed trend towards it.
TEST(AlertRule, NoAlertStandsWithoutAConfirmedTrendTowardsFailure) {
  for (const Case& c : cases)
    for (const auto& [confirmed, away] : {std::pair(false, false), {false, true}, {true, true}}) {
      TrendEvidence e = c.evidence;
      e.confirmed = confirmed, e.away = away;
      EXPECT_FALSE(decide(e).alert) << c.name;
      EXPECT_LT(decide(e).state, TrendState::warning) << c.name;
    }
}

// With twice as many checks, or at half of the rate, a trend takes twice the odds.
TEST(AlertRule, ChecksShareTheRateOfFalseAlarms) {
  EXPECT_TRUE(is_confirmed(std::log(100) + 1e-9, 1, 0.01));
  EXPECT_FALSE(is_confirmed(std::log(100) - 1e-9, 1, 0.01));
  EXPECT_FALSE(is_confirmed(std::log(200) - 1e-9, 2, 0.01));
  EXPECT_FALSE(is_confirmed(std::log(200) - 1e-9, 1, 0.005));
  EXPECT_FALSE(is_confirmed(std::numeric_limits<double>::quiet_NaN(), 1, 0.01));
}

}  // namespace
}  // namespace servodx
