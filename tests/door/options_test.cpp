// Options of the front door are refused before any work, and named as the program calls them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "servodx/servodx.h"

namespace servodx {
namespace {

// What stands where a file's name would.
template <class Options>
std::string refused(const std::function<void(Options&)>& change) {
  Options options;
  EXPECT_NO_THROW(options.validate());
  change(options);
  try {
    options.validate();
  } catch (const InputError& error) {
    EXPECT_FALSE(error.rule.empty());
    EXPECT_FALSE(error.mend.empty());
    return error.where.file;
  }
  return "";
}

TEST(Options, OfATuneAreRefusedByName) {
  const auto of = refused<TuneOptions>;
  EXPECT_EQ(of([](auto& o) { o.population = 3; }), "--population");
  EXPECT_EQ(of([](auto& o) { o.generations = -1; }), "--generations");
  EXPECT_EQ(of([](auto& o) { o.rounds = 0; }), "--rounds");
  EXPECT_EQ(of([](auto& o) { o.heldout = 1; }), "--heldout");
  EXPECT_EQ(of([](auto& o) { o.moving_average = 2; }), "--moving-average");
  EXPECT_EQ(of([](auto& o) { o.threads = -1; }), "--threads");
  EXPECT_EQ(of([](auto& o) { o.priors["port_width"] = 0; }), "--prior");
  EXPECT_EQ(of([](auto& o) { o.priors["no_such_row"] = 1; }), "--prior");
  EXPECT_EQ(of([](auto& o) { o.priors["stiction_force"] = 1; }), "") << "a row, of an effect";
  EXPECT_EQ(of([](auto& o) { o.profile = {"port_width", "no_such_row"}; }), "--profile");
  EXPECT_EQ(of([](auto& o) { o.profile = {"all", "port_width", "stiction_force"}; }), "");
  EXPECT_EQ(of([](auto& o) { o.effects = {"no_such_effect"}; }), "--effects");
  EXPECT_EQ(of([](auto& o) { o.resume = true; }), "--resume");
}

TEST(Options, OfTheOtherCallsAreRefusedByName) {
  EXPECT_EQ(refused<BaselineOptions>([](auto& o) { o.false_alarm = 0; }), "--false-alarm");
  EXPECT_EQ(refused<BaselineOptions>([](auto& o) { o.threads = -1; }), "--threads");
  EXPECT_EQ(refused<DiagnoseOptions>([](auto& o) { o.threads = -1; }), "DiagnoseOptions.threads");
  EXPECT_EQ(refused<DiagnoseOptions>([](auto& o) { o.population = 1; }), "DiagnoseOptions.population");
  EXPECT_EQ(refused<DiagnoseOptions>([](auto& o) { o.actions.erase("unknown"); }), "DiagnoseOptions.actions");
  EXPECT_EQ(refused<SelftestOptions>([](auto& o) { o.threads = -1; }), "--threads");
  EXPECT_EQ(refused<ExplainOptions>([](auto& o) { o.threads = -1; }), "--threads");
  EXPECT_EQ(refused<ExplainOptions>([](auto& o) { o.level = 1; }), "ExplainOptions.level");
  EXPECT_EQ(refused<ExplainOptions>([](auto& o) { o.without = {"no_such_effect"}; }), "--without");
  EXPECT_EQ(refused<CheckOptions>([](auto& o) { o.model = "no_such_model"; }), "--model");
  EXPECT_EQ(refused<CheckOptions>([](auto& o) { o.last = {1}; }), "CheckOptions.last");
  EXPECT_EQ(refused<CheckOptions>([](auto& o) { o.threads = -1; }), "--threads");
  EXPECT_EQ(refused<TrendOptions>([](auto& o) { o.false_alarm = 0.5; }), "--false-alarm");
  EXPECT_EQ(refused<TrendOptions>([](auto& o) { o.healthy = 4; }), "--healthy");
  EXPECT_EQ(refused<TrendOptions>([](auto& o) { o.coverage = 1; }), "--coverage");
  EXPECT_EQ(refused<TrendOptions>([](auto& o) { o.failures = {{"no_such_check"}}; }), "--failure");
  EXPECT_EQ(refused<TrendOptions>([](auto& o) { o.limits = {{"no_such_check"}}; }), "TrendOptions.limits");
  EXPECT_EQ(refused<TrendOptions>([](auto& o) { o.limits = {{.check = "fidelity", .value = std::nan("")}}; }),
            "TrendOptions.limits");
  EXPECT_EQ(refused<SimulationOptions>([](auto& o) { o.step = 0; }), "--step");
  EXPECT_EQ(refused<SimulationOptions>([](auto& o) { o.step = 1e-4, o.reference = true; }), "--reference");
  EXPECT_EQ(refused<MonitorOptions>([](auto& o) { o.model = "no_such_model"; }), "--model");
  for (double gain : {0.0, -1.8, HUGE_VAL, std::nan("")})
    EXPECT_EQ(refused<MonitorOptions>([&](auto& o) { o.loop_gain = gain; }), "--loop-gain") << gain;
  EXPECT_EQ(refused<JoinOptions>([](auto& o) { o.by = Signal::time; }), "--by");
  EXPECT_EQ(refused<JoinOptions>([](auto& o) { o.near = std::nan(""); }), "--near");
  EXPECT_EQ(refused<JoinOptions>([](auto& o) { o.near_within = 0; }), "JoinOptions.near_within");
  EXPECT_EQ(refused<ReadOptions>([](auto& o) { o.minimum_rows = 1; }), "ReadOptions.minimum_rows");
  for (double size : {-1.0, HUGE_VAL, std::nan("")}) {
    EXPECT_EQ(refused<SheetOptions>([&](auto& o) { o.guard = size; }), "SheetOptions.guard") << size;
    EXPECT_EQ(refused<SheetOptions>([&](auto& o) {
                o.instruments = {{Signal::flow_a, size, 0}};
              }),
              "SheetOptions.instruments")
        << size;
    EXPECT_EQ(refused<SheetOptions>([&](auto& o) {
                o.instruments = {{Signal::flow_a, 0, size}};
              }),
              "SheetOptions.instruments")
        << size;
  }
}

// A wrong option costs no fit: there is no log here that one could be made to.
TEST(Options, AreLookedAtBeforeTheLogs) {
  const auto refused_at = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.where.file;
    }
    return "";
  };
  EXPECT_EQ(refused_at([] { tune({}, {}, {}, {.rounds = 0}); }), "--rounds");
  EXPECT_EQ(refused_at([] { tune({}, {}, {}, {.priors = {{"no_such_row", 1}}}); }), "--prior");
  EXPECT_EQ(refused_at([] { tune({}, {}, {}, {.profile = {"no_such_row"}}); }), "--profile");
  EXPECT_EQ(refused_at([] { make_baseline({}, {}, {}, {.false_alarm = 2}); }), "--false-alarm");
  EXPECT_EQ(refused_at([] { diagnose({}, {}, {}, {}, {.threads = -1}); }), "DiagnoseOptions.threads");
  EXPECT_EQ(refused_at([] { explain({}, {}, {}, {.threads = -1}); }), "--threads");
  EXPECT_EQ(refused_at([] { check({}, {}, {}, {.threads = -1}); }), "--threads");
  EXPECT_EQ(refused_at([] { simulate({}, {}, {}, {.threads = -1}); }), "--threads");
  EXPECT_EQ(refused_at([] { LogMonitor({}, {}, {}, {.model = "no_such_model"}); }), "--model");
  EXPECT_EQ(refused_at([] { acceptance_sheet({}, {}, {.guard = -1}); }), "SheetOptions.guard");
  ClockFit clock;
  EXPECT_EQ(refused_at([&] { join_recorders({}, {}, {.near_within = 0}, clock); }), "JoinOptions.near_within");
  EXPECT_EQ(refused_at([] { read_log("nowhere.csv", {}, {.minimum_rows = 0}); }), "ReadOptions.minimum_rows");
  EXPECT_EQ(refused_at([] { make_log("nothing", {}, {}, {.minimum_rows = 0}); }), "ReadOptions.minimum_rows");
  EXPECT_EQ(refused_at([] { diagnose_each({}, {}, {}, {}, {.threads = -1}); }), "DiagnoseOptions.threads");
  EXPECT_EQ(refused_at([] { likeliest_miss({}, {}, {}, {.threads = -1}); }), "--threads");
  EXPECT_EQ(refused_at([] { steps_of({.step = 0}); }), "--step");
  EXPECT_EQ(refused_at([] { selftest({}, {}, {}, {.threads = -1}); }), "--threads");
  EXPECT_EQ(refused_at([] { drive_rows({}, {}, {}, -1); }), "--threads");
  EXPECT_EQ(refused_at([] { promise_of({}, {}, {}, -1); }), "--threads");
  EXPECT_EQ(refused_at([] { failure_levels({"gain=0.5", "no_such_limit=1"}, {}); }), "--limit");
  EXPECT_EQ(refused_at([] { MapExtent{.travel = 1e-4, .flow = 1e-4, .travels = 4}.validate(); }), "MapExtent.travels");
  EXPECT_EQ(refused_at([] { MapExtent{.travel = 0, .flow = 1e-4}.validate(); }), "--travel");
}

// A log that no fit can learn from is refused too, and after the options.
TEST(Options, AreLookedAtBeforeTheSamplesOfACheck) {
  Log slow;
  slow.time = {0, 1, 2};
  for (const Signal s : {Signal::command, Signal::piston_position}) slow.channels[index(s)].value = {0, 0, 0};
  const auto refused_at = [&](const CheckOptions& options) -> std::string {
    try {
      check(slow, {}, {}, options);
    } catch (const InputError& error) {
      return error.where.file + error.where.column;
    }
    return "";
  };
  EXPECT_EQ(refused_at({}), "time");
  EXPECT_EQ(refused_at({.threads = -1}), "--threads");
}

}  // namespace
}  // namespace servodx
