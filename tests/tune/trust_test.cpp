// Whether a tune is good enough: cases of what is known of it, one doubt at a time.
#include "tune/trust.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "optimise/box_least_squares.h"
#include "servodx/log.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double never = std::numeric_limits<double>::infinity();

// Nothing is wrong with it.
TrustEvidence good() {
  TrustEvidence e;
  e.channels = {{Signal::spool_position, 1e-6, 5e-7, {{0, 1.0}, {1, 1.1}, {2, 1.5}}}};
  e.starts = 2, e.in_best_valley = 2;
  e.faults = {{20, 30}, {3, 12}};
  return e;
}

struct Case {
  std::string what;
  std::function<void(TrustEvidence&)> change;
  Trust trust = Trust::yes;
  std::vector<TrustDoubt> doubts;
};

void ends(TrustEvidence& e, StopReason stop, double promised, double cost = 0) {
  e.stop = stop, e.still_promised = promised, e.cost = cost;
}

const Case cases[] = {
    {"nothing", [](auto&) {}, Trust::yes, {}},
    {"a search that met its goal", [](auto& e) { e.stop = StopReason::goal; }, Trust::yes, {}},
    {"nothing known of faults", [](auto& e) { e.faults.clear(); }, Trust::yes, {}},
    {"nothing held out", [](auto& e) { e.channels[0].logs.clear(); }, Trust::yes, {}},
    {"an error at fifty times the noise",
     [](auto& e) { e.channels[0].error = 50 * e.channels[0].noise; },
     Trust::yes,
     {}},
    {"an error beyond that",
     [](auto& e) { e.channels[0].error = 51 * e.channels[0].noise; },
     Trust::with_care,
     {TrustDoubt::another_sheet}},
    {"an error where no noise is known",
     [](auto& e) { e.channels[0].error = 1, e.channels[0].noise = 0; },
     Trust::yes,
     {}},
    {"a median prediction twice as wrong as the fit",
     [](auto& e) { e.channels[0].logs[1].over_fitted = e.channels[0].logs[2].over_fitted = 2; },
     Trust::yes,
     {}},
    {"a median prediction beyond that",
     [](auto& e) { e.channels[0].logs[1].over_fitted = 2.1, e.channels[0].logs[2].over_fitted = 2.2; },
     Trust::with_care,
     {TrustDoubt::predicts_worse}},
    {"one log alone that is predicted worse", [](auto& e) { e.channels[0].logs[2].over_fitted = 31; }, Trust::yes, {}},
    {"a size at the end of the sheet's range",
     [](auto& e) { e.off_drawing = true; },
     Trust::with_care,
     {TrustDoubt::off_drawing}},
    {"steps that ended, with chance alone promised",
     [](auto& e) { ends(e, StopReason::iteration_limit, 0.5); },
     Trust::yes,
     {}},
    {"steps that ended, with more promised",
     [](auto& e) { ends(e, StopReason::iteration_limit, 0.6); },
     Trust::with_care,
     {TrustDoubt::not_arrived}},
    {"a thousandth of the cost promised", [](auto& e) { ends(e, StopReason::stalled, 0.6, 780); }, Trust::yes, {}},
    {"simulations that ended, without derivatives",
     [](auto& e) { ends(e, StopReason::evaluation_limit, never); },
     Trust::with_care,
     {TrustDoubt::not_arrived}},
    {"a start that failed",
     [](auto& e) { ends(e, StopReason::start_failed, 0); },
     Trust::with_care,
     {TrustDoubt::not_arrived}},
    {"a second start in another valley",
     [](auto& e) { e.in_best_valley = 1; },
     Trust::with_care,
     {TrustDoubt::lone_valley}},
    {"one start alone", [](auto& e) { e.starts = 1, e.in_best_valley = 1; }, Trust::yes, {}},
    {"a fault that hides at its mildest", [](auto& e) { e.faults[1].at_least = 2.9; }, Trust::yes, {}},
    {"a fault that hides at its typical size",
     [](auto& e) { e.faults[1].at_typical = 2.9; },
     Trust::with_care,
     {TrustDoubt::hidden_faults}},
    {"a fault of which nothing is known",
     [](auto& e) {
       e.faults[1] = {nan, nan};
     },
     Trust::with_care,
     {TrustDoubt::hidden_faults}},
    // Of an interrupted tune it is no news that its search has not arrived.
    {"an interruption",
     [](auto& e) { e.interrupted = true, ends(e, StopReason::interrupted, 7); },
     Trust::with_care,
     {TrustDoubt::interrupted}},
    {"a channel that the model does not follow",
     [](auto& e) { e.unfollowed = true; },
     Trust::no,
     {TrustDoubt::unfollowed}},
    {"several at once, in the order in which they are told",
     [](auto& e) { e.in_best_valley = 1, e.unfollowed = e.off_drawing = true; },
     Trust::no,
     {TrustDoubt::unfollowed, TrustDoubt::off_drawing, TrustDoubt::lone_valley}},
};

TEST(TuneTrust, IsYesWithoutDoubtsNoWhereTheLogsAreNotFollowedAndElseWithCare) {
  for (const Case& c : cases) {
    TrustEvidence e = good();
    c.change(e);
    const TrustVerdict v = trust_in(e);
    EXPECT_EQ(v.trust, c.trust) << c.what;
    EXPECT_EQ(v.doubts, c.doubts) << c.what;
  }
}

TEST(TuneTrust, FiguresAreOfWhatIsDoubted) {
  TrustEvidence e = good();
  e.channels[0].error = 60 * e.channels[0].noise;
  e.channels.push_back({Signal::pressure_a, 1e5, 1e4, {{0, 2.5}, {2, 2.1}, {1, 3.0}}});
  e.channels[0].logs[1].over_fitted = 31;
  e.faults = {{20, 30}, {2, 12}, {0.5, 1}};
  const TrustVerdict v = trust_in(e);
  ASSERT_EQ(v.beyond_noise.size(), 1u);
  EXPECT_EQ(v.beyond_noise[0].signal, Signal::spool_position);
  EXPECT_NEAR(v.beyond_noise[0].times, 60, 1e-9);
  ASSERT_EQ(v.worse.size(), 1u);
  EXPECT_EQ(v.worse[0].signal, Signal::pressure_a);
  EXPECT_EQ(v.worse[0].times, 2.5);
  ASSERT_EQ(v.exceptions.size(), 1u) << "of a channel that is predicted worse at large no log is an exception";
  EXPECT_EQ(v.exceptions[0].signal, Signal::spool_position);
  EXPECT_EQ(v.exceptions[0].log, 1u);
  EXPECT_EQ(v.exceptions[0].times, 31);
  EXPECT_EQ(v.hidden, std::vector<std::size_t>{2});
  EXPECT_EQ(v.faint, std::vector<std::size_t>{1});
}

TEST(TuneTrust, PredictionsAreOfLogsWithAFitAndAHeldOutPart) {
  const auto log_with = [](double fitted, double heldout) {
    return LogResult{"log.csv", {{Signal::spool_position, "um", fitted, 5e-7, heldout}}};
  };
  TuneResult result;
  result.channels = {{Signal::spool_position, "um", 1e-6, 5e-7, 1.5e-6}};
  result.logs = {log_with(1e-6, nan), log_with(0, 1e-6), log_with(1e-6, 3e-6)};
  result.starts = {{StartEnd::From::table, 1.0, true}, {StartEnd::From::genetic, 2.0, false}};
  const TrustEvidence e = evidence_of(result, {{1, 2}});
  ASSERT_EQ(e.channels.size(), 1u);
  EXPECT_EQ(e.channels[0].error, 1e-6);
  EXPECT_EQ(e.channels[0].noise, 5e-7);
  ASSERT_EQ(e.channels[0].logs.size(), 1u);
  EXPECT_EQ(e.channels[0].logs[0].log, 2u);
  EXPECT_NEAR(e.channels[0].logs[0].over_fitted, 3, 1e-12);
  EXPECT_EQ(e.starts, 2u);
  EXPECT_EQ(e.in_best_valley, 1);
  EXPECT_EQ(e.faults.size(), 1u);
}

}  // namespace
}  // namespace servodx
