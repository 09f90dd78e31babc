// `servodx curves`: a sheet with pass and fail, as text and JSON, and what is refused. And `simulate` on a test stand.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "program.h"
#include "signals/log.h"

namespace servodx {
namespace {

// A triangle of full current in 40 s, a hundred samples a second, and the flow of a straight valve.
std::string flow_log() {
  std::string text = "time [s],command [mA],control_flow [l/min]\n";
  for (int k = 0; k <= 5000; ++k) {
    const double turn = k / 4000.0 + 0.25, i = 20.4 * (1 - 4 * std::fabs(turn - std::floor(turn) - 0.5));
    append_number(text, 0.01 * k);
    text += ',';
    append_number(text, i);
    text += ',';
    append_number(text, 0.7 * (i - 0.2));
    text += '\n';
  }
  return text;
}

struct Stand : Desk {
  explicit Stand(const std::string& limits) {
    write("flow.csv", flow_log());
    write("table.csv", shipped_table());
    write("rig.toml", "ports = \"free\"\n[valve]\nrated_current = \"20 mA\"\n" + limits);
  }
};

TEST(Curves, PrintsFiguresWithLimitsAndAVerdict) {
  const Stand stand("[limits]\nrated_flow = \"13 l/min\"\nnull_bias = \"2 %\"\n");
  const Ended ended = stand.run("curves flow.csv --rig rig.toml --json sheet.json --svg sheet.svg");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("PASS"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("at least 13 l/min"), std::string::npos) << ended.out;
  const auto json = nlohmann::json::parse(bytes_of(stand / "sheet.json"));
  EXPECT_EQ(json["command"], "curves");
  EXPECT_EQ(json["verdict"], "pass");
  bool found = false;
  for (const auto& f : json["figures"])
    if (f["name"] == "rated_flow") {
      found = true;
      EXPECT_NEAR(f["value"].get<double>(), 14.0 / 6e4, 1e-6);
      EXPECT_EQ(f["unit"], "m3/s");
      EXPECT_EQ(f["pass"], true);
    }
  EXPECT_TRUE(found);
  EXPECT_TRUE(bytes_of(stand / "sheet.svg").starts_with("<svg"));
}

TEST(Curves, AFigureBeyondItsLimitFails) {
  const Stand stand("[limits]\nnull_bias = { max = \"0.5 %\" }\n");
  const Ended ended = stand.run("curves flow.csv --rig rig.toml");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("FAIL"), std::string::npos) << ended.out;
}

TEST(Curves, LimitsThatTheLogDoesNotShowStandInTheHeadlineAndTheTables) {
  const Stand stand(
      "[limits]\nrated_flow = \"13 l/min\"\nnull_bias = \"2 %\"\npressure_gain = \"30 %\"\nnull_leakage = \"1 "
      "l/min\"\n");
  stand.write("sheet.toml", "date = \"2026-11-25\"\n");
  const Ended ended =
      stand.run("curves flow.csv --rig rig.toml --json sheet.json --report page.html --certificate sheet.toml");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string page = bytes_of(stand / "page.html");
  for (const std::string& text : {ended.out, page}) {
    EXPECT_NE(text.find("INCOMPLETE"), std::string::npos) << ended.out;
    EXPECT_NE(text.find("2 of 4 limits kept; 2 not shown by this log"), std::string::npos) << ended.out;
    EXPECT_NE(text.find("not judged"), std::string::npos) << ended.out;
  }
  EXPECT_EQ(ended.out.find("PASS"), std::string::npos) << ended.out;
  const auto json = nlohmann::json::parse(bytes_of(stand / "sheet.json"));
  EXPECT_EQ(json["verdict"], "incomplete");
  int hidden = 0;
  for (const auto& f : json["figures"])
    if (!f["limit"].is_null() && f["judgement"] == "not_judged") {
      ++hidden;
      EXPECT_TRUE(f["value"].is_null() && f["pass"].is_null()) << f;
    }
  EXPECT_EQ(hidden, 2);
}

TEST(Curves, RefusesUnknownLimitsAndLogsWithoutFigures) {
  for (const char* limits :
       {"[limits]\nhysterese = \"4 %\"\n", "[limits]\nhysteresis = \"4 bar\"\n",
        "[limits]\nhysteresis = { most = \"4 %\" }\n", "[limits]\nhysteresis = { min = \"4 %\", max = \"3 %\" }\n"}) {
    const Stand stand(limits);
    const Ended ended = stand.run("curves flow.csv --rig rig.toml");
    EXPECT_EQ(ended.code, 2) << limits;
    EXPECT_NE(ended.err.find("rig.toml:5"), std::string::npos) << ended.err;
  }
  const Stand stand("");
  EXPECT_EQ(stand.run("curves flow.csv").code, 2);  // no rated current
}

TEST(Simulate, AcceptsALogOfATestStand) {
  const Stand stand("");
  const Ended ended = stand.run("simulate flow.csv --params table.csv --rig rig.toml -o sim.csv");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Log sim = read_log(stand / "sim.csv", {}, {.require_drive = false});
  ASSERT_TRUE(sim.has(Signal::control_flow));
  EXPECT_EQ(sim.channels[index(Signal::control_flow)].unit, "l/min");
  EXPECT_NEAR(sim[Signal::control_flow][960] * 6e4, 14, 1.5);  // 19.6 mA
}

}  // namespace
}  // namespace servodx
