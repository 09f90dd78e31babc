// Options of the front door are refused before any work, and named as the program calls them.
#include <gtest/gtest.h>

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
  EXPECT_EQ(of([](auto& o) { o.effects = {"no_such_effect"}; }), "--effects");
  EXPECT_EQ(of([](auto& o) { o.resume = true; }), "--resume");
}

TEST(Options, OfTheOtherCallsAreRefusedByName) {
  EXPECT_EQ(refused<BaselineOptions>([](auto& o) { o.false_alarm = 0; }), "--false-alarm");
  EXPECT_EQ(refused<BaselineOptions>([](auto& o) { o.threads = -1; }), "--threads");
  EXPECT_EQ(refused<DiagnoseOptions>([](auto& o) { o.threads = -1; }), "DiagnoseOptions.threads");
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
  EXPECT_EQ(refused<SimulationOptions>([](auto& o) { o.step = 0; }), "--step");
  EXPECT_EQ(refused<SimulationOptions>([](auto& o) { o.step = 1e-4, o.reference = true; }), "--reference");
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
  EXPECT_EQ(refused_at([] { make_baseline({}, {}, {}, {.false_alarm = 2}); }), "--false-alarm");
  EXPECT_EQ(refused_at([] { diagnose({}, {}, {}, {}, {.threads = -1}); }), "DiagnoseOptions.threads");
  EXPECT_EQ(refused_at([] { explain({}, {}, {}, {.threads = -1}); }), "--threads");
  EXPECT_EQ(refused_at([] { check({}, {}, {}, {.threads = -1}); }), "--threads");
  EXPECT_EQ(refused_at([] { simulate({}, {}, {}, {.threads = -1}); }), "--threads");
}

}  // namespace
}  // namespace servodx
