// A folder of results as a table, and the table beside the truth.
#include "fleet/gather.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/wilson.h"
#include "faults/registry.h"
#include "fleet/confusion.h"
#include "servodx/fleet.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

const std::atomic<bool> never{false};

// What `diagnose` writes, but for what `gather` does not read.
std::string result(const std::string& log, const std::string& verdict, const std::string& fault, double error,
                   double severity = 0.5) {
  const std::string name = fault.empty() ? verdict : fault;
  const std::string size = fault.empty() ? R"({"value": null, "lower": null, "upper": null, "unit": ""})"
                                         : R"({"value": )" + std::to_string(severity) + R"(, "lower": )" +
                                               std::to_string(severity - 0.1) + R"(, "upper": )" +
                                               std::to_string(severity + 0.1) + R"(, "unit": "-"})";
  return R"({"tool": "servodx", "command": "diagnose", "results": [{"log": ")" + log + R"(", "verdict": ")" + verdict +
         R"(", "error": )" + std::to_string(error) + R"(, "threshold": 2, "fault": )" +
         (fault.empty() ? "null" : "\"" + fault + "\"") + R"(, "probabilities": {")" + name +
         R"(": 0.75}, "severity": )" + size + "}]}";
}

// The same with what the log would have shown.
std::string shows(std::string result, const std::string& detectable) {
  return result.insert(result.find(R"("verdict")"), R"("detectable": )" + detectable + ", ");
}

struct Fleet : TemporaryFolder {
  Fleet() {
    write("1.json", result("a/1.csv", "healthy", "", 1));
    write("2.json", result("a/2.csv", "fault", "clogged_filter", 6));
    write("3.json", result("b/1.csv", "unknown", "", 9));
    write("4.json", result("b/2.csv", "fault", "sticky_spool", 4));
    write("5.json", result("b/3.csv", "healthy", "", 1.5));
    write("6.refused.json", R"({"command": "diagnose", "log": "bad.csv", "refused": {"file": "bad.csv", "line": 7,
                               "column": "time", "rule": "goes back", "mend": "sort it"}})");
  }
};

TEST(Gather, ARowKnowsThePageThatStandsBesideItsResult) {
  const Fleet fleet;
  fleet.write("2.html", "<html>");
  for (const FleetRow& row : gather(fleet.path.string(), never).rows)
    EXPECT_EQ(row.page, row.file == "2.json" ? "2.html" : "") << row.file;
}

TEST(Gather, RowsAreTheResultsWorstFirst) {
  const Fleet fleet;
  const FleetTable table = gather(fleet.path.string(), never);
  std::vector<std::string> logs;
  for (const FleetRow& row : table.rows) logs.push_back(row.log);
  EXPECT_EQ(logs, (std::vector<std::string>{"b/1.csv", "a/2.csv", "b/2.csv", "b/3.csv", "a/1.csv"}));
  const FleetRow& clogged = table.rows[1];
  EXPECT_EQ(clogged.name(), "clogged_filter");
  EXPECT_EQ(clogged.severity, 0.5);
  EXPECT_EQ(clogged.severity_unit, "-");
  EXPECT_EQ(clogged.probability, 0.75);
  EXPECT_EQ(clogged.excess(), 3);
  EXPECT_TRUE(std::isnan(table.rows[0].severity));
  ASSERT_EQ(table.refused.size(), 1u);
  EXPECT_EQ(table.refused[0].file, "bad.csv");
  EXPECT_EQ(table.refused[0].line, 7);
  EXPECT_TRUE(table.unread.empty());
}

TEST(Gather, WhatIsNoResultIsNamedWithItsMendAndTheRestCounts) {
  const Fleet fleet;
  const std::string whole = result("x.csv", "fault", "sticky_spool", 4);
  fleet.write("half.json", whole.substr(0, whole.size() / 2));
  fleet.write("notes.txt", "do not forget");
  fleet.write("tune.json", R"({"tool": "servodx", "command": "tune"})");
  fleet.write("list.json", "[1, 2]");
  fleet.write("verdict.json", result("x.csv", "perhaps", "", 4));
  fleet.write("types.json", R"({"command": "diagnose", "results": [{"log": 5}]})");
  std::filesystem::create_directory(fleet / "older");
  const FleetTable table = gather(fleet.path.string(), never);
  EXPECT_EQ(table.rows.size(), 5u);
  std::vector<std::string> unread;
  for (const SetAside& file : table.unread) {
    unread.push_back(file.file);
    EXPECT_FALSE(file.rule.empty() || file.mend.empty()) << file.file;
  }
  EXPECT_EQ(unread, (std::vector<std::string>{"half.json", "list.json", "notes.txt", "older", "tune.json", "types.json",
                                              "verdict.json"}));
}

TEST(Gather, ARowHoldsTheLeastThatItsLogWouldHaveShown) {
  const TemporaryFolder folder;
  folder.write("a.json", shows(result("a.csv", "healthy", "", 1),
                               R"({"clogged_filter": {"value": null, "unit": "-"}, "sticky_spool": {"value": 4.5},
                                   "fault_of_a_later_version": {"value": 2}})"));
  folder.write("b.json", result("b.csv", "healthy", "", 1));
  folder.write("c.json", shows(result("c.csv", "healthy", "", 1), R"({"sticky_spool": {"value": "much"}})"));
  folder.write("d.json", shows(result("d.csv", "healthy", "", 1), "7"));
  const FleetTable table = gather(folder.path.string(), never);
  ASSERT_EQ(table.rows.size(), 2u);
  const std::vector<LeastShown>& shown = table.rows[0].detectable;
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_EQ(shown[0].fault, find_fault("clogged_filter"));
  EXPECT_TRUE(std::isnan(shown[0].severity));
  EXPECT_EQ(shown[1].fault, find_fault("sticky_spool"));
  EXPECT_EQ(shown[1].severity, 4.5);
  EXPECT_TRUE(table.rows[1].detectable.empty());
  EXPECT_EQ(table.unread.size(), 2u);
}

TEST(Gather, PagesManifestsAndFilesBeingWrittenArePassedOver) {
  const Fleet fleet;
  for (const char* name : {"2.html", "t.csv.manifest.json", "7.json.servodx-tmp0"}) fleet.write(name, "x");
  const FleetTable table = gather(fleet.path.string(), never);
  EXPECT_TRUE(table.unread.empty());
  EXPECT_EQ(table.rows.size(), 5u);
}

TEST(Gather, AFolderWithoutResultsIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(gather(folder.path.string(), never), InputError);
  EXPECT_THROW(gather(folder / "gone", never), InputError);
}

TEST(Gather, TheTableAsCsvHasARowALogAndEmptyCellsForWhatIsNotKnown) {
  const Fleet fleet;
  const std::string csv = csv_of(gather(fleet.path.string(), never));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
  EXPECT_TRUE(csv.starts_with("log,verdict,fault,severity,severity_lower,severity_upper,severity_unit,"));
  EXPECT_NE(csv.find("b/1.csv,unknown,,,,,,0.75,9,2\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("a/2.csv,fault,clogged_filter,0.5,0.4,0.6,-,0.75,6,2\n"), std::string::npos) << csv;
}

TEST(Confusion, CountsAreTheCountsByHand) {
  const Fleet fleet;
  const TemporaryFolder desk;
  const FleetTruth truth = read_truth(desk.write("truth.csv",
                                                 "log,class,severity\n"
                                                 "a/1.csv,healthy,\n"
                                                 "a/2.csv,clogged_filter,0.55\n"
                                                 "b/1.csv,clogged_filter,0.5\n"
                                                 "b/2.csv,healthy,\n"
                                                 "elsewhere/b/3.csv,sticky_spool,4\n"));
  const Confusion all = confusion_of(gather(fleet.path.string(), never), truth);
  EXPECT_EQ(all.classes, (std::vector<std::string>{"healthy", "clogged_filter"}));
  EXPECT_EQ(all.names, (std::vector<std::string>{"healthy", "clogged_filter", "sticky_spool", "unknown"}));
  EXPECT_EQ(all.counts.at("healthy").at("healthy"), 1);
  EXPECT_EQ(all.counts.at("healthy").at("sticky_spool"), 1);
  EXPECT_EQ(all.counts.at("clogged_filter").at("clogged_filter"), 1);
  EXPECT_EQ(all.counts.at("clogged_filter").at("unknown"), 1);
  const Confusion::OfClass &healthy = all.rates.at("healthy"), &clogged = all.rates.at("clogged_filter");
  EXPECT_EQ(healthy.detected.counted, 1);  // false alarms
  EXPECT_EQ(healthy.detected.of, 2);
  EXPECT_EQ(clogged.detected.counted, 2);
  EXPECT_EQ(clogged.named.counted, 1);
  EXPECT_EQ(clogged.named.of, 2);
  EXPECT_EQ(clogged.sized.counted, 1);
  EXPECT_EQ(clogged.sized.of, 1);
  EXPECT_EQ(all.without_truth, 1);
  EXPECT_EQ(all.without_result, 1);
}

TEST(Confusion, ProbabilitiesAndBoundsAreCountedBesideTheTruth) {
  const TemporaryFolder folder, desk;
  const std::string least = R"({"clogged_filter": {"value": 0.6}, "sticky_spool": {"value": 4}})";
  folder.write("1.json", shows(result("1.csv", "fault", "clogged_filter", 6), least));
  folder.write("2.json", shows(result("2.csv", "fault", "sticky_spool", 6), least));
  folder.write("3.json", shows(result("3.csv", "unknown", "", 6), least));
  folder.write("4.json", shows(result("4.csv", "healthy", "", 1), least));
  folder.write("5.json", shows(result("5.csv", "fault", "sticky_spool", 6), least));
  const std::string truth = desk.write("truth.csv",
                                       "log,class,severity\n"
                                       "1.csv,clogged_filter,0.7\n"
                                       "2.csv,healthy,\n"
                                       "3.csv,sticky_spool,3\n"
                                       "4.csv,sticky_spool,20\n"
                                       "5.csv,sticky_spool,\n");
  const FleetTable table = gather(folder.path.string(), never);
  const Confusion all = confusion_of(table, read_truth(truth));
  EXPECT_EQ(all.calibration.right.counted, 2);  // of logs 1, 2 and 5, which name a fault
  EXPECT_EQ(all.calibration.right.of, 3);
  EXPECT_NEAR(all.calibration.error, 0.75 - 2.0 / 3, 1e-12);
  EXPECT_EQ(all.detectable.all.below.found.counted, 1);
  EXPECT_EQ(all.detectable.all.below.found.of, 1);
  EXPECT_EQ(all.detectable.all.beyond.found.counted, 1);
  EXPECT_EQ(all.detectable.all.beyond.found.of, 2);
  EXPECT_EQ(all.detectable.all.well_beyond.found.of, 1);
  EXPECT_EQ(all.detectable.faults.at("sticky_spool").beyond.found.counted, 0);
}

TEST(Confusion, ATruthOfAFileNameAloneMustMeanOneLog) {
  const Fleet fleet;
  const TemporaryFolder desk;
  const FleetTable table = gather(fleet.path.string(), never);
  const Confusion one = confusion_of(table, read_truth(desk.write("t.csv", "class,log\nsticky_spool,3.csv\n")));
  EXPECT_EQ(one.counts.at("sticky_spool").at("healthy"), 1);
  EXPECT_THROW(confusion_of(table, read_truth(desk.write("t.csv", "log,class\n2.csv,healthy\n"))), InputError);
}

TEST(Confusion, ATruthFileThatSaysTooLittleIsRefusedAtItsLine) {
  const TemporaryFolder desk;
  const auto line_of = [&](const std::string& text) -> long {
    try {
      read_truth(desk.write("t.csv", text));
    } catch (const InputError& error) {
      return error.where.line;
    }
    return -1;
  };
  EXPECT_EQ(line_of("log,label\na.csv,healthy\n"), 1);
  EXPECT_EQ(line_of("log,class\na.csv,healthy\nb.csv,\n"), 3);
  EXPECT_EQ(line_of("log,class\na.csv,healthy\n,healthy\n"), 3);
  EXPECT_EQ(line_of("log,class\na.csv,healthy\n./a.csv,healthy\n"), 3);
  EXPECT_EQ(line_of("log,class,severity\na.csv,healthy,much\n"), 2);
  EXPECT_EQ(line_of("log,class,severity\na.csv,healthy,\n"), -1);
}

// The interval's ends are the rates at which the count lies 1.96 standard deviations off.
TEST(Wilson, TheEndsOfTheIntervalAreThoseThatTheCountJustDoesNotRefuse) {
  const auto deviates = [](double rate, double k, double n) {
    return std::abs(k / n - rate) / std::sqrt(rate * (1 - rate) / n);
  };
  for (const double n : {2.0, 20.0, 400.0})
    for (const double k : {1.0, n / 2, n - 1}) {
      const RateInterval interval = wilson_95(k, n);
      EXPECT_NEAR(deviates(interval.lower, k, n), 1.959964, 1e-6);
      EXPECT_NEAR(deviates(interval.upper, k, n), 1.959964, 1e-6);
      EXPECT_LT(interval.lower, k / n);
      EXPECT_GT(interval.upper, k / n);
    }
  EXPECT_NEAR(deviates(wilson_95(0, 20).upper, 0, 20), 1.959964, 1e-6);
  EXPECT_NEAR(deviates(wilson_95(20, 20).lower, 20, 20), 1.959964, 1e-6);
  EXPECT_EQ(wilson_95(0, 0).lower, 0);
  EXPECT_EQ(wilson_95(0, 0).upper, 1);
}

}  // namespace
}  // namespace servodx
