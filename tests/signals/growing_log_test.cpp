// A log that grows gives the samples of the whole log, in whatever pieces its bytes come.
#include "signals/growing_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/csv.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "signals/sample.h"
#include "signals/signal.h"

namespace servodx {
namespace {

struct Taken {
  std::vector<Sample> samples;
  std::vector<std::uint64_t> ends;
  long bad = 0;
};

Taken take(const std::string& text, std::size_t piece, const RigFile& rig) {
  GrowingLog log("log.csv", rig);
  Taken out;
  const auto keep = [&](const Sample& s, std::uint64_t end) { out.samples.push_back(s), out.ends.push_back(end); };
  for (std::size_t at = 0; at < text.size(); at += piece) log.feed(std::string_view(text).substr(at, piece), keep);
  log.end(keep);
  out.bad = log.bad_lines();
  return out;
}

void expect_same(const std::vector<Sample>& samples, const Log& log) {
  ASSERT_EQ(samples.size(), log.samples());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ASSERT_EQ(samples[k].time, log.time[k]);
    for (const SignalInfo& s : signal_list) {
      if (s.signal == Signal::time) continue;
      const double x = samples[k][s.signal];
      if (!log.has(s.signal) || std::isnan(log[s.signal][k]))
        ASSERT_TRUE(std::isnan(x)) << s.name;
      else
        ASSERT_EQ(x, log[s.signal][k]) << s.name;
    }
  }
}

TEST(GrowingLog, BelowRowsOfTextOrNamesBehindAHashAreTheSamplesOfTheWholeLog) {
  const std::string numbers = "0,1.5,2\n1,2.5,3\n2,1.5,4\n";
  for (const char* const head : {"time,command,spool_position\nclock,CH 1,CH 2\nms,mA,mm\n",
                                 "time,command,spool_position\nms,mA,mm\nOffset,0,0\n",
                                 "# run 7\n# time [ms],command [mA],spool_position [mm]\n"}) {
    const RigFile rig;
    const Taken taken = take(head + numbers, 7, rig);
    ASSERT_EQ(taken.samples.size(), 3u) << head;
    EXPECT_EQ(taken.samples[1][Signal::command], 2.5e-3) << head;
    EXPECT_EQ(taken.bad, 0) << head;
    // What is kept of the head is enough to go on.
    GrowingLog first("log.csv", rig), next("log.csv", rig);
    first.feed(head + numbers, [](const Sample&, std::uint64_t) {});
    next.begin_with(first.head(), 0);
    EXPECT_EQ(next.unit_of(Signal::command), "mA") << head;
  }
}

TEST(GrowingLog, AnyPiecesGiveTheSamplesOfTheWholeLog) {
  const struct {
    const char *log, *rig;
  } logs[] = {{"data/healthy/h10_flight.csv", "data/rig.toml"},
              {"data/tutorial/good_1.csv", "data/tutorial/bench.toml"}};
  for (const auto& [path, rig_path] : logs) {
    const RigFile rig = read_rig_file(shipped(rig_path));
    const Log whole = read_log(shipped(path), rig);
    const std::string text = read_file(shipped(path));
    for (std::size_t piece : {std::size_t{7}, std::size_t{4096}, text.size()}) {
      const Taken taken = take(text, piece, rig);
      expect_same(taken.samples, whole);
      EXPECT_EQ(taken.bad, 0);
      EXPECT_EQ(taken.ends.back(), text.size());
    }
  }
}

constexpr const char* head = "time [s],command [mA],spool_position [mm]\n";

TEST(GrowingLog, ALineThatIsNoSampleIsCountedAndPassedOver) {
  const Taken taken = take(std::string(head) + "0,1,2\n0.001,1\n0.002,x,2\n,1,2\n0.003,1,2,3\n\n0.004,,3\n", 5, {});
  ASSERT_EQ(taken.samples.size(), 2u);
  EXPECT_EQ(taken.bad, 4);
  EXPECT_EQ(taken.samples[1].time, 0.004);
  EXPECT_TRUE(std::isnan(taken.samples[1][Signal::command]));
  EXPECT_DOUBLE_EQ(taken.samples[1][Signal::spool_position], 3e-3);
}

TEST(GrowingLog, AUnitsRowIsNoSample) {
  const Taken taken = take("time,command,spool_position\ns,mA,mm\n0,1,2\n0.001,1,2\n", 3, {});
  ASSERT_EQ(taken.samples.size(), 2u);
  EXPECT_DOUBLE_EQ(taken.samples[0][Signal::command], 1e-3);
}

TEST(GrowingLog, LinesAboveTheHeaderAreNoSamples) {
  const Taken taken = take(
      "LabVIEW Measurement\nSeparator\tTab\n***End_of_Header***\n\ntime\tcommand\tspool_position\tComment\n"
      "s\tmA\tmm\n0,0\t1\t0,5\n0,001\t2\t0,6\tnote\n",
      9, {});
  ASSERT_EQ(taken.samples.size(), 2u);
  EXPECT_EQ(taken.bad, 0);
  EXPECT_DOUBLE_EQ(taken.samples[1][Signal::spool_position], 0.6e-3);
}

TEST(GrowingLog, NamesTakeTheirGroupsFromTheRowAbove) {
  RigFile rig;
  rig.columns["Valve Weg"].signal = "spool_position";
  rig.columns["Valve Weg"].column_unit = "mm";
  const std::string text = ";Valve;Valve;Piston\ntime [s];command [mA];Weg;Weg\n0;1;0,5;2\n0,001;2;0,6;3\n";
  const Taken taken = take(text, 9, rig);
  ASSERT_EQ(taken.samples.size(), 2u);
  EXPECT_DOUBLE_EQ(taken.samples[1][Signal::spool_position], 0.6e-3);
}

TEST(GrowingLog, TimeStampsCountFromTheFirstRowAfterARestartToo) {
  const std::string text =
      "command [mA],time,spool_position [mm]\n1,2021-03-04 10:11:12.000,2\n1,2021-03-04 10:11:12.001,2\n";
  const Taken taken = take(text, 11, {});
  ASSERT_EQ(taken.samples.size(), 2u);
  EXPECT_DOUBLE_EQ(taken.samples[1].time, 1e-3);
  const RigFile rig;
  GrowingLog first("log.csv", rig), second("log.csv", rig);
  first.feed(text, [](const Sample&, std::uint64_t) {});
  second.begin_with(first.head(), text.size());
  std::vector<Sample> samples;
  second.feed("1,2021-03-04 10:11:13.000,2\n0,5,2\n", [&](const Sample& s, std::uint64_t) { samples.push_back(s); });
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_DOUBLE_EQ(samples[0].time, 1.0);
  EXPECT_EQ(second.bad_lines(), 1);
}

TEST(GrowingLog, WhatIsNoTextOrHasNoHeaderIsRefused) {
  EXPECT_THROW(take(std::string("TDSm") + std::string(100, '\0') + "\n1,2\n", 50, {}), InputError);
  EXPECT_THROW(take("0,1,2\n1,1,2\n", 50, {}), InputError);
}

TEST(GrowingLog, AHeaderWithoutADriveIsRefused) {
  EXPECT_THROW(take("time [s],spool_position [mm]\n0,1\n", 100, {}), InputError);
}

TEST(GrowingLog, AHeaderThatWasReadBeforeServesLaterLines) {
  const RigFile rig;
  GrowingLog first("log.csv", rig), second("log.csv", rig);
  std::uint64_t end = 0;
  first.feed(std::string(head) + "0,1,2\n", [&](const Sample&, std::uint64_t at) { end = at; });
  second.begin_with(first.head(), end);
  std::vector<Sample> samples;
  second.feed("0.001,1,2\n", [&](const Sample& s, std::uint64_t at) { samples.push_back(s), end = at; });
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].time, 0.001);
  EXPECT_EQ(end, std::string(head).size() + 16);
}

}  // namespace
}  // namespace servodx
