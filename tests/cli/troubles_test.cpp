// The commonest refusals and warnings end in a code, and each code has its section in docs/errors.md.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/trouble.h"
#include "program.h"

namespace servodx {
namespace {

struct Bench : Desk {
  Bench() {
    write("log.csv", small_log());
    write("table.csv", shipped_table());
    write("rig.toml", "[valve]\nrated_current = \"20 mA\"\n");
  }
  // First line of standard error of a call that is refused. A second one says where its code is explained.
  std::string refusal(const std::string& call) const {
    const Ended ended = run(call);
    EXPECT_EQ(ended.code, 2) << call << "\n" << ended.err;
    const std::string first = ended.err.substr(0, ended.err.find('\n'));
    std::string wanted = first + "\n";
    if (first.ends_with("]")) wanted += "'servodx help " + first.substr(first.size() - 4, 3) + "' says what to do\n";
    EXPECT_EQ(ended.err, wanted) << call;
    return first;
  }
};

const std::string simulate = "simulate log.csv --params table.csv --rig rig.toml -o sim.csv";

TEST(Troubles, RefusalsEndInTheirCode) {
  const Bench bench;
  const auto of_log = [&](const std::string& text) {
    bench.write("log.csv", text);
    return bench.refusal(simulate);
  };
  EXPECT_TRUE(of_log(replaced(small_log(), "[bar]", "[barr]")).ends_with(" [E01]"));
  EXPECT_TRUE(of_log(replaced(small_log(), " [bar]", "")).ends_with(" [E01]"));
  EXPECT_TRUE(of_log(replaced(small_log(), "command", "comand")).ends_with(" [E02]"));
  EXPECT_TRUE(of_log(with_line(small_log(), 102, "4,98,1,100,0.1,10,207")).ends_with(" [E03]"));
  EXPECT_TRUE(of_log(with_line(small_log(), 9, "0,7,1,100,0.1")).ends_with(" [E04]"));
  EXPECT_TRUE(of_log(with_line(small_log(), 7, "0,5,broken,100,0.1,10,207")).ends_with(" [E04]"));
  EXPECT_TRUE(of_log(std::string("PK\x03\x04\0\0", 6)).ends_with(" [E05]"));
  bench.write("log.csv", small_log());
  bench.write("rig.toml", "[valve]\nrated_current = \"20 barr\"\n");
  EXPECT_TRUE(bench.refusal(simulate).ends_with(" [E01]"));
  bench.write("rig.toml", "[valve]\nrated_currant = \"20 mA\"\n");
  EXPECT_TRUE(bench.refusal(simulate).ends_with(" [E06]"));
  EXPECT_TRUE(bench.refusal("diagnose log.csv --params table.csv --baseline base.json").ends_with(" [E07]"));
}

TEST(Troubles, ARefusalWithoutAPageHasNoCode) {
  const Bench bench;
  EXPECT_EQ(bench.refusal("simulate gone.csv --params table.csv -o sim.csv").find(" [E"), std::string::npos);
}

TEST(Troubles, WarningsEndInTheirCode) {
  const Bench bench;
  std::string still = "time [ms],command [mA],spool_position [um]\n";
  for (int k = 0; k < 100; ++k) still += std::to_string(k) + ",3," + std::to_string(k % 7) + "\n";
  bench.write("log.csv", still);
  const Ended ended = bench.run(simulate);
  EXPECT_NE(ended.out.find("no excitation: it stays at 0.003 A [W03]"), std::string::npos) << ended.out << ended.err;
}

TEST(Troubles, EachCodeIsListedAndHasASectionOfItsOwn) {
  const Desk desk;
  const auto list = nlohmann::json::parse(desk.run("list errors --json -").out).at("errors");
  ASSERT_EQ(list.size(), static_cast<std::size_t>(n_troubles));
  const std::string page = bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "docs" / "errors.md");
  for (int i = 0; i < n_troubles; ++i) {
    const std::string code = code_of(static_cast<Trouble>(i));
    EXPECT_EQ(list[i].at("code"), code);
    EXPECT_FALSE(list[i].at("meaning").get<std::string>().empty()) << code;
    EXPECT_FALSE(list[i].at("remedy").get<std::string>().empty()) << code;
    EXPECT_NE(page.find("\n## " + code + "\n"), std::string::npos) << code;
  }
}

TEST(Troubles, HelpPrintsTheSectionOfACode) {
  const Desk desk;
  const std::string page = bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "docs" / "errors.md");
  for (int i = 0; i < n_troubles; ++i) {
    const std::string code = code_of(static_cast<Trouble>(i));
    const Ended ended = desk.run("help " + code);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_TRUE(ended.out.starts_with(code + ": ")) << ended.out;
    for (const char* mark : {"**", "](", "\n## "}) EXPECT_EQ(ended.out.find(mark), std::string::npos) << ended.out;
    const std::string last = ended.out.substr(ended.out.rfind("\n", ended.out.size() - 2) + 1);
    const auto at = page.find(last);
    const auto next = page.find("\n## ", page.find("\n## " + code + "\n") + 1);
    if (!last.starts_with(code)) EXPECT_TRUE(at != std::string::npos && at < next) << "not the whole section: " << last;
    EXPECT_EQ(desk.run("help '[" + code + "]'").out, ended.out);
  }
  EXPECT_NE(desk.run("help e02").out.find("servodx init LOG -o rig.toml"), std::string::npos);
}

TEST(Troubles, HelpListsTheCodesAndRefusesOthers) {
  const Desk desk;
  EXPECT_EQ(desk.run("help errors").out, desk.run("list errors").out);
  const Ended unknown = desk.run("help E99");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(unknown.out, "");
  EXPECT_NE(unknown.err.find("'E99'; there are E01, E02, "), std::string::npos) << unknown.err;
  EXPECT_NE(unknown.err.find("W05; 'servodx help errors'"), std::string::npos) << unknown.err;
}

TEST(Troubles, ARefusalKeepsItsPageWhereItIsSaidAgain) {
  const DocumentedError first(Trouble::unit, {"a", 1, "c"}, "rule", "mend");
  try {
    throw_like(first, {"b", 2, ""}, "another rule", "another mend");
  } catch (const InputError& again) {
    EXPECT_EQ(trouble_of(again), Trouble::unit);
    EXPECT_EQ(told(again), "b:2: another rule; another mend [E01]");
  }
  EXPECT_EQ(told(InputError({"a", 1, ""}, "rule", "mend")), "a:1: rule; mend");
}

}  // namespace
}  // namespace servodx
