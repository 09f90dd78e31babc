// The text for Prometheus of what a trend says: state and life left.
#include "report/trend/life_gauges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "prognose/trend.h"
#include "prognose/trend_state.h"
#include "servodx/trend.h"

namespace servodx::report {
namespace {

Trend trend_of(const std::string& valve, TrendState state, std::optional<Trend::Remaining> remaining = {}) {
  ValveTrend whole;
  whole.state = state;
  Trend t;
  t.valve = valve;
  t.remaining = remaining;
  t.whole = std::make_shared<ValveTrend>(whole);
  return t;
}

TEST(LifeGauges, LivesAreToldWithTheirBoundsAndWhatIsNotKnownIsLeftOut) {
  EXPECT_EQ(life_gauges({trend_of("V7", TrendState::warning, Trend::Remaining{120.5, 80, HUGE_VAL}),
                         trend_of("V8", TrendState::healthy), trend_of("V\"9", TrendState::unknown)}),
            R"(# HELP servodx_valve_state 1 for the state that the valve's history shows.
# TYPE servodx_valve_state gauge
servodx_valve_state{valve="V7",state="warning"} 1
servodx_valve_state{valve="V8",state="healthy"} 1
servodx_valve_state{valve="V\"9",state="unknown"} 1
# HELP servodx_valve_life_left_hours Hours of use until the valve fails: median and bounds.
# TYPE servodx_valve_life_left_hours gauge
servodx_valve_life_left_hours{valve="V7",bound="lower"} 80
servodx_valve_life_left_hours{valve="V7",bound="median"} 120.5
servodx_valve_life_left_hours{valve="V7",bound="upper"} +Inf
)");
}

}  // namespace
}  // namespace servodx::report
