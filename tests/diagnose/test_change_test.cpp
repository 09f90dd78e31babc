// What has become of a valve between two tests: cases of what each of them found.
#include "diagnose/test_change.h"

#include <gtest/gtest.h>

#include <limits>

namespace servodx {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr TestFinding healthy{.healthy = true}, unsized{};

TestFinding sized(double lower, double upper) { return {.size = TestFinding::Size{lower, upper}}; }

struct Case {
  const char* what;
  TwoFindings found;
  TestChange change;
};

TEST(TestChange, IsOfTheFindingFirstAndThenOfTheSizeTowardsItsWorst) {
  constexpr bool same = true, other = false, upwards = true, downwards = false;
  const Case cases[] = {
      {"health in both", {healthy, healthy, same, upwards}, TestChange::alike},
      {"health, then a fault or an unknown state", {healthy, unsized, other, upwards}, TestChange::failed},
      {"health, then a fault with a size", {healthy, sized(1, 2), other, upwards}, TestChange::failed},
      {"an unknown state or a fault, then health", {unsized, healthy, other, upwards}, TestChange::mended},
      {"a fault with a size, then health", {sized(1, 2), healthy, other, downwards}, TestChange::mended},
      {"an unknown state and a fault, in any order", {unsized, sized(1, 2), other, upwards}, TestChange::another},
      {"two faults, whatever their sizes", {sized(1, 2), sized(3, 4), other, upwards}, TestChange::another},
      {"an unknown state in both", {unsized, unsized, same, upwards}, TestChange::alike},
      {"a fault with a size in one alone", {unsized, sized(3, 4), same, upwards}, TestChange::alike},
      {"a larger size, worse upwards", {sized(1, 2), sized(3, 4), same, upwards}, TestChange::grown},
      {"a smaller size, worse upwards", {sized(3, 4), sized(1, 2), same, upwards}, TestChange::lessened},
      {"a larger size, worse downwards", {sized(0.3, 0.4), sized(0.6, 0.7), same, downwards}, TestChange::lessened},
      {"a smaller size, worse downwards", {sized(0.6, 0.7), sized(0.3, 0.4), same, downwards}, TestChange::grown},
      {"intervals that overlap", {sized(1, 2), sized(1.9, 4), same, upwards}, TestChange::alike},
      {"intervals that touch", {sized(1, 2), sized(2, 4), same, upwards}, TestChange::alike},
      {"an end that is not known", {sized(1, nan), sized(3, 4), same, upwards}, TestChange::alike},
  };
  for (const Case& c : cases) EXPECT_EQ(change_of(c.found), c.change) << c.what;
}

}  // namespace
}  // namespace servodx
