#include "signals/log.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <functional>

#include "base/csv.h"
#include "base/random.h"
#include "base/sha256.h"
#include "base/units.h"
#include "servodx/error.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/log_columns.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

const std::string header = "time [s],command [mA],spool_position [mm]\n";

// Rows at 1 kHz whose columns move; `edit` may change the text of row i (0-based).
std::string rows(int n, const std::function<std::string(int, std::string)>& edit = nullptr) {
  std::string text;
  for (int i = 0; i < n; ++i) {
    std::string row = fmt::format("{},{},{}\n", i * 1e-3, i % 7 - 3, 0.01 * ((i * 5) % 11));
    text += edit ? edit(i, row) : row;
  }
  return text;
}

std::string replace_row(int which, const std::string& with, int n = 30) {
  return rows(n, [&](int i, std::string row) { return i == which ? with : row; });
}

RigFile rig_with(const std::string& toml) {
  const TemporaryFolder folder;
  return read_rig_file(folder.write("rig.toml", toml));
}

Log read(const std::string& text, const RigFile& rig = {}, const ReadOptions& options = {}) {
  const TemporaryFolder folder;
  return read_log(folder.write("log.csv", text), rig, options);
}

// The message without the folder; "accepted" where there is none.
std::string refusal(const std::string& text, const RigFile& rig = {}, const ReadOptions& options = {}) {
  const TemporaryFolder folder;
  const std::string path = folder.write("log.csv", text);
  try {
    read_log(path, rig, options);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.starts_with(path) ? "log.csv" + what.substr(path.size()) : what;
  }
  return "accepted";
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::isnan(a[i]) && std::isnan(b[i])) &&
        std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i]))
      return false;
  return true;
}

bool mentions(const Log& log, const std::string& words) {
  for (const Note& note : log.notes)
    if (note.text.find(words) != std::string::npos) return true;
  return false;
}

TEST(Log, ValuesArriveInSi) {
  const Log log = read(
      "oil_temperature [degF],time [ms],command [mA],pressure_a [psi],pressure_b [bar],flow_a [gpm],load_force [lbf],"
      "piston_position [in]\n104,0,20,1000,10,1,1,1\n104,1,-20,1000,10,1,1,1\n",
      {}, {.minimum_rows = 2});
  EXPECT_EQ(log.time, (std::vector<double>{0.0, 1e-3}));
  EXPECT_EQ(log[Signal::command], (std::vector<double>{0.02, -0.02}));
  EXPECT_NEAR(log[Signal::oil_temperature][0], 313.15, 1e-12 * 313.15);
  EXPECT_DOUBLE_EQ(log[Signal::pressure_a][0], 1000 * 4.4482216152605 / (0.0254 * 0.0254));
  EXPECT_EQ(log[Signal::pressure_b][0], 1e6);
  EXPECT_DOUBLE_EQ(log[Signal::flow_a][0], 3.785411784e-3 / 60);
  EXPECT_DOUBLE_EQ(log[Signal::load_force][0], 4.4482216152605);
  EXPECT_DOUBLE_EQ(log[Signal::piston_position][0], 0.0254);
  EXPECT_FALSE(log.has(Signal::spool_position));
  EXPECT_EQ(log.channels[index(Signal::pressure_a)].unit, "psi");
}

TEST(Log, TheHashIsThatOfTheBytes) {
  const std::string text = header + rows(30);
  EXPECT_EQ(read(text).sha256, sha256(text));
}

TEST(Log, SeparatorDecimalCommaBomCrlfAndCommentsReadAlike) {
  const Log plain = read(header + rows(30));
  const auto swapped = [&](char separator, bool decimal_comma, const std::string& line_end) {
    std::string text;
    for (char c : header + rows(30)) {
      if (c == ',')
        text += separator;
      else if (c == '.' && decimal_comma)
        text += ',';
      else if (c == '\n')
        text += line_end;
      else
        text += c;
    }
    return text;
  };
  for (const std::string& text :
       {swapped(';', false, "\n"), swapped(';', true, "\n"), swapped('\t', false, "\n"), swapped(',', false, "\r\n"),
        swapped(';', true, "\r\n"), "\xEF\xBB\xBF" + header + rows(30), "# bench 3\n#, \"; \n" + header + rows(30),
        "\xEF\xBB\xBF# bench 3\r\n" + swapped('\t', false, "\r\n")}) {
    const Log log = read(text);
    EXPECT_TRUE(same_bits(log.time, plain.time)) << text.substr(0, 60);
    EXPECT_TRUE(same_bits(log[Signal::spool_position], plain[Signal::spool_position])) << text.substr(0, 60);
    EXPECT_TRUE(log.notes.empty());
  }
}

TEST(Log, TabsWithDecimalCommasReadAsWithPoints) {
  const std::string tabs = "time [s]\tcommand [mA]\tspool_position [mm]\n";
  const Log points = read(tabs + "0.0\t1.5\t0.25\n0.001\t-1.5\t1e-1\n", {}, {.minimum_rows = 2});
  const Log commas = read(tabs + "0,0\t1,5\t0,25\n0,001\t-1,5\t1e-1\n", {}, {.minimum_rows = 2});
  EXPECT_TRUE(same_bits(points.time, commas.time));
  EXPECT_TRUE(same_bits(points[Signal::command], commas[Signal::command]));
  EXPECT_TRUE(same_bits(points[Signal::spool_position], commas[Signal::spool_position]));
}

TEST(Log, TimeStampsAreSecondsFromTheFirstRow) {
  const std::string columns = "command [mA],spool_position [mm]\n";
  const Log plain = read("time [s]," + columns + "0,1,2\n0.001,1,3\n0.5,2,2\n", {}, {.minimum_rows = 3});
  for (const std::string& text :
       {"time," + columns +
            "2021-03-04 10:11:12.000000,1,2\n2021-03-04 10:11:12.001000,1,3\n2021-03-04 "
            "10:11:12.500000,2,2\n",
        "time [s]," + columns + "2021-03-04T10:11:12Z,1,2\n2021-03-04T10:11:12.001Z,1,3\n2021-03-04T10:11:12.5Z,2,2\n",
        "time," + columns + "\"23:59:59.9\",1,2\n\"23:59:59.901\",1,3\n\"00:00:00.4\",2,2\n"}) {
    const Log log = read(text, {}, {.minimum_rows = 3});
    ASSERT_EQ(log.samples(), 3u) << text;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(log.time[k], plain.time[k]) << text;
  }
  const Log american = read("time," + columns + "03/04/2021 11:59:59.900 PM,1,2\n03/05/2021 12:00:00.150 AM,1,3\n", {},
                            {.minimum_rows = 2});
  EXPECT_DOUBLE_EQ(american.time[1], 0.25);
  const RigFile rig = rig_with("[columns]\n\"Zeit\" = { signal = \"time\", unit = \"s\" }\n");
  const Log german =
      read("Zeit;command [mA];spool_position [mm]\n04.03.2021 10:11:12,000;0,5;1\n04.03.2021 10:11:12,250;0,5;1\n", rig,
           {.minimum_rows = 2});
  EXPECT_DOUBLE_EQ(german.time[1], 0.25);
  EXPECT_EQ(refusal("time," + columns + "10:11:12,1,2\n0.5,1,2\n"),
            "log.csv:3: column 'time': '0.5' is no time stamp like the first row's; write all times in one form");
  EXPECT_EQ(refusal("time [s]," + columns + "0,1,2\n10:11:12,1,2\n"),
            "log.csv:3: column 'time': '10:11:12' is not a number; write a number with a decimal point, or leave the "
            "cell empty");
}

TEST(Log, LabViewsCommentColumnMayLackItsCells) {
  const std::string text =
      "LabVIEW Measurement\nSeparator\tTab\n***End_of_Header***\n\ntime\tcommand\tspool_position\tComment\n"
      "s\tmA\tmm\n0,0\t1\t0,5\n0,001\t2\t0,6\n0,002\t3\t0,7\tend of run\n";
  const Log log = read(text, {}, {.minimum_rows = 3});
  EXPECT_EQ(log.samples(), 3u);
  EXPECT_DOUBLE_EQ(log[Signal::spool_position][2], 0.7e-3);
}

TEST(Log, CellsBetweenBlanksAreToldSo) {
  const std::string names = "time command piston_position\n", units = "s mA mm\n", row = "  0.001  -2.5e-1   3\n";
  for (const std::string& text : {names + units + row, names + row, row + row})
    EXPECT_TRUE(refusal(text).starts_with("log.csv:1: its cells are parted by blanks; part them by ';' or tabs"))
        << text;
  EXPECT_EQ(refusal("time [s] of the rig\n0\n1\n").find("blanks"), std::string::npos) << "one column";
}

TEST(Log, AFileWithoutAHeaderOrTextIsToldSo) {
  EXPECT_EQ(refusal(rows(30)),
            "log.csv:1: there is no header row: the first row is numbers; write a row of 'name [unit]' above it");
  EXPECT_TRUE(refusal(std::string("TDSm") + std::string(500, '\0')).starts_with("log.csv: is a LabVIEW recording"));
  EXPECT_NE(refusal("TIME [s],COMMAND [mA]\n0,1\n").find("did you mean 'time' by 'TIME'?"), std::string::npos);
  EXPECT_EQ(refusal("time [s],Comment\n0,1\n").find("did you mean"), std::string::npos);
}

TEST(Log, DecimalCommasBetweenCommasAreToldInTheFirstRow) {
  const std::string said =
      "decimal commas between commas; export with ';' or tab between cells, or with decimal points";
  EXPECT_EQ(refusal("time,command,x\n0,000,1,5,0,25\n0,001,1,5,0,25\n"),
            "log.csv:2: ragged row: 6 cells, the header has 3: " + said);
  EXPECT_EQ(refusal("time [ms],command [mA],x\n0,1,5,0,25\n1,1,5,0,25\n"),
            "log.csv:2: ragged row: 5 cells, the header has 3: " + said);
  EXPECT_EQ(refusal("time [ms],command [mA],x\n0,1.5,2,3,4\n1,1,5,0,25\n"),
            "log.csv:2: ragged row: 5 cells, the header has 3; write one cell a column; a decimal comma needs ';' as "
            "separator");
}

TEST(Log, ASecondRecordingInTheFileIsTold) {
  const std::string said = "a second header: the file holds several recordings; cut it into a file for each";
  EXPECT_EQ(refusal(header + rows(30) + header + rows(30)), "log.csv:32: " + said);
  const std::string segment =
      "Channels\t2\t\n***End_of_Header***\t\t\ntime [s]\tcommand [mA]\tspool_position [mm]\tComment\n"
      "0\t1\t0.5\n0.001\t2\t0.6\n";
  EXPECT_EQ(refusal("LabVIEW Measurement\t\n***End_of_Header***\n\n" + segment + "\n" + segment),
            "log.csv:10: " + said);
}

TEST(Log, TextThatIsNoUtf8WithLineFeedsIsTold) {
  std::string wide = "\xFF\xFE";
  for (const char c : header + rows(30)) wide += {c, '\0'};
  EXPECT_EQ(refusal(wide), "log.csv:1: the text is UTF-16; save the file as UTF-8");
  EXPECT_EQ(refusal("\xFE\xFF" + wide.substr(3) + '\n'), "log.csv:1: the text is UTF-16; save the file as UTF-8");
  std::string old = header + rows(30);
  std::replace(old.begin(), old.end(), '\n', '\r');
  EXPECT_EQ(refusal(old), "log.csv:1: its lines end in CR alone; save the file with line ends of LF or CRLF");
}

TEST(Log, NamesBehindAHashAreTheHeader) {
  const Log log = read("# run 7\n# " + header + rows(30)), plain = read(header + rows(30));
  EXPECT_TRUE(same_bits(log.time, plain.time));
  EXPECT_TRUE(same_bits(log[Signal::spool_position], plain[Signal::spool_position]));
  EXPECT_TRUE(log.notes.empty());
}

TEST(Log, RowsOfTextBelowTheHeaderArePassedAndTold) {
  const std::string names = "time;command;spool_position\n", numbers = "0;1,5;2\n1;2,5;3\n";
  for (const char* const below : {"ms;mA;mm\nclock;CH 1;CH 2\n", "clock;CH 1;CH 2\nms;mA;mm\n",
                                  "[ms];[mA];[mm]\nOffset;0;0\n", "ms;mA;mm\nScaleFactor;1;1\n"}) {
    const Log log = read(names + below + numbers, {}, {.minimum_rows = 2});
    EXPECT_EQ(log[Signal::command], (std::vector<double>{1.5e-3, 2.5e-3})) << below;
    EXPECT_TRUE(mentions(log, "1 row of other text below the header in line 1")) << below;
  }
  EXPECT_EQ(refusal(names + "ms;mA;mm\nScaleFactor;1;0,5\n" + numbers),
            "log.csv:3: the row 'ScaleFactor' below the header is not 1 for all columns; write it as gain or offset of "
            "these columns in the rig file, where the numbers are without it, and delete the row");
}

TEST(Log, ATimeThatNoClockShowsIsNoted) {
  const auto ticks = [](const char* gain) {
    const RigFile rig = rig_with(std::string("[columns]\ntime = { signal = \"time\", gain = \"") + gain + "\" }\n");
    std::string text = "time [us],command [mA],spool_position [mm]\n";
    for (int i = 0; i < 30; ++i) text += fmt::format("{},{},{}\n", 132590000000000000 + i * 10000, i % 7, i % 5);
    return read(text, rig);
  };
  EXPECT_TRUE(mentions(ticks("1"), "which no clock shows"));
  const Log log = ticks("0.1");  // of 100 ns since 1601
  EXPECT_FALSE(mentions(log, "which no clock shows"));
  EXPECT_NEAR(log.time[29] - log.time[0], 29e-3, 5e-6);
}

TEST(Log, ARowOfUnitsBelowTheHeaderReadsAsIfInIt) {
  const Log plain = read("time [s],command [mA],spool_position [mm]\n" + rows(30));
  for (const std::string& text : {"time,command,spool_position\ns,mA,mm\n" + rows(30),
                                  "time,command,spool_position\r\n[s],(mA),\"mm\"\r\n" + rows(30),
                                  "time,command [mA],spool_position\ns,mA,mm\n\n" + rows(30)}) {
    const Log log = read(text);
    EXPECT_TRUE(same_bits(log.time, plain.time)) << text.substr(0, 60);
    EXPECT_TRUE(same_bits(log[Signal::command], plain[Signal::command])) << text.substr(0, 60);
    EXPECT_TRUE(same_bits(log[Signal::spool_position], plain[Signal::spool_position])) << text.substr(0, 60);
  }
  EXPECT_EQ(refusal("time,command,spool_position\ns,mA\n" + rows(30)),
            "log.csv:1: column 'time': the header cell has no unit; write 'time [s]'; accepted: s, ms, us, min, h");
}

TEST(Log, LinesOfARecorderAboveTheHeaderAreLeftOutAndTold) {
  const std::string plain = "time [s];command [mA];spool_position [mm]\n0;1;2\n1;2;3\n";
  const Log log = read("Recorder 5;V2\nrate;1000\n\n" + plain, {}, {.minimum_rows = 2});
  EXPECT_TRUE(same_bits(log[Signal::command], read(plain, {}, {.minimum_rows = 2})[Signal::command]));
  ASSERT_EQ(log.notes.size(), 1u);
  EXPECT_NE(log.notes.front().text.find("log.csv: the header is in line 4; 2 rows of other text above it"),
            std::string::npos)
      << log.notes.front().text;
}

TEST(Log, AUnitThatTheTableHasNotIsTheRigFilesToReplace) {
  const Log plain = read("time [s],command [mA],spool_position [mm]\n" + rows(30));
  const RigFile rig = rig_with(
      "[columns]\ntime = { signal = \"time\", unit = \"s\" }\nspool_position = { signal = \"spool_position\", "
      "unit = \"mm\" }\n");
  for (const std::string& text : {"time [sec],command [mA],spool_position [MM]\n" + rows(30),
                                  "time,command,spool_position\nsec,mA,MM\n" + rows(30)}) {
    const Log log = read(text, rig);
    EXPECT_TRUE(same_bits(log.time, plain.time)) << text.substr(0, 60);
    EXPECT_TRUE(same_bits(log[Signal::spool_position], plain[Signal::spool_position])) << text.substr(0, 60);
  }
}

TEST(Log, ColumnOrderIsFree) {
  const Log log = read("spool_position [mm],time [s],command [mA]\n0.1,0,1\n0.2,1,2\n", {}, {.minimum_rows = 2});
  EXPECT_EQ(log.time, (std::vector<double>{0, 1}));
  EXPECT_EQ(log[Signal::command], (std::vector<double>{1e-3, 2e-3}));
  EXPECT_EQ(log[Signal::spool_position], (std::vector<double>{0.1e-3, 0.2e-3}));
}

TEST(Log, FurtherColumnsAreIgnoredWithOneNotice) {
  const Log log = read(
      "operator,time [s],command [mA],spool_position [mm],mood [furlong],\n\"Smith, J\",0,1,0.1,good,\n,1,2,0.2,bad,\n",
      {}, {.minimum_rows = 2});
  ASSERT_EQ(log.notes.size(), 1u);
  EXPECT_TRUE(mentions(log, "ignored 3 further columns: 'operator', 'mood', ''"));
}

TEST(Log, WhatIsWrittenInSiReadsBackBitForBit) {
  const TemporaryFolder folder;
  Random random(11);
  std::vector<double> time, x, p;
  for (int i = 0; i < 500; ++i) {
    time.push_back(i == 0 ? random.uniform() : time.back() + random.uniform());
    x.push_back(i % 40 == 7 ? NAN : random.normal() * 1e-4);
    p.push_back(random.uniform(0, 3e7));
  }
  const std::string path = folder / "log.csv";
  write_log(path, {{Signal::time, "s", time}, {Signal::command, "A", x}, {Signal::load_pressure, "Pa", p}}, {"a", "b"});
  const Log log = read_log(path);
  EXPECT_TRUE(same_bits(log.time, time));
  EXPECT_TRUE(same_bits(log[Signal::command], x));
  EXPECT_TRUE(same_bits(log[Signal::load_pressure], p));
  EXPECT_TRUE(read_file(path).starts_with("# a\n# b\ntime [s],command [A],load_pressure [Pa]\n"));
}

// Whatever the unit: a log read and written again is the same log, and stays tidy.
TEST(Log, WhatWasReadIsWrittenAndReadBackBitForBit) {
  const RigFile rig = rig_with("[valve]\nrated_current = \"37 mA\"\nspool_stroke = \"0.47 mm\"\n");
  Random random(12);
  for (const SignalInfo& signal : signal_list) {
    std::vector<std::string> names;
    const auto relative = relative_unit(signal.signal);
    for (const Unit& unit : unit_table())
      if (unit.dimension == signal.dimension || (relative && unit.dimension == relative->dimension))
        names.emplace_back(unit.name);
    for (const std::string& name : names) {
      if (signal.signal == Signal::time) continue;
      std::string text = fmt::format("time [ms],{} [{}]\n", signal.name, name);
      for (int i = 0; i < 300; ++i) text += fmt::format("{},{:.{}f}\n", i, random.uniform(-300, 300), i % 7);
      const ReadOptions any{.require_response = false, .require_drive = false};
      const Log log = read(text, rig, any);
      const TemporaryFolder folder;
      const std::string path = folder / "again.csv";
      write_log(path,
                {output_column(log, Signal::time, log.time), output_column(log, signal.signal, log[signal.signal])});
      const Log again = read_log(path, rig, any);
      EXPECT_TRUE(same_bits(again.time, log.time)) << name;
      EXPECT_TRUE(same_bits(again[signal.signal], log[signal.signal])) << signal.name << " " << name;
      EXPECT_LT(std::filesystem::file_size(path), text.size() + 20) << "untidy digits: " << name;
    }
  }
}

TEST(Log, AWriterRefusesAUnitThatIsNotTheSignals) {
  EXPECT_THROW(write_log("/dev/null", {{Signal::command, "mm", {}}}), InputError);
  EXPECT_THROW(write_log("/dev/null", {{Signal::command, "V", {}}}), InputError);
  EXPECT_THROW(write_log("/dev/null", {{Signal::command, "% of rated", {}}}), InputError);
}

TEST(Log, RelativeUnitsTakeTheirFactFromTheRigFile) {
  const RigFile rig = rig_with("[valve]\nrated_current = \"20 mA\"\nspool_stroke = \"0.5 mm\"\n");
  const std::string text = "time [s],command [% of rated],spool_position [% of stroke]\n0,100,-50\n1,25,10\n";
  const Log log = read(text, rig, {.minimum_rows = 2});
  EXPECT_EQ(log[Signal::command], (std::vector<double>{0.02, 0.005}));
  EXPECT_EQ(log[Signal::spool_position], (std::vector<double>{-0.25e-3, 0.05e-3}));
}

TEST(Log, ColumnsAreMappedWithGainAndOffset) {
  const RigFile rig = rig_with(R"([columns]
"Pos fb" = { signal = "piston_position", unit = "V", gain = "20 mm/V", offset = "-100 mm" }
"T" = { signal = "oil_temperature", gain = "10 degC/V", offset = "-20 degC" }
"i" = { signal = "command", unit = "mA", gain = "-1" }
"control_flow" = { signal = "control_flow", gain = -1 }
)");
  const Log log =
      read("time [s],i,Pos fb [V],T [V],control_flow [l/min]\n0,3,5,4,6\n1,-3,6,5,-6\n", rig, {.minimum_rows = 2});
  EXPECT_EQ(log[Signal::command], (std::vector<double>{-3e-3, 3e-3}));
  EXPECT_NEAR(log[Signal::piston_position][0], 0.0, 1e-15);
  EXPECT_NEAR(log[Signal::piston_position][1], 0.02, 1e-15);
  EXPECT_NEAR(log[Signal::oil_temperature][0], 293.15, 1e-12);
  EXPECT_NEAR(log[Signal::oil_temperature][1], 303.15, 1e-12);
  EXPECT_EQ(log[Signal::control_flow], (std::vector<double>{-1e-4, 1e-4}));
  EXPECT_EQ(log.channels[index(Signal::piston_position)].unit, "mm");
  EXPECT_EQ(log.channels[index(Signal::piston_position)].column, "Pos fb");
}

TEST(Log, EachRefusalNamesPlaceRuleAndMend) {
  const std::string currents = "A, mA, % of rated, or V with a gain in the rig file";
  const std::string mapping =
      ", or map one of yours in [columns] of a rig file and give that with --rig ('servodx init LOG' begins one)";
  const struct {
    std::string text, message;
  } cases[] = {
      {"", "log.csv: the file has no header row; begin it with a row of column names"},
      {"Time [s],command [mA],spool_position [mm]\n" + rows(30),
       "log.csv:1: column 'time': required signal is missing; add a column 'time [s]'" + mapping +
           "; not known: 'Time'; did you mean 'time' by 'Time'?"},
      {"time [s],spool_position [mm]\n",
       "log.csv:1: column 'command': required signal is missing, and so is 'coil_current'; add a column 'command [A]'" +
           mapping},
      {"# c\n\ntime [s],command [mA],pressure_a [bar],valve_pressure_drop [bar]\n",
       "log.csv:3: column 'spool_position': no response is logged (spool_position, piston_position, pressure_a with "
       "pressure_b, load_pressure or a flow); add a column 'spool_position [m]'" +
           mapping},
      {"time [s],command,spool_position [mm]\n",
       "log.csv:1: column 'command': the header cell has no unit; write 'command [A]'; accepted: " + currents},
      {"time [s],command [],spool_position [mm]\n",
       "log.csv:1: column 'command': unknown unit ''; accepted: " + currents},
      {"time [s],command [ma],spool_position [mm]\n",
       "log.csv:1: column 'command': unknown unit 'ma'; accepted: " + currents},
      {"time [s],command [bar],spool_position [mm]\n",
       "log.csv:1: column 'command': 'bar' is a unit of pressure, not of current; accepted: " + currents},
      {"time [V],command [mA],spool_position [mm]\n",
       "log.csv:1: column 'time': 'V' is a unit of voltage, not of time; accepted: s, ms, us, min, h"},
      {"time [s],command [V],spool_position [mm]\n",
       "log.csv:1: column 'command': volts need a gain; add \"command\" = { signal = \"command\", unit = \"V\", gain = "
       "\"... "
       "A/V\" } to [columns] of the rig file (--rig)"},
      {"time [s],command [% of rated],spool_position [mm]\n",
       "log.csv:1: column 'command': unit '% of rated' needs valve.rated_current; give it in the rig file (--rig) or "
       "write "
       "the column in A, mA"},
      {"time [s],command [mA],spool_position [% of stroke]\n",
       "log.csv:1: column 'spool_position': unit '% of stroke' needs valve.spool_stroke; give it in the rig file "
       "(--rig) or "
       "write the column in m, cm, mm, um, in"},
      {"time [s],command [mA],spool_position [mm],command [A]\n",
       "log.csv:1: column 'command': duplicate column; keep one column of the signal"},
      {header, "log.csv:1: the log has no rows; write one row a sample below the header"},
      {header + rows(5), "log.csv:6: the log has 5 rows, at least 20 are needed; record for longer"},
      {header + replace_row(4, "0.003,1,0.1\n"),
       "log.csv:6: column 'time': time does not increase: 0.003 s after 0.003 s; export times with more "
       "digits, or remove the repeated row"},
      {header + replace_row(4, "0.002,1,0.1\n"),
       "log.csv:6: column 'time': time does not increase: 0.002 s after 0.003 s; sort the rows, or cut the "
       "file where a recording begins"},
      {header + replace_row(4, "0.004,off,0.1\n"),
       "log.csv:6: column 'command': 'off' is not a number; write a number with a decimal point, or leave the cell "
       "empty"},
      {header + replace_row(4, "0.004,inf,0.1\n"),
       "log.csv:6: column 'command': 'inf' is not a number; write a number with a decimal point, or leave the cell "
       "empty"},
      {header + replace_row(4, "0.004,1\n"),
       "log.csv:6: ragged row: 2 cells, the header has 3; write one cell a column"},
      {header + replace_row(4, "0,004,1,1\n"),
       "log.csv:6: ragged row: 4 cells, the header has 3; write one cell a column; a decimal comma needs ';' as "
       "separator"},
      {header + replace_row(4, "# pause\n"),
       "log.csv:6: ragged row: 1 cells, the header has 3; write one cell a column"},
      {"time [s];command [mA];spool_position [um]\n1;1;57.800\n2;1;107,9\n",
       "log.csv:2: '57.800' has a point where other numbers have a decimal comma; write all numbers with one decimal "
       "sign, and thousands without a point"},
      {header + rows(30, [](int i, std::string row) { return i < 2 ? fmt::format("{},1,nan\n", i * 1e-3) : row; }),
       "log.csv:2: column 'spool_position': 2 of 30 samples are missing, more than 5 %; cut the log to where the "
       "signal is "
       "complete, or drop the column"},
      {header + rows(30, [](int i, std::string row) { return i < 2 ? ",1,2\n" : row; }),
       "log.csv:2: column 'time': 2 of 30 samples are missing, more than 5 %; give every row its time"},
  };
  for (const auto& c : cases) EXPECT_EQ(refusal(c.text), c.message);
}

TEST(Log, EachRefusalOfAMappingNamesPlaceRuleAndMend) {
  const RigFile rig =
      rig_with("[columns]\nx = { signal = \"spool_position\", unit = \"mm\" }\ni = { signal = \"command\" }\n");
  EXPECT_EQ(refusal("time [s],command [mA],x [um]\n", rig),
            "log.csv:1: column 'x': unit 'um' here, 'mm' in the rig file (line 2); make both agree");
  EXPECT_EQ(refusal("time [s],command [mA],x,spool_position [mm]\n", rig),
            "log.csv:1: column 'spool_position': duplicate column: 'x' is 'spool_position' too; keep one column of the "
            "signal");
  EXPECT_EQ(refusal("time [s],i,x\n", rig),
            "log.csv:1: column 'i': the header cell has no unit in square brackets, nor has the rig file; add unit = "
            "\"...\" to its line in [columns] (line 3); accepted: A, mA, % of rated, or V with a gain in the rig file");
}

TEST(Log, AnyOneResponseIsEnough) {
  for (const char* response : {"spool_position [mm]", "piston_position [mm]", "load_pressure [bar]", "flow_a [l/min]",
                               "flow_b [l/min]", "control_flow [gpm]", "leakage_flow [l/min]"})
    EXPECT_EQ(refusal(fmt::format("time [s],coil_current [mA],{}\n", response) + rows(30)), "accepted") << response;
  EXPECT_EQ(
      refusal("time [s],command [mA],pressure_a [bar],pressure_b [bar]\n0,1,2,3\n1,2,3,4\n", {}, {.minimum_rows = 2}),
      "accepted");
}

TEST(Log, MissingSamplesAreLeftOutAndCounted) {
  const Log log = read(header + replace_row(7, "0.007,nan,\n", 40));
  EXPECT_TRUE(std::isnan(log[Signal::spool_position][7]));
  EXPECT_EQ(log.channels[index(Signal::command)].missing, 1u);
  EXPECT_EQ(log.samples(), 40u);
  EXPECT_TRUE(mentions(log, "'spool_position': left out 1 of 40 samples"));
  const Log timeless = read(header + replace_row(7, ",1,2\n", 40));
  EXPECT_EQ(timeless.samples(), 39u);
  EXPECT_TRUE(mentions(timeless, "left out 1 of 40 rows without a time"));
}

TEST(Log, ALastLineWithoutLineEndIsReadIfWhole) {
  EXPECT_EQ(read(header + rows(30) + "0.03,1,0.25").samples(), 31u);
  for (const char* cut : {"0.03,1,0.2e", "0.03,1,", "0.03,1", "0.03,-", "0"}) {
    const Log log = read(header + rows(30) + cut);
    EXPECT_EQ(log.samples(), 30u) << cut;
    EXPECT_TRUE(mentions(log, ":32: dropped the last line: it is cut short and has no line end")) << cut;
    EXPECT_EQ(log.notes.size(), 1u) << cut;
  }
}

TEST(Log, ResolutionIsTheSmallestStep) {
  std::string text = header;
  Random random(4);
  for (int i = 0; i < 400; ++i)
    text += fmt::format("{},{},{:.3f}\n", i * 1e-3, i % 5, std::round(random.normal() * 8) * 0.004);
  EXPECT_NEAR(read(text).channels[index(Signal::spool_position)].resolution, 4e-6, 1e-12);
}

std::string noisy(int n, const std::function<double(int, double)>& spool) {
  Random random(9);
  std::string text = header;
  for (int i = 0; i < n; ++i) {
    const double u = 10 * std::sin(0.05 * i);
    text += fmt::format("{},{:.4f},{:.5f}\n", i * 1e-3, u, spool(i, 0.025 * u + 0.001 * random.normal()));
  }
  return text;
}

TEST(Log, ImplausibleValuesAreReadAndWarnedOf) {
  EXPECT_TRUE(read(noisy(1000, [](int, double x) { return x; })).notes.empty());
  EXPECT_TRUE(
      mentions(read(noisy(1000, [](int, double) { return 0.1; })), "'spool_position': never changes: frozen sensor?"));
  EXPECT_TRUE(mentions(read(noisy(1000, [](int i, double x) { return i > 600 ? 0.1 : x; })),
                       "'spool_position': frozen sensor? It does not change for 0.398 s from 0.601 s on"));
  EXPECT_TRUE(mentions(read(noisy(1000, [](int i, double x) { return i == 300 || i == 500 ? x + 2 : x; })),
                       "'spool_position': 2 spikes of a single sample, the first at 0.3 s"));
  EXPECT_TRUE(mentions(read(noisy(1000, [](int, double x) { return 1000 * x; })), "check unit, gain and offset"));
  EXPECT_TRUE(mentions(read(header + rows(30, [](int i, std::string) { return fmt::format("{},2,{}\n", i, i % 5); })),
                       "'command': no excitation: it stays at 0.002 A"));
  std::string piston = noisy(1000, [](int, double x) { return x; });
  piston.replace(piston.find("spool_position"), 14, "piston_position");
  EXPECT_TRUE(mentions(read(piston, rig_with("[actuator]\nstroke = \"2000 mm\"\n")),
                       "'piston_position': moves 0.025 % of the stroke: check unit and gain"));
  EXPECT_FALSE(mentions(read(piston, rig_with("[actuator]\nstroke = \"200 mm\"\n")), "of the stroke"));
  EXPECT_TRUE(mentions(read(header + rows(30) + "0.05,1,0.1\n"),
                       "1 gap in time, the longest 0.021 s at a usual step of 0.001 s"));
}

TEST(Log, WhatTheReaderNotesHasItsKind) {
  const auto notes = [](const std::string& text, Note::Kind kind, const RigFile& rig = {}) {
    const Log log = read(text, rig);
    return std::any_of(log.notes.begin(), log.notes.end(), [&](const Note& note) { return note.kind == kind; });
  };
  const std::string plain = header + rows(30);
  for (int k = 0; k < n_note_kinds; ++k) EXPECT_FALSE(notes(plain, static_cast<Note::Kind>(k))) << k;
  EXPECT_TRUE(notes(plain + "0.03,1,", Note::Kind::left_out));
  EXPECT_TRUE(notes(plain + "0.05,1,0.1\n", Note::Kind::gaps));
  EXPECT_TRUE(notes(noisy(1000, [](int, double) { return 0.1; }), Note::Kind::implausible));
  const std::string moody = "time [s],command [mA],spool_position [mm],mood\n" +
                            rows(30, [](int, std::string row) { return row.insert(row.size() - 1, ",9"); });
  EXPECT_TRUE(notes(moody, Note::Kind::ignored_columns));
  const RigFile rig = rig_with("[columns]\nPs = { signal = \"supply_pressure\", unit = \"bar\" }\n");
  EXPECT_TRUE(notes(plain, Note::Kind::unmapped_column, rig));
}

// Logs of a foreign rig; not part of this project.
TEST(ForeignLogs, OfRigAAllRead) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(SERVODX_SHARED_DIR) / "data/rig_A";
  if (!fs::exists(folder / "rig.toml")) GTEST_SKIP() << folder << " is absent";
  const RigFile rig = read_rig_file(folder / "rig.toml");
  EXPECT_EQ(rig.fact("valve.rated_current"), 0.02);
  int logs = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv" || entry.path().filename() == "truth.csv") continue;
    ++logs;
    const Log log = read_log(entry.path(), rig);
    EXPECT_GT(log.samples(), 500u) << entry.path();
    for (Signal s :
         {Signal::command, Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b,
          Signal::supply_pressure, Signal::return_pressure, Signal::load_force, Signal::oil_temperature})
      EXPECT_EQ(log[s].size(), log.samples()) << entry.path() << info(s).name;
    EXPECT_LE(log.notes.size(), 1u) << entry.path();
  }
  EXPECT_EQ(logs, 252);
}

TEST(ForeignLogs, OfTheRealServovalveAllRead) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(SERVODX_SHARED_DIR) / "data/real/servovalve_static";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is absent";
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".csv") {
      EXPECT_NO_THROW(read_log(entry.path())) << entry.path();
    }
}

// As a file and as arrays; the stated limit itself takes gigabytes.
TEST(LogRows, OfMoreThanTheLimitAreRefusedAtTheFirstBeyond) {
  const RigFile rig;
  const ReadOptions options;
  const auto columns = [&] {
    LogColumns log("log.csv", rig, options, {.most_rows = 30});
    log.add("time [s]", 1), log.add("command [mA]", 1), log.add("spool_position [mm]", 1);
    return log;
  };
  const auto refused = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  std::vector<double> x(31);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = static_cast<double>(k);
  LogColumns by_row = columns(), by_column = columns();
  for (long k = 0; k < 30; ++k) by_row.append(std::array{x[k], 1.0, 2.0}, k + 2);
  EXPECT_EQ(refused([&] {
              by_row.append(std::array{x[30], 1.0, 2.0}, 32);
            }),
            "log.csv:32: the log has more than 30 rows; cut it into shorter ones");
  EXPECT_EQ(refused([&] {
              by_column.append_columns({x, x, x});
            }),
            "log.csv: the log has more than 30 rows; cut it into shorter ones");
  EXPECT_EQ(most_rows_of_a_log, 100'000'000u);  // as docs/logs.md states
}

}  // namespace
}  // namespace servodx
