// What is suspicious about a log does not depend on what its file is called.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "servodx/check_log.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "shipped_data.h"
#include "signals/signal.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

// A shipped log with samples left out and a spool sensor that stands still.
std::vector<OutputColumn> with_a_gap_and_a_frozen_spool() {
  Log log = shipped_log("healthy/h12_mixed");
  auto& spool = log.channels[index(Signal::spool_position)].value;
  std::fill(spool.begin(), spool.end(), 1e-4);
  std::vector<OutputColumn> columns;
  for (const SignalInfo& s : signal_list) {
    if (s.signal != Signal::time && !log.has(s.signal)) continue;
    std::vector<double> x = s.signal == Signal::time ? log.time : log[s.signal];
    x.erase(x.begin() + 500, x.begin() + 505);
    columns.push_back(output_column(log, s.signal, std::move(x)));
  }
  return columns;
}

std::vector<FindingKind> kinds_in(const std::string& path) {
  std::vector<FindingKind> kinds;
  for (const Finding& f : survey(read_log(path, shipped_rig()), shipped_rig()).findings) kinds.push_back(f.kind);
  return kinds;
}

TEST(Survey, FindsWhatTheReaderSawWhateverTheFileIsCalled) {
  const TemporaryFolder folder;
  const std::vector<OutputColumn> columns = with_a_gap_and_a_frozen_spool();
  write_log(folder / "run_1.csv", columns);
  write_log(folder / "gap_1.csv", columns);
  const std::vector<FindingKind> kinds = kinds_in(folder / "run_1.csv");
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), FindingKind::gaps), 1);
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), FindingKind::values), 1) << "the frozen sensor, and no gap again";
  EXPECT_EQ(kinds_in(folder / "gap_1.csv"), kinds);
}

// Drain lines are laid out for some per cent of the supply.
TEST(Survey, AReturnThatTakesAFifthOfTheSupplyIsSuspicious) {
  Log log = shipped_log("healthy/h12_mixed");
  auto& back = log.channels[index(Signal::return_pressure)].value;
  const auto kinds_at = [&](double bar) {
    back.assign(log.samples(), 1e5 * bar);
    std::vector<FindingKind> kinds;
    for (const Finding& f : survey(log, shipped_rig()).findings) kinds.push_back(f.kind);
    return kinds;
  };
  const auto says = [](const std::vector<FindingKind>& kinds) {
    return std::count(kinds.begin(), kinds.end(), FindingKind::return_line);
  };
  EXPECT_EQ(says(kinds_at(60)), 1);
  EXPECT_EQ(says(kinds_at(10)), 0);
  EXPECT_EQ(says(kinds_at(300)), 0) << "above the supply it is another finding, and once";
}

TEST(Survey, ColumnsThatAreNoSignalsAreANotice) {
  Log log = shipped_log("healthy/h12_mixed");
  log.notes = {{Note::Kind::ignored_columns, log.path + ": columns ignored: 'shift'"},
               {Note::Kind::implausible, log.path + ": stands still"}};
  const std::vector<Finding> found = survey(log, shipped_rig()).findings;
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(found[0].notice) << found[0].text;
  EXPECT_FALSE(found[1].notice) << found[1].text;
}

}  // namespace
}  // namespace servodx
