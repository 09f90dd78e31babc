// `servodx sensitivity`: the GA paper's table as text, JSON and a page with its tornado plot, and what is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace servodx {
namespace {

struct SensitivityDesk : Desk {
  SensitivityDesk() {
    write("table.csv", shipped_table());
    write("log.csv", excerpt("healthy/h12_mixed.csv", 300));
  }
};

TEST(Sensitivity, RanksAllRowsInTextJsonAndATornadoPlot) {
  const SensitivityDesk desk;
  const Ended ended = desk.run("sensitivity log.csv --params table.csv --json s.json --report s.html --quiet");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("valve_glitch"), std::string::npos);
  EXPECT_NE(ended.out.find("held"), std::string::npos);
  const auto json = nlohmann::json::parse(bytes_of(desk / "s.json"));
  ASSERT_EQ(json["rows"].size(), 41u);
  double last = json["rows"][0]["effect"].get<double>();
  for (std::size_t j = 0; j < 41; ++j) {
    const auto& row = json["rows"][j];
    EXPECT_EQ(row["rank"], j + 1);
    if (row["effect"].is_null()) continue;
    EXPECT_LE(row["effect"].get<double>(), last);
    last = row["effect"].get<double>();
  }
  EXPECT_EQ(json["simulations"], 83);
  const std::string page = bytes_of(desk / "s.html");
  EXPECT_NE(page.find("Effect of each row"), std::string::npos);
  EXPECT_NE(page.find("class=\"bar two\""), std::string::npos);
  EXPECT_NE(page.find("right:50%;width:"), std::string::npos);
}

TEST(Sensitivity, IsTheSameAtAnyNumberOfThreads) {
  const SensitivityDesk desk;
  const Ended one = desk.run("sensitivity log.csv --params table.csv --threads 1 --quiet"),
              two = desk.run("sensitivity log.csv --params table.csv --threads 2 --quiet");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(one.out, two.out);
}

TEST(Sensitivity, RefusesWhatItCannotRead) {
  const SensitivityDesk desk;
  for (const char* call : {"sensitivity log.csv --params none.csv", "sensitivity none.csv --params table.csv",
                           "sensitivity log.csv log.csv --params table.csv"}) {
    const Ended ended = desk.run(call);
    EXPECT_EQ(ended.code, 2) << call;
    EXPECT_FALSE(ended.err.empty()) << call;
  }
}

}  // namespace
}  // namespace servodx
