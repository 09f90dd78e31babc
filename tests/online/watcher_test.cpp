// The watch of a valve whose equations are the model's own: alarms in time, with the right name, and none else.
#include "online/watcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/random.h"
#include "faults/gross_finding.h"
#include "online/alarm_limits.h"
#include "online/constants.h"
#include "online/sudden.h"
#include "online/watched_model.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "signals/sample.h"
#include "twin.h"

namespace servodx {
namespace {

namespace k = online_constants;

const WatchLimits& limits(bool current) {
  static const WatchLimits both[] = {
      learn_limits({log_of("healthy", twin::samples(6, {}, false, 11))}, twin::model(), 0.1),
      learn_limits({log_of("healthy", twin::samples(6, {}, true, 12))}, twin::model(), 0.1)};
  return both[current];
}

std::vector<WatchEvent> watched(const std::vector<Sample>& samples, bool current = false) {
  Watcher watcher(twin::model(), limits(current), twin::recorded(current));
  std::vector<WatchEvent> events;
  for (const Sample& s : samples) watcher.take(s, events);
  watcher.flush(events);
  return events;
}

long count(const std::vector<WatchEvent>& events, WatchEventKind kind) {
  return std::count_if(events.begin(), events.end(), [&](const WatchEvent& e) { return e.kind == kind; });
}

std::vector<Sample> with_losses(std::vector<Sample> samples) {
  Random random(5);
  std::vector<Sample> out;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (random.uniform() < 0.01) continue;  // lost
    out.push_back(samples[i]);
    if (random.uniform() < 0.01) out.push_back(samples[i]);                                              // repeated
    if (out.size() > 1 && random.uniform() < 0.01) std::swap(out[out.size() - 1], out[out.size() - 2]);  // late
  }
  return out;
}

TEST(Watcher, AHealthyValveRaisesNoAlarm) {
  const auto events = watched(twin::samples(10, {}, false, 3));
  EXPECT_EQ(count(events, WatchEventKind::alarm), 0);
  EXPECT_EQ(count(events, WatchEventKind::restart), 0);
}

TEST(Watcher, LostLateAndRepeatedSamplesRaiseNoAlarmAndHideNone) {
  EXPECT_EQ(count(watched(with_losses(twin::samples(10, {}, false, 4))), WatchEventKind::alarm), 0);
  const auto events = watched(with_losses(twin::samples(4, {"feedback_wire_lost", 0.0, 2.0})));
  ASSERT_EQ(count(events, WatchEventKind::alarm), 1);
}

struct Case {
  twin::Failure failure;
  bool current;
  const char* label;
};

TEST(Watcher, ASuddenFailureIsAnAlarmWithin20MillisecondsWithItsName) {
  for (const Case& c : {Case{{"feedback_wire_lost", 0.0, 2.0}, false, "feedback_wire_lost"},
                        Case{{"plugged_nozzle", 0.95, 2.0}, false, "plugged_nozzle"},
                        Case{{"sticky_spool", 1000.0, 2.0}, false, "sticky_spool"},
                        Case{{"open_coil", 0.0, 2.0}, true, "driver_fault"}}) {
    const auto events = watched(twin::samples(3.5, c.failure, c.current), c.current);
    const auto alarm =
        std::find_if(events.begin(), events.end(), [](const WatchEvent& e) { return e.kind == WatchEventKind::alarm; });
    ASSERT_NE(alarm, events.end()) << c.label;
    EXPECT_GE(alarm->time, 2.0) << c.label;
    EXPECT_LE(alarm->told_at, 2.0 + 0.020) << c.label;
    std::string name;
    for (const WatchEvent& e : events)
      if (e.kind == WatchEventKind::alarm || e.kind == WatchEventKind::named) name = e.name;
    EXPECT_EQ(name, c.label);
    EXPECT_EQ(count(events, WatchEventKind::window), 1) << c.label;
  }
}

TEST(Watcher, ASavedStateGivesTheEventsThatWouldHaveBeen) {
  const auto samples = twin::samples(4, {"feedback_wire_lost", 0.0, 2.0});
  const auto whole = watched(samples);
  for (std::size_t cut : {std::size_t{1500}, std::size_t{2050}}) {
    std::vector<WatchEvent> events;
    Watcher first(twin::model(), limits(false), twin::recorded());
    for (std::size_t i = 0; i < cut; ++i) first.take(samples[i], events);
    const std::string saved = first.state().dump();
    Watcher second(twin::model(), limits(false), twin::recorded());
    second.resume(nlohmann::json::parse(saved));
    for (const Sample& s : samples) s.time <= first.time() ? second.remember(s) : second.take(s, events);
    second.flush(events);
    ASSERT_EQ(events.size(), whole.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
      EXPECT_EQ(events[i].number, whole[i].number);
      EXPECT_EQ(events[i].kind, whole[i].kind);
      EXPECT_EQ(events[i].time, whole[i].time);
      EXPECT_EQ(events[i].level, whole[i].level);
      EXPECT_EQ(events[i].name, whole[i].name);
    }
  }
  Watcher other(twin::model(), limits(false), twin::recorded());
  EXPECT_THROW(other.resume(nlohmann::json::object()), InputError);
}

TEST(Watcher, AStateWithASignalOrFindingThatThereIsNotIsRefused) {
  const auto samples = twin::samples(3, {"feedback_wire_lost", 0.0, 2.0});
  Watcher first(twin::model(), limits(false), twin::recorded());
  std::vector<WatchEvent> events;
  nlohmann::json state;
  for (std::size_t i = 0; i < samples.size() && (!state.is_object() || state["alarm"].is_null()); ++i) {
    first.take(samples[i], events);
    if (i > 1990) state = first.state();
  }
  ASSERT_TRUE(state["alarm"].is_object());
  for (const char* key : {"signal", "gross"})
    for (const double wrong : {-7.0, 1000.0, 1e300}) {
      nlohmann::json damaged = state;
      damaged["alarm"][key] = wrong;
      Watcher watcher(twin::model(), limits(false), twin::recorded());
      EXPECT_THROW(watcher.resume(damaged), InputError) << key << " " << wrong;
    }
}

// A record that needs no model: the twin's own run does not know of it.
std::vector<Sample> with_supply(std::vector<Sample> samples, double from, double to, double at) {
  for (Sample& s : samples) s[Signal::supply_pressure] = s.time < at ? from : to;
  return samples;
}

TEST(Watcher, AMeasuredSupplyThatLeavesItsBandIsAnAlarmAtOnce) {
  constexpr double bar = 1e5;
  auto recorded = twin::recorded(false);
  recorded.push_back(Signal::supply_pressure);
  const WatchLimits known = learn_limits(
      {log_of("healthy", with_supply(twin::samples(4, {}, false, 11), 207 * bar, 200 * bar, 3.0))}, twin::model(), 0.1);
  ASSERT_TRUE(known.supply.has_value());
  EXPECT_NEAR(known.supply->limit, 20.7 * bar, 0.2 * bar);
  for (const auto& [pressure, alarms] : {std::pair{190 * bar, 0L}, {170 * bar, 1L}, {240 * bar, 1L}}) {
    Watcher watcher(twin::model(), known, recorded);
    std::vector<WatchEvent> events;
    // The simulation's channels are left out: a supply that moves shows in them too.
    for (Sample s : with_supply(twin::samples(3), 207 * bar, pressure, 2.0)) {
      for (Signal other : {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b})
        if (s.time > 1.9) s[other] = std::nan("");
      watcher.take(s, events);
    }
    watcher.flush(events);
    ASSERT_EQ(count(events, WatchEventKind::alarm), alarms) << pressure;
    if (alarms == 0) continue;
    EXPECT_TRUE(events.front().supply);
    EXPECT_EQ(events.front().name, "supply_fault");
    EXPECT_LE(events.front().told_at, 2.0 + 0.07);
  }
}

TEST(Watcher, WhatIsKeptDoesNotGrow) {
  Watcher watcher(twin::model(), limits(false), twin::recorded());
  std::vector<WatchEvent> events;
  for (const Sample& s : twin::samples(12)) {
    watcher.take(s, events);
    ASSERT_LE(watcher.window().size(), static_cast<std::size_t>(k::kept * 1e3) + 2);
  }
}

TEST(Watcher, ALongGapBeginsTheSimulationAnew) {
  auto samples = twin::samples(3);
  std::erase_if(samples, [](const Sample& s) { return s.time > 1 && s.time < 1.6; });
  const auto events = watched(samples);
  EXPECT_EQ(count(events, WatchEventKind::restart), 1);
  EXPECT_EQ(count(events, WatchEventKind::alarm), 0);
}

TEST(Watcher, AClockSetBackBeginsAnewAndRaisesNoAlarm) {
  auto samples = twin::samples(2), again = twin::samples(2, {}, false, 9);
  samples.insert(samples.end(), again.begin(), again.end());
  const auto events = watched(samples);
  EXPECT_EQ(count(events, WatchEventKind::restart), 1);
  EXPECT_EQ(count(events, WatchEventKind::alarm), 0);
}

TEST(Watcher, ARarerAlarmHasAHigherLimit) {
  const std::vector<Log> healthy = {log_of("healthy", twin::samples(6, {}, false, 11))};
  const WatchLimits often = learn_limits(healthy, twin::model(), 10),
                    seldom = learn_limits(healthy, twin::model(), 0.01);
  for (const auto& [signal, c] : often.channels)
    for (std::size_t w = 0; w < c.limit.size(); ++w) {
      EXPECT_LE(c.limit[w], seldom.channels.at(signal).limit[w]);
      EXPECT_GE(c.limit[w], k::beyond_healthy * c.healthy[w]);
    }
}

// The rule alone, of made-up evidence.
TEST(Sudden, TheDriversRecordAndWhatIsSeenOutrightGoBeforeTheRuns) {
  const SuddenEvidence runs{.scores = {{"plugged_nozzle", 1, 0.9}, {"", 5, 0}}};
  EXPECT_EQ(name_of(runs), "plugged_nozzle");
  SuddenEvidence driver = runs;
  driver.driver = true;
  EXPECT_EQ(name_of(driver), "driver_fault");
  SuddenEvidence both_stops = runs;
  both_stops.gross = GrossFinding::spool_on_both_stops;
  EXPECT_EQ(name_of(both_stops), "feedback_wire_lost");
  EXPECT_EQ(name_of(SuddenEvidence{}), "");
}

}  // namespace
}  // namespace servodx
