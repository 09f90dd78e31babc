// A verdict beside the last one of the valve: what is said to have changed, by made-up verdicts.
#include "report/diagnose/two_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "store/verdict_file.h"
#include "temporary_folder.h"

namespace servodx::report {
namespace {

using store::verdict_of;

Json row(const char* name, double nominal, double estimate, double std_error) {
  return {{"name", name}, {"unit", "N"}, {"nominal", nominal}, {"estimate", estimate}, {"std_error", std_error}};
}

Json result(const char* verdict, const Json& rows, const std::string& table = "t") {
  return {{"command", "diagnose"},
          {"tool", "servodx"},
          {"settings", {{"against", "old.json"}}},
          {"inputs",
           {{{"path", "rig.toml"}, {"sha256", verdict}},
            {{"path", "tuned.csv"}, {"sha256", table}},
            {{"path", "old.json"}, {"sha256", verdict}},
            {{"path", "log.csv"}, {"sha256", verdict}}}},
          {"results", Json::array({{{"log", "log.csv"},
                                    {"logs", {"log.csv"}},
                                    {"verdict", verdict},
                                    {"error", 0.5},
                                    {"threshold", 2.0},
                                    {"null", 0.01},
                                    {"parameters", rows}}})}};
}

TEST(TwoTests, ARowThatOneLeftAloneStandsAtItsTunedValueThere) {
  const Json last = result("healthy", Json::array({row("spool_friction", 1, 1.1, 0.3)}));
  const Json now =
      result("unknown", Json::array({row("spool_friction", 1, 1.5, 0.4), row("moving_mass", 10, 13, 0.5)}));
  const TwoTests t = two_tests("last.json", verdict_of(last), verdict_of(now));
  ASSERT_EQ(t.rows.size(), 2u);
  EXPECT_EQ(t.rows[0].name, "moving_mass");
  EXPECT_EQ(t.rows[0].last, 10);
  EXPECT_NEAR(t.rows[0].sigmas, 6, 1e-12);
  EXPECT_TRUE(t.rows[0].matters);
  EXPECT_NEAR(t.rows[1].sigmas, 0.8, 1e-12);  // errors of both: sqrt(0.3^2 + 0.4^2)
  EXPECT_FALSE(t.rows[1].matters);
}

// Rig files change with the date on the page, logs by themselves, and the last result judges nothing.
TEST(TwoTests, OtherTablesAreToldAndTheirUnsharedRowsLeftOut) {
  const Json last = result("healthy", Json::array({row("spool_friction", 1, 1.1, 0.3)}));
  const Json rows = Json::array({row("moving_mass", 10, 13, 0.5)});
  EXPECT_TRUE(two_tests("last.json", verdict_of(last), verdict_of(result("fault", rows))).same_reference);
  const TwoTests other = two_tests("last.json", verdict_of(last), verdict_of(result("fault", rows, "another")));
  EXPECT_FALSE(other.same_reference);
  EXPECT_TRUE(other.rows.empty());
  EXPECT_NE(text_of(other).find("judged by another table"), std::string::npos) << text_of(other);
}

TEST(TwoTests, TextJsonAndPageSayTheSame) {
  Json last = result("fault", Json::array());
  last["results"][0]["fault"] = "sticky_spool";
  const Json now = result("healthy", Json::array({row("moving_mass", 10, 13, 0.5)}));
  const TwoTests t = two_tests("last.json", verdict_of(last), verdict_of(now));
  EXPECT_NE(text_of(t).find("last.json: gone: the last test showed sticky spool"), std::string::npos) << text_of(t);
  EXPECT_EQ(to_json(t)["change"], "mended");
  EXPECT_EQ(to_json(t)["verdict"], "fault");
  EXPECT_EQ(to_json(t)["parameters"].size(), 1u);
  Page page({}, "x");
  add_two_tests(page, t);
  const std::string html = page.html();
  for (const char* shown : {"sticky spool", "moving mass", "0.5 of 2", "+6"})
    EXPECT_NE(html.find(shown), std::string::npos) << shown;
}

TEST(TwoTests, TheWordOfALaterVersionIsWrittenAsItStands) {
  const TwoTests t = two_tests("last.json", verdict_of(result("of_a_later_version", Json::array())),
                               verdict_of(result("unknown", Json::array())));
  EXPECT_EQ(to_json(t)["verdict"], "of_a_later_version");
  EXPECT_EQ(words_of(t), "another finding than in the last test, of a later version");
}

TEST(LastTest, IsOneVerdictOrRefused) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    folder.write("last.json", text);
    try {
      store::read_one_verdict(folder / "last.json");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(result("healthy", Json::array()).dump()), "");
  EXPECT_NE(refusal("[]").find("is no result"), std::string::npos);
  EXPECT_NE(refusal(R"({"tool": "servodx", "command": "tune"})").find("no result of 'diagnose'"), std::string::npos);
  for (const char* results : {"[]", "[{}, {}]", "7", "[1]", "{\"a\": {}}"})
    EXPECT_NE(refusal(std::string(R"({"tool": "servodx", "command": "diagnose", "results": )") + results + "}")
                  .find("not one verdict"),
              std::string::npos)
        << results;
}

}  // namespace
}  // namespace servodx::report
