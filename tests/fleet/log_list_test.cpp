// Lists of logs and the names of their results.
#include "fleet/log_list.h"

#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "fleet/fleet_verdict.h"
#include "fleet/result_file.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

using Logs = std::vector<std::string>;

TEST(LogList, CommentsAndBlankLinesAreSkippedAndPathsKeepTheirInnerBlanks) {
  const TemporaryFolder folder;
  const std::string list = folder.write("list.txt", "# a fleet\n\n a/one.csv \r\n\tb/two of two.csv\n./#three.csv");
  EXPECT_EQ(read_log_list(list), (Logs{"a/one.csv", "b/two of two.csv", "./#three.csv"}));
}

TEST(LogList, ChunksShareOutEveryLogOnce) {
  const TemporaryFolder folder;
  const std::string list = folder.write("list.txt", "1\n# c\n2\n3\n\n4\n5\n6\n7\n");
  std::multiset<std::string> all;
  for (const char* chunk : {"1/3", "2/3", "3/3"})
    for (const std::string& log : read_log_list(list, read_chunk(chunk))) all.insert(log);
  EXPECT_EQ(all, (std::multiset<std::string>{"1", "2", "3", "4", "5", "6", "7"}));
  EXPECT_EQ(read_log_list(list, read_chunk("2/3")), (Logs{"2", "5"}));
  EXPECT_TRUE(read_log_list(list, read_chunk("9/9")).empty());
}

TEST(LogList, WhatIsNoChunkOrNoListIsRefused) {
  for (const char* chunk : {"", "3", "0/3", "4/3", "1/0", "-1/3", "1/3x", "1/ 3", "a/b"})
    EXPECT_THROW(read_chunk(chunk), InputError) << chunk;
  const TemporaryFolder folder;
  EXPECT_THROW(read_log_list(folder / "gone.txt"), InputError);
  EXPECT_THROW(read_log_list(folder.write("empty.txt", "# nothing\n")), InputError);
}

TEST(ResultName, LogsOfOneNameInTwoFoldersStayApart) {
  EXPECT_NE(result_name("a/log.csv"), result_name("b/log.csv"));
  EXPECT_NE(result_name("log.csv"), result_name("log.mat"));
  EXPECT_EQ(result_name("a/log.csv"), result_name("./a//x/../log.csv"));
}

TEST(ResultName, ResultsOfOneLogStayApartByTheirUse) {
  EXPECT_NE(result_name("log.csv", "V7"), result_name("log.csv", "V8"));
  EXPECT_NE(result_name("log.csv", "V7"), result_name("log.csv"));
  EXPECT_EQ(result_name("log.csv", "V7"), result_name("./log.csv", "V7"));
}

TEST(ResultName, IsAPlainFileNameWhateverThePath) {
  for (const std::string& log : {std::string("a/b c;$(x)'.csv"), std::string(1000, 'x') + ".csv", std::string("/"),
                                 std::string("\xff\xfe.csv"), std::string("..")}) {
    const std::string name = result_name(log);
    EXPECT_LT(name.size(), 150u) << log;
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-."),
              std::string::npos)
        << name;
  }
}

const ResultBasis basis{"1.0", "c0ffee", 7, R"({"false_alarm": 0.1, "explain_unknown": false})", {"aa", "bb"}};
const std::string result = R"({"version": "1.0", "commit": "c0ffee", "command": "diagnose", "seed": 7,
  "settings": {"false_alarm": 0.1, "explain_unknown": false},
  "inputs": [{"path": "x", "sha256": "bb"}, {"path": "y", "sha256": "aa"}], "results": [{"verdict": "fault"}]})";

std::string with(const std::string& what, const std::string& by) {
  std::string text = result;
  return text.replace(text.find(what), what.size(), by);
}

TEST(StandingVerdict, AResultStandsForTheSameInputsSettingsProgramAndSeedAlone) {
  const TemporaryFolder folder;
  const auto verdict = [&](const std::string& text) { return standing_verdict(folder.write("r.json", text), basis); };
  EXPECT_EQ(verdict(result), FleetVerdict::fault);
  EXPECT_EQ(verdict(with("fault", "healthy")), FleetVerdict::healthy);
  EXPECT_EQ(verdict(with("fault", "unknown")), FleetVerdict::unknown);
  EXPECT_EQ(verdict(with("\"aa\"", "\"cc\"")), FleetVerdict::none);
  EXPECT_EQ(verdict(with("\"1.0\"", "\"1.1\"")), FleetVerdict::none);
  EXPECT_EQ(verdict(with("7", "8")), FleetVerdict::none);
  EXPECT_EQ(verdict(with("c0ffee", "c0ffee-changed")), FleetVerdict::none);
  EXPECT_EQ(verdict(with("\"commit\": \"c0ffee\", ", "")), FleetVerdict::none) << "of an earlier program";
  EXPECT_EQ(verdict(with(", \"explain_unknown\": false", "")), FleetVerdict::none);
  EXPECT_EQ(verdict(with("\"explain_unknown\": false", "\"explain_unknown\": false, \"pool\": true")),
            FleetVerdict::none);
  EXPECT_EQ(verdict(with("0.1", "0.2")), FleetVerdict::none);
  EXPECT_EQ(verdict(with(R"(, {"path": "y", "sha256": "aa"})", "")), FleetVerdict::none);
  EXPECT_EQ(verdict(with("diagnose", "tune")), FleetVerdict::none);
  EXPECT_EQ(verdict(with("fault", "perhaps")), FleetVerdict::none);
}

TEST(StandingVerdict, ADamagedResultDoesNotStand) {
  const TemporaryFolder folder;
  EXPECT_EQ(standing_verdict(folder / "gone.json", basis), FleetVerdict::none);
  for (std::size_t length = 0; length < result.size(); ++length)
    EXPECT_EQ(standing_verdict(folder.write("r.json", result.substr(0, length)), basis), FleetVerdict::none) << length;
  for (const char* text : {"[]", "5", R"({"inputs": 5, "results": 5})", R"({"inputs": [5], "results": [5]})"})
    EXPECT_EQ(standing_verdict(folder.write("r.json", text), basis), FleetVerdict::none) << text;
}

}  // namespace
}  // namespace servodx
