// What a fleet's truth says of stated probabilities and of the least sizes, in words, JSON and on a page.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fleet/calibration.h"
#include "fleet/confusion.h"
#include "fleet/detectable_found.h"
#include "fleet/gather.h"
#include "report/fleet/fleet.h"
#include "report/shared/json.h"
#include "report/shared/page.h"

namespace servodx::report {
namespace {

using Bound = BoundCase::Bound;

Confusion some_confusion() {
  std::vector<Statement> statements;
  for (int i = 0; i < 200; ++i) statements.push_back({0.9, i < 120});
  Confusion out;
  out.calibration = calibration_of(statements, 1);
  out.detectable = detectable_found_of({{"sticky_spool", Bound::known, 1.1, false, false},
                                        {"sticky_spool", Bound::known, 5, true, true},
                                        {"clogged_filter", Bound::none, 0, true, false},
                                        {"clogged_filter", Bound::unstated, 0, true, false}});
  return out;
}

TEST(FleetTruth, TextAndPageSayTheErrorWithItsIntervalAndWhatWasPromisedBesideWhatWasFound) {
  const Confusion confusion = some_confusion();
  for (const std::string& said : {text_of(FleetTable{}, confusion), fleet_page({}, FleetTable{}, confusion).html()})
    for (const char* words :
         {"xpected calibration error 30 % (2", "90 to 99 %", "120 of 200, 60 % (53", "1 to 1.2", "4 and more",
          "1 of 2, 50 %", "not even the worst shown", "1, 0 of 1", "of 1 fault more the log states no least"})
      EXPECT_NE(said.find(words), std::string::npos) << words << '\n' << said;
}

TEST(FleetTruth, JsonHasEveryCountWithItsInterval) {
  const Json json = fleet_json(FleetTable{}, some_confusion());
  const Json& calibration = json["calibration"];
  EXPECT_NEAR(calibration["error"].get<double>(), 0.3, 1e-12);
  EXPECT_LT(calibration["lower"].get<double>(), 0.3);
  EXPECT_GT(calibration["upper"].get<double>(), 0.3);
  EXPECT_EQ(calibration["bins"].size(), 1u);
  EXPECT_EQ(calibration["bins"][0]["right"]["counted"], 120);
  const Json& found = json["detectable_found"];
  EXPECT_EQ(found["all"]["beyond"]["found"]["counted"], 1);
  EXPECT_EQ(found["all"]["beyond"]["found"]["of"], 2);
  EXPECT_GT(found["all"]["beyond"]["found"]["lower"].get<double>(), 0.05);
  EXPECT_EQ(found["faults"]["sticky_spool"]["well_beyond"]["named"]["of"], 1);
  EXPECT_TRUE(found["bands"].back()["to"].is_null());
  EXPECT_EQ(found["unstated"], 1);
}

TEST(FleetTruth, WithoutTruthOrNamesThereIsNothing) {
  const Json without = fleet_json(FleetTable{}, {});
  EXPECT_TRUE(without["calibration"].is_null());
  EXPECT_TRUE(without["detectable_found"].is_null());
  Confusion none;
  none.calibration = calibration_of({}, 1), none.detectable = detectable_found_of({});
  const Json json = fleet_json(FleetTable{}, none);
  EXPECT_TRUE(json["calibration"]["error"].is_null());
  EXPECT_TRUE(json["detectable_found"]["median"].is_null());
  for (const std::string& said : {text_of(FleetTable{}, none), fleet_page({}, FleetTable{}, none).html()}) {
    EXPECT_EQ(said.find("alibration error"), std::string::npos);
    EXPECT_EQ(said.find("of known size"), std::string::npos);
  }
}

}  // namespace
}  // namespace servodx::report
