// What is refused names the place, the rule and the mend on standard error, ends with code 2, and writes nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "program.h"

namespace servodx {
namespace {

const std::string simulate = "simulate log.csv --params table.csv -o sim.csv";

struct Refusal {
  std::string name;
  std::function<void(const Desk&)> prepare;  // on a desk with log.csv, table.csv, rig.toml and a folder `folder`
  std::string call;
  std::vector<std::string> says;  // place, rule, mend, in this order on standard error
};

void PrintTo(const Refusal& refusal, std::ostream* to) { *to << refusal.call; }

void no_change(const Desk&) {}

// A name in so many levels, as TOML writes it.
std::string levels(int many) {
  std::string name;
  for (int i = 1; i < many; ++i) name += "a.";
  return name + "a";
}

// `small_log` with other times [ms].
std::string with_times(const std::string& log, const std::function<double(int)>& time) {
  std::istringstream in(log);
  std::string out, line;
  for (int k = -1; std::getline(in, line); ++k) {
    const auto from = line.find(',') + 1, to = line.find(',', from);
    out += k < 0 ? line : line.substr(0, from) + fmt::format("{}", time(k)) + line.substr(to);
    out += '\n';
  }
  return out;
}

const std::vector<Refusal>& refusals() {
  static const std::vector<Refusal> list = {
      // Logs
      {"LogWithoutSuchAFile",
       no_change,
       "simulate gone.csv --params table.csv -o sim.csv",
       {"gone.csv: ", "cannot be read", "check the path"}},
      {"LogWithTimeGoingBack",
       [](const Desk& d) { d.write("log.csv", with_line(small_log(), 102, "4,98,1,100,0.1,10,207")); },
       simulate,
       {"log.csv:102: column 'time': ", "; "}},
      {"LogWithTextInANumericColumn",
       [](const Desk& d) { d.write("log.csv", with_line(small_log(), 7, "0,5,broken,100,0.1,10,207")); },
       simulate,
       {"log.csv:7: column 'spool_position': ", "broken", "; "}},
      {"LogWithARaggedRow",
       [](const Desk& d) { d.write("log.csv", with_line(small_log(), 9, "0,7,1,100,0.1")); },
       simulate,
       {"log.csv:9: ", "ragged row: 5 cells, the header has 7", "; "}},
      {"LogWithAnUnknownUnit",
       [](const Desk& d) { d.write("log.csv", replaced(small_log(), "[bar]", "[barr]")); },
       simulate,
       {"log.csv:1: column 'pressure_b': ", "unknown unit 'barr'", "accepted: "}},
      {"LogWithoutADrive",
       [](const Desk& d) { d.write("log.csv", replaced(small_log(), "command", "demand")); },
       simulate,
       {"log.csv:1: ", "; "}},
      {"LogWithoutRows",
       [](const Desk& d) { d.write("log.csv", "time [s],command [mA],spool_position [mm]\n"); },
       simulate,
       {"log.csv:1: ", "the log has no rows", "; "}},
      {"LogWithTooFewRows",
       [](const Desk& d) { d.write("log.csv", small_log(5)); },
       simulate,
       {"log.csv:6: ", "5 rows", "; "}},
      {"LogOfTheRigBegunFromAPipe",
       no_change,
       "init /dev/null -o new.toml --table new.csv",
       {"/dev/null: ", "can be read but once", "write the log to a file"}},
      {"LogWithANumberThatNoUnitHolds",
       [](const Desk& d) { d.write("log.csv", with_line(small_log(), 7, "0,5,1,1e305,0.1,10,207")); },
       simulate,
       {"log.csv:7: column 'pressure_b': ", "1e+305 bar is no finite number of Pa", "; "}},
      {"LogWithADayInItsMiddle",
       [](const Desk& d) {
         d.write("log.csv", with_times(small_log(), [](int k) { return k + (k < 150 ? 0 : 864e5); }));
       },
       simulate,
       {"log.csv: column 'time': ", "a gap of 86400 s between rows 150 and 151", "cut the log there"}},
      {"LogOfAges",
       [](const Desk& d) { d.write("log.csv", with_times(small_log(), [](int k) { return (k + 1) * 1e300; })); },
       simulate,
       {"log.csv: column 'time': ", "its rows are 1e+297 s apart", "unit of time"}},
      {"TuneOfASampleASecond",
       [](const Desk& d) { d.write("log.csv", with_times(small_log(), [](int k) { return 1e3 * k; })); },
       "tune log.csv --params table.csv -o tuned.csv --quiet",
       {"log.csv: column 'time': ", "1 samples a second are too few", "unit of time"}},
      // Tables
      {"TableWithAFilterBlockedThrice",
       [](const Desk& d) {
         d.write("table.csv", replaced(shipped_table(), "1,filter_blockage_positive,first_stage,0,0,0.98",
                                       "1,filter_blockage_positive,first_stage,3,0,5"));
       },
       simulate,
       {"table.csv:5: column 'nominal': ", "'filter_blockage_positive' is 3, and is a part of a whole", "; "}},
      {"TableWithMoreAirThanOil",
       [](const Desk& d) { d.write("table.csv", replaced(shipped_table(), "0.005,0,0.1,lin", "0.005,0,5,lin")); },
       simulate,
       {"table.csv:39: column 'upper': ", "'air_fraction' may go up to 5, and is a part of a whole", "; "}},
      {"TableWithOilAsSoftAsNothing",
       [](const Desk& d) {
         d.write("table.csv", replaced(shipped_table(), "1400000000,700000000,2200000000", "1,1,2200000000"));
       },
       simulate,
       {"table.csv:42: column 'lower': ", "'bulk_modulus' is 1 Pa", "no liquid", "; "}},
      {"TableWithSwappedBounds",
       [](const Desk& d) { d.write("table.csv", replaced(shipped_table(), "750,375,1500", "750,1500,375")); },
       simulate,
       {"table.csv:9: column '", "; "}},
      {"TableWithoutARow",
       [](const Desk& d) { d.write("table.csv", replaced(shipped_table(), "\n41,", "\n#41,")); },
       simulate,
       {"table.csv", "; "}},
      {"TableWithAnUnknownColumn",
       [](const Desk& d) { d.write("table.csv", replaced(shipped_table(), "id,name", "id,nickname")); },
       simulate,
       {"table.csv:4: column 'nickname': ", "; "}},
      {"TableThatIsABaseline",
       [](const Desk& d) { d.write("table.csv", "{\n  \"threshold\": 2\n}\n"); },
       simulate,
       {"table.csv:1: ", "is JSON, and no table", "--baseline"}},
      {"ReportNamedAsAPdf",
       no_change,
       "check-log log.csv --report page.pdf",
       {"--report: ", "writes HTML, whatever its name", "--pdf"}},
      {"TableNotTuned",
       [](const Desk& d) { d.write("base.json", "{}"); },
       "diagnose log.csv --params table.csv --baseline base.json --json result.json",
       {"table.csv: column 'std_error': ", "not tuned", "servodx tune"}},
      {"BaselineOfATableNotTuned",
       no_change,
       "baseline log.csv --params table.csv -o base.json",
       {"table.csv", "not tuned", "servodx tune"}},
      {"ResultNestedTooDeep",
       [](const Desk& d) {
         d.write("a.json", R"({"tool": "servodx", "command": "x", "a": )" + std::string(100000, '[') +
                               std::string(100000, ']') + "}");
         d.write("b.json", bytes_of(d / "a.json"));
       },
       "compare a.json b.json",
       {"a.json: ", "nests deeper than 100 levels", "; "}},
      {"ResultOfANewerSchema",
       [](const Desk& d) {
         d.write("a.json", R"({"tool": "servodx", "command": "x", "schema": 99})");
         d.write("b.json", R"({"tool": "servodx", "command": "x", "schema": 1})");
       },
       "compare a.json b.json",
       {"a.json: ", "key 'schema': 99 is newer than this program", "; "}},
      {"ManifestOfOtherTypes",
       [](const Desk& d) {
         d.write("m.json",
                 R"({"manifest": 1, "command": "x", "directory": ".", "arguments": [5], "inputs": [], "outputs": [],
                 "version": "1", "interrupted": false})");
       },
       "rerun m.json",
       {"m.json: ", "is not as servodx writes it", "; "}},
      // Rig files
      {"RigFileWithAnUnknownKey",
       [](const Desk& d) { d.write("rig.toml", "[valve]\nrated_currant = \"20 mA\"\n"); },
       simulate + " --rig rig.toml",
       {"rig.toml:2: key 'valve.rated_currant': ", "unknown key", "did you mean 'rated_current'?", "known here: "}},
      {"RigFileWithABareNumber",
       [](const Desk& d) { d.write("rig.toml", "name = \"x\"\n[supply]\npressure = 207\n"); },
       simulate + " --rig rig.toml",
       {"rig.toml:3: key 'supply.pressure': ", "has no unit", "; "}},
      {"RigFileOfAJetPipe",
       [](const Desk& d) { d.write("rig.toml", "[valve]\nfirst_stage = \"jet_pipe\"\n"); },
       simulate + " --rig rig.toml",
       {"rig.toml:2: key 'valve.first_stage': ", "jet pipe", "; "}},
      // Options
      {"NoCommand", no_change, "", {"servodx: ", "subcommand is required", "--help"}},
      {"UnknownCommand", no_change, "symulate log.csv", {"servodx: ", "no command is called 'symulate'; ", "--help"}},
      {"UnknownOption",
       no_change,
       simulate + " --stepp 1e-4",
       {"servodx simulate: ", "--stepp", "servodx simulate --help"}},
      {"MisspeltOption",
       no_change,
       "simulate log.csv --parms params.csv -o sim.csv",
       {"servodx simulate: ", "no option is called '--parms'; did you mean '--params'?", "servodx simulate --help"}},
      {"MissingOption",
       no_change,
       "simulate log.csv -o sim.csv",
       {"servodx simulate: ", "--params is required", "--help"}},
      {"NegativeSeed", no_change, simulate + " --seed -1", {"--seed", "'-1' is not a whole number", "--help"}},
      {"NegativeThreads", no_change, simulate + " --threads -2", {"--threads", "'-2' is not a whole number", "--help"}},
      {"StepThatIsNoNumber", no_change, simulate + " --step abc", {"--step: ", "'abc' is not a number", "12.5"}},
      {"StepOfNoSize", no_change, simulate + " --step 0", {"--step: ", "between 0 and 0.1 s", "; "}},
      {"StepAndReference", no_change, simulate + " --step 1e-4 --reference", {"--reference: ", "; "}},
      {"UnknownEffect",
       no_change,
       "tune log.csv --params table.csv -o tuned.csv --effects magnetic_hysteresis,voodoo",
       {"--effects: ", "unknown effect 'voodoo'", "use none, magnetic_hysteresis"}},
      {"PriorOfNoSize",
       no_change,
       "tune log.csv --params table.csv -o tuned.csv --prior port_width=0",
       {"--prior: ", "'port_width=0' is not NAME=SD", "; "}},
      {"PriorOfNoRow",
       no_change,
       "tune log.csv --params table.csv -o tuned.csv --prior port_witdh=1e-4",
       {"--prior: ", "'port_witdh' is not among the rows that are fitted", "; "}},
      {"ProfileOfNoRow",
       no_change,
       "tune log.csv --params table.csv -o tuned.csv --profile port_width,port_witdh",
       {"--profile: ", "the table has no row 'port_witdh'", "name rows of the table"}},
      {"MonitorOfALoopThatRunsAway",
       no_change,
       "monitor log.csv --params table.csv -o sim.csv --loop-gain '-1 mA/mm'",
       {"--loop-gain: ", "lies above nought", "; "}},
      {"JoinByTime",
       no_change,
       "join log.csv log.csv -o joined.csv --by time",
       {"--by: ", "each recorder has a time of its own", "; "}},
      {"VirtualRigOfADataSheet",
       no_change,
       "rig --rig rig.toml -o run.csv",
       {"servodx rig: ", "no option is called '--rig'", "servodx rig --help"}},
      {"RigFileToBeginOneWith",
       no_change,
       "init log.csv --rig rig.toml -o new.toml --table new.csv",
       {"servodx init: ", "no option is called '--rig'", "servodx init --help"}},
      {"ResumeFromNothing",
       no_change,
       "tune log.csv --params table.csv -o tuned.csv --resume",
       {"--resume: ", "add --checkpoint"}},
      {"FalseAlarmAboveOne",
       no_change,
       "baseline log.csv --params table.csv -o base.json --false-alarm 5",
       {"--false-alarm: ", "between 0 and 1", "; "}},
      {"UnknownList", no_change, "list falts", {"there is no list of 'falts'", "faults, effects"}},
      {"RigFileOfManyLevels",
       [](const Desk& d) { d.write("rig.toml", "name = \"x\"\n[" + levels(100000) + "]\n"); },
       simulate + " --rig rig.toml",
       {"rig.toml:2: ", "nests deeper than 100 levels, at character 201; ", "mend the line"}},
      {"RigFileOfADottedKey",
       [](const Desk& d) { d.write("rig.toml", levels(50000) + " = 1\n"); },
       simulate + " --rig rig.toml",
       {"rig.toml:1: ", "nests deeper than 100 levels, at character 200; ", "mend the line"}},
      {"VirtualRigOfManyLevels",
       [](const Desk& d) { d.write("model.toml", "[" + levels(100000) + "]\n"); },
       "rig --rig-model model.toml -o run.csv",
       {"model.toml:1: ", "nests deeper than 100 levels, at character 201; ", "give a readable TOML file"}},
      {"RigFactsWithoutATable", no_change, "list params --rig rig.toml", {"--rig: ", "add --params"}},
      {"SameLogTwice",
       [](const Desk& d) { d.write("copy.csv", small_log()); },
       "tune log.csv copy.csv --params table.csv -o tuned.csv",
       {"copy.csv: ", "same log as log.csv", "name each log once"}},
      // Outputs
      {"OutputWithoutAName",
       no_change,
       "simulate log.csv --params table.csv -o ''",
       {"--output: ", "empty", "name a file"}},
      {"OutputInNoFolder",
       no_change,
       "simulate log.csv --params table.csv -o gone/sim.csv",
       {"gone/sim.csv: ", "no folder 'gone'", "; "}},
      {"OutputIsAFolder",
       no_change,
       "simulate log.csv --params table.csv -o folder",
       {"folder: ", "is a folder", "name a file"}},
      {"OutputIsTheLog",
       no_change,
       "simulate log.csv --params table.csv -o ./log.csv",
       {"./log.csv: ", "is an input", "another output"}},
      {"OutputIsTheTableThroughALink",
       [](const Desk& d) { std::filesystem::create_symlink("table.csv", d.path / "link.csv"); },
       "tune log.csv --params table.csv -o link.csv",
       {"link.csv: ", "is an input", "another output"}},
      {"JsonIsTheRigFile",
       no_change,
       simulate + " --rig rig.toml --json rig.toml",
       {"rig.toml: ", "is an input", "another output"}},
      {"TwoOutputsInOneFile",
       no_change,
       simulate + " --json folder/../sim.csv",
       {"sim.csv: ", "two outputs", "its own file"}},
      {"JsonIsTheManifestOfTheOutput",
       no_change,
       simulate + " --json ./sim.csv.manifest.json",
       {"sim.csv.manifest.json: ", "is the name of the manifest of sim.csv", "another output"}},
      {"LogIsTheManifestOfTheOutput",
       [](const Desk& d) { d.write("sim.csv.manifest.json", small_log()); },
       "simulate sim.csv.manifest.json --params table.csv -o sim.csv",
       {"sim.csv.manifest.json: ", "is an input", "another output"}},
      {"LogIsTheManifestOfTheSecondOutput",
       [](const Desk& d) { d.write("r.json.manifest.json", small_log()); },
       "simulate r.json.manifest.json --params table.csv -o /dev/null --json r.json",
       {"r.json.manifest.json: ", "is an input", "another output"}},
      {"JsonInNoFolder", no_change, simulate + " --json gone/result.json", {"gone/result.json: ", "no folder", "; "}},
  };
  return list;
}

class Refusals : public testing::TestWithParam<Refusal> {};

TEST_P(Refusals, NamePlaceRuleAndMendAndWriteNothing) {
  const Refusal& refusal = GetParam();
  Desk desk;
  desk.write("log.csv", small_log());
  desk.write("table.csv", shipped_table());
  desk.write("rig.toml", "name = \"bench\"\n");
  std::filesystem::create_directory(desk.path / "folder");
  refusal.prepare(desk);
  const auto before = desk.contents();

  const Ended ended = desk.run(refusal.call);
  EXPECT_EQ(ended.code, 2) << ended.err;
  EXPECT_EQ(ended.out, "");
  std::size_t from = 0;
  for (const std::string& words : refusal.says) {
    const auto at = ended.err.find(words, from);
    EXPECT_NE(at, std::string::npos) << "'" << words << "' is not (in this order) in: " << ended.err;
    if (at != std::string::npos) from = at + words.size();
  }
  const bool has_code = ended.err.find("]\n'servodx help ") != std::string::npos;  // one line more
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), has_code ? 2 : 1) << ended.err;
  EXPECT_EQ(desk.contents(), before);
}

INSTANTIATE_TEST_SUITE_P(Cli, Refusals, testing::ValuesIn(refusals()),
                         [](const auto& test) { return test.param.name; });

TEST(CliRefusals, TheControlOfTheTableRuns) {
  Desk desk;
  desk.write("log.csv", small_log());
  desk.write("table.csv", shipped_table());
  desk.write("rig.toml", "name = \"bench\"\n");
  const Ended ended = desk.run(simulate + " --rig rig.toml");
  EXPECT_EQ(ended.code, 0) << ended.err;
}

}  // namespace
}  // namespace servodx
