// A log from memory is the log that a file of the same numbers is.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/fingerprint.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

std::vector<LogColumn> columns() {
  std::vector<LogColumn> c = {{"time [ms]", {}}, {"command [mA]", {}}, {"Pos fb", {}}, {"remark", {}}};
  for (int k = 0; k < 40; ++k) {
    c[0].values.push_back(k);
    c[1].values.push_back(k % 7 - 3);
    c[2].values.push_back(0.01 * ((k * 5) % 11));
    c[3].values.push_back(k);
  }
  return c;
}

RigFile rig() {
  RigFile r;
  r.columns["Pos fb"] = {
      .signal = "spool_position", .column_unit = "V", .unit = "mm", .gain = 1e-4, .gain_has_unit = true};
  return r;
}

TEST(MemoryLog, EqualsTheLogOfAFileToTheLastBit) {
  const TemporaryFolder folder;
  std::string text;
  const auto c = columns();
  for (std::size_t i = 0; i < c.size(); ++i) text += (i ? "," : "") + c[i].name;
  for (std::size_t k = 0; k < c[0].values.size(); ++k) {
    text += "\n";
    for (std::size_t i = 0; i < c.size(); ++i) text += fmt::format("{}{}", i ? "," : "", c[i].values[k]);
  }
  const Log file = read_log(folder.write("log.csv", text + "\n"), rig());
  const Log memory = make_log("bench run 7", c, rig());
  EXPECT_EQ(memory.time, file.time);
  for (int s = 0; s < n_signals; ++s) {
    EXPECT_EQ(memory.channels[s].value, file.channels[s].value);
    EXPECT_EQ(memory.channels[s].unit, file.channels[s].unit);
    EXPECT_EQ(memory.channels[s].resolution, file.channels[s].resolution);
  }
  EXPECT_EQ(memory.path, "bench run 7");
  EXPECT_EQ(memory.notes.size(), file.notes.size());
}

TEST(MemoryLog, IsTheSameLogByItsBytesOrItsSamples) {
  EXPECT_TRUE(is_same_log({"bytes", ""}, {"bytes", "samples"}));
  EXPECT_TRUE(is_same_log({"", "samples"}, {"bytes", "samples"}));
  EXPECT_FALSE(is_same_log({"bytes", "samples"}, {"others", "other"}));
  EXPECT_FALSE(is_same_log({}, {})) << "nothing is known of either";
}

void expect_refused(const std::vector<LogColumn>& c, const std::string& rule) {
  try {
    make_log("run", c, rig());
    FAIL() << "taken, though " << rule;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(rule), std::string::npos) << error.what();
    EXPECT_EQ(error.where.file, "run");
  }
}

TEST(MemoryLog, WhatAFileWouldBeRefusedForIsRefused) {
  auto shorter = columns();
  shorter[1].values.pop_back();
  expect_refused(shorter, "has 39 samples, the time has 40");
  auto back = columns();
  back[0].values[20] = 3;
  expect_refused(back, "sample 21");
  auto infinite = columns();
  infinite[1].values[4] = HUGE_VAL;
  expect_refused(infinite, "is infinite");
  auto no_unit = columns();
  no_unit[1].name = "command";
  expect_refused(no_unit, "unit");
  expect_refused({columns()[1], columns()[2]}, "time");
}

}  // namespace
}  // namespace servodx
