// The front door of `plan`: options checked, the test planned, its commands written.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "base/require_setting.h"
#include "plan/plan.h"
#include "servodx/baseline.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/plan.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "store/baseline_parts.h"

namespace servodx {
namespace {

void require_limit(const std::optional<double>& limit, const char* option) {
  require_setting(!limit || *limit > 0, option, "must lie above nought",
                  "give how far the test may go, or leave it out");
}

void write(const std::string& path, const PlannedTest& test, const std::vector<double>& command, bool with_setpoint,
           const std::string& what) {
  std::vector<OutputColumn> columns = {{Signal::time, "s", test.time}, {Signal::command, "mA", command}};
  if (with_setpoint) columns.push_back({Signal::setpoint, "mm", test.setpoint});
  write_log(path, columns, {what, "each value is held until the next; 'servodx rig --command FILE' plays it"});
}

}  // namespace

void PlanOptions::validate() const {
  const int goals = !faults.empty() + !between.empty() + !rows.empty();
  require_setting(goals <= 1, "--faults, --between, --rows", "ask for different tests", "give one of them");
  require_setting(between.empty() || between.size() == 2, "--between",
                  fmt::format("takes two faults to distinguish, and {} are named", between.size()),
                  "name two faults: A,B");
  require_setting(seconds >= 0.3 && seconds <= 30, "--seconds", "must lie between 0.3 and 30 s",
                  "give it in seconds: 2");
  require_setting(rate >= 200 && rate <= 20000, "--rate", "must lie between 200 and 20000 Hz",
                  "give it in hertz: 1000");
  require_setting(limits.current > 0 && limits.current <= 1, "--max-current",
                  "must lie above 0 and at most at 1, the rated current", "give it as a fraction of the rated current");
  require_limit(limits.stroke, "--max-stroke");
  require_limit(limits.speed, "--max-speed");
  require_limit(limits.pressure, "--max-pressure");
  require_setting(!loop_gain || *loop_gain > 0, "--closed-loop", "a loop's gain lies above nought",
                  "give it in mA/mm, or leave it out for an open loop");
  require_setting(rounds >= 0 && rounds <= 100, "--rounds", "must lie between 0 and 100", "6 is usual");
  require_threads(threads);
}

PlannedTest plan_test(const Tuned& tuned, const Rig& rig, const PlanOptions& options, const Baseline* baseline,
                      const Log* like) {
  options.validate();
  std::optional<Note> of_baseline;
  if (baseline) of_baseline = require_same_table(*baseline, tuned);
  PlannedTest out = plan_of(tuned.table, rig, options, baseline ? &parts_of(*baseline).detection : nullptr, like);
  if (of_baseline) out.notes.push_back(*of_baseline);
  return out;
}

void write_command(const std::string& path, const PlannedTest& test) {
  std::string pieces;
  for (const PlannedTest::Piece& p : test.pieces) pieces += (pieces.empty() ? "" : ", ") + p.shape;
  write(path, test, test.command, !test.setpoint.empty(), "planned test: " + pieces);
}

void write_random_command(const std::string& path, const PlannedTest& test) {
  write(path, test, test.random_command, false, "random test, to compare a planned one with");
}

}  // namespace servodx
