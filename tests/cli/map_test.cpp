// `servodx map`: the contract's columns, the pictures, and what is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "program.h"

namespace servodx {
namespace {

struct MapDesk : Desk {
  MapDesk() { write("table.csv", shipped_table()); }
};

TEST(Map, WritesTheContractsColumnsAndTheSameBytesAgain) {
  const MapDesk desk;
  const Ended ended = desk.run("map --model C5 --params table.csv -o map.csv --json map.json");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string bytes = bytes_of(desk / "map.csv");
  EXPECT_EQ(bytes.substr(0, bytes.find('\n')), "spool_position [mm],load_flow [l/min],load_pressure [MPa]");
  ASSERT_EQ(desk.run("map --model C5 --params table.csv -o again.csv").code, 0);
  EXPECT_EQ(bytes, bytes_of(desk / "again.csv"));
  // C5 in the file is C5 by the printed numbers.
  const auto json = nlohmann::json::parse(bytes_of(desk / "map.json"));
  const auto number = [&](const char* key) { return json["valve"][key]["value"].get<double>(); };
  const double p_sr = number("supply_differential"), x_ss = number("saturation_travel"), g_pq = number("gain_ratio");
  CsvCursor rows(bytes, "map.csv");
  long count = 0;
  while (rows.next_row()) {
    double x, q, p;
    rows.next_number(x), rows.next_number(q), rows.next_number(p);
    const double x_st = x * 1e-3 - q / 6e4 * g_pq * x_ss / p_sr;
    const double expected = x_st * p_sr / (std::max(std::abs(x_st), x_ss) + g_pq * number("leakage") * x_ss);
    ASSERT_NEAR(p * 1e6, expected, 1e-6 * p_sr);
    ++count;
  }
  EXPECT_GT(count, 1000);
  EXPECT_EQ(json["models"].size(), 8u);
}

TEST(Map, PaperIsTheSecondExampleOfSection4) {
  const MapDesk desk;
  ASSERT_EQ(desk.run("map --model C5 --params table.csv -o map.csv --paper --json map.json").code, 0);
  const auto valve = nlohmann::json::parse(bytes_of(desk / "map.json"))["valve"];
  const auto number = [&](const char* key) { return valve[key]["value"].get<double>(); };
  EXPECT_DOUBLE_EQ(number("supply_differential"), 20e6);
  EXPECT_NEAR(number("gain_ratio") * number("leakage"), 0.2, 1e-6);
  EXPECT_NEAR(number("pressure_gain") / number("null_slope"), 1.2, 1e-6);
}

TEST(Map, DrawsOneModelAtFallingSuppliesAndAllSideBySide) {
  const MapDesk desk;
  ASSERT_EQ(desk.run("map --model HF --params table.csv --svg one.svg").code, 0);
  ASSERT_EQ(desk.run("map --model all --params table.csv --svg all.svg --supply '100 bar'").code, 0);
  for (const char* picture : {"one.svg", "all.svg"}) {
    const std::string svg = bytes_of(desk / picture);
    EXPECT_TRUE(svg.starts_with("<svg")) << picture;
    EXPECT_NE(svg.find("<polyline"), std::string::npos) << picture;
  }
  EXPECT_NE(bytes_of(desk / "one.svg").find("P_SR 0.01 bar"), std::string::npos);
}

TEST(Map, RefusesWhatItDoesNotKnowAndWritesNothing) {
  const MapDesk desk;
  const auto before = desk.contents();
  for (const char* call :
       {"map --model D9 --params table.csv -o map.csv", "map --model all --params table.csv -o map.csv",
        "map --model C5 --params table.csv", "map --model C5 --params none.csv -o map.csv",
        "map --model C5 --params table.csv -o map.csv --supply '100 m'"}) {
    const Ended ended = desk.run(call);
    EXPECT_EQ(ended.code, 2) << call;
    EXPECT_FALSE(ended.err.empty()) << call;
  }
  EXPECT_EQ(desk.contents(), before);
}

}  // namespace
}  // namespace servodx
