// `init` takes what a log's header and values say, asks what they do not, and refuses what is no log.
#include <gtest/gtest.h>
#include <matio.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "program.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

// The columns of a shipped log: time [s], command [mA], spool [mm], piston [mm], pressures A, B, S, T [bar].
std::vector<std::vector<double>> columns_of(const std::string& name, int rows) {
  std::istringstream in(excerpt(name, rows));
  const char* const wanted[] = {"time",       "command",    "spool_position",  "piston_position",
                                "pressure_a", "pressure_b", "supply_pressure", "return_pressure"};
  std::vector<std::vector<double>> columns(8);
  std::vector<int> to;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t c = 0; std::getline(cells, cell, ','); ++c)
      if (to.size() <= c) {
        to.push_back(-1);
        for (int k = 0; k < 8; ++k)
          if (cell.starts_with(std::string(wanted[k]) + " [")) to[c] = k;
      } else if (to[c] >= 0) {
        columns[static_cast<std::size_t>(to[c])].push_back(std::stod(cell));
      }
  }
  return columns;
}

struct Foreign {
  std::vector<std::string> header;
  std::vector<int> order = {0, 1, 2, 3, 4, 5, 6, 7};
  std::function<double(int, double)> change = [](int, double x) { return x; };
};

std::string text_of(const Foreign& f) {
  static const auto columns = columns_of("healthy/h12_mixed.csv", 100000);
  std::string text;
  for (std::size_t c = 0; c < f.header.size(); ++c) text += (c ? "," : "") + f.header[c];
  text += '\n';
  for (std::size_t k = 0; k < columns[0].size(); ++k)
    for (std::size_t c = 0; c < f.header.size(); ++c)
      text += std::to_string(f.change(f.order[c], columns[static_cast<std::size_t>(f.order[c])][k])) +
              (c + 1 < f.header.size() ? "," : "\n");
  return text;
}

struct Made {
  Ended ended;
  Json result;
  std::string rig;
  // The question about a column, empty where it has none.
  std::string question(const std::string& cell) const {
    for (const Json& c : result["columns"])
      if (c["column"] == cell) return c["question"].is_null() ? "" : c["question"].get<std::string>();
    return "no such column";
  }
};

Made init(const std::string& text) {
  const Desk desk;
  desk.write("log.csv", text);
  Made made{desk.run("init log.csv --json r.json"), {}, {}};
  EXPECT_EQ(made.ended.code, 0) << made.ended.err;
  if (made.ended.code == 0)
    made.result = Json::parse(bytes_of(desk / "r.json")), made.rig = bytes_of(desk / "rig.toml");
  return made;
}

const std::vector<std::string> plain = {"time [s]", "cmd [mA]", "spool [mm]", "piston [mm]",
                                        "pA [bar]", "pB [bar]", "pS [bar]",   "pT [bar]"};

TEST(Init, WhatIsPlainIsTakenWithoutAQuestion) {
  const Made made = init(text_of({plain}));
  EXPECT_EQ(made.result["questions"], 0) << made.ended.out;
  EXPECT_NE(made.ended.out.find("the log reads with it: "), std::string::npos) << made.ended.out;
}

TEST(Init, ExchangedColumnsAreAskedAndLeftOut) {
  const std::pair<int, int> pairs[] = {{6, 5}, {4, 5}, {4, 7}, {2, 3}};
  for (const auto& [a, b] : pairs) {
    Foreign f{plain};
    std::swap(f.header[static_cast<std::size_t>(a)], f.header[static_cast<std::size_t>(b)]);
    const Made made = init(text_of(f));
    for (const int c : {a, b}) {
      const std::string& cell = plain[static_cast<std::size_t>(c)];
      EXPECT_NE(made.question(cell), "") << cell << "\n" << made.ended.out;
      EXPECT_NE(made.rig.find("\n# \"" + cell + "\" = {"), std::string::npos) << made.rig;
    }
    EXPECT_EQ(made.ended.out.find("the log reads with it"), std::string::npos) << made.ended.out;
    EXPECT_NE(made.ended.out.find("open, each a line with '# ?'"), std::string::npos) << made.ended.out;
  }
}

TEST(Init, ATurnedCommandIsAsked) {
  const Made made = init(text_of({plain, {0, 1, 2, 3, 4, 5, 6, 7}, [](int c, double x) { return c == 1 ? -x : x; }}));
  EXPECT_NE(made.question("spool [mm]").find("runs against the drive"), std::string::npos) << made.ended.out;
}

TEST(Init, NothingAbsurdIsAnActiveLine) {
  const Made made = init(text_of(
      {{"time [s]", "current [A]", "spool [mm]", "piston [m]", "pA [Pa]", "pB [kp/cm2]", "pS [bara]", "temp [K]"},
       {0, 1, 2, 3, 4, 5, 6, 7},
       [](int c, double x) { return c == 1   ? std::abs(x) * 400
                                    : c == 3 ? x * 1e-6
                                    : c == 7 ? 12429
                                             : x; }}));
  for (const char* cell : {"current [A]", "piston [m]", "pA [Pa]", "pB [kp/cm2]", "pS [bara]", "temp [K]"}) {
    EXPECT_NE(made.question(cell), "") << cell << "\n" << made.ended.out;
    EXPECT_EQ(made.rig.find("\n\"" + std::string(cell)), std::string::npos) << made.rig;
  }
  EXPECT_NE(made.question("pB [kp/cm2]").find("unknown unit 'kp/cm2'"), std::string::npos);
}

TEST(Init, TicksOfADateAreReadAsSeconds) {
  std::string text = "Timestamp,Current [mA],Spool [mm]\n";
  for (int k = 0; k < 60; ++k)
    text += std::to_string(132590000000000000 + 10000L * k) + "," + std::to_string(k % 7 - 3) + "," +
            std::to_string(0.01 * (k % 5)) + "\n";
  const Made made = init(text);
  EXPECT_NE(made.rig.find("\n\"Timestamp\" = { signal = \"time\", unit = \"us\", gain = \"0.1\" }"), std::string::npos)
      << made.rig;
  EXPECT_NE(made.ended.out.find("'Timestamp' in 0.1 us"), std::string::npos) << made.ended.out;
}

TEST(Init, ATransmittersMilliamperesAreAskedForGainAndOffset) {
  const Made made =
      init(text_of({{"time [s]", "cmd [mA]", "spool [mm]", "piston [mA]"}, {0, 1, 2, 3}, [](int c, double x) {
                      return c == 3 ? 12 + x / 100 : x;
                    }}));
  EXPECT_NE(made.rig.find("\n# \"piston [mA]\" = { signal = \"piston_position\", gain = \"?\", offset = \"?\" }"),
            std::string::npos)
      << made.rig;
  EXPECT_NE(made.ended.out.find("the log can be read"), std::string::npos) << made.ended.out;
}

TEST(Init, VoltsAreRefusedUntilTheGainIsGiven) {
  const Desk desk;
  desk.write("log.csv", text_of({{"time [s]", "Valve Command (V)", "spool [mm]"}, {0, 1, 2}}));
  const Ended made = desk.run("init log.csv");
  EXPECT_EQ(bytes_of(desk / "rig.toml").find("A/V\""), std::string::npos);
  EXPECT_NE(made.out.find("to be mended in rig.toml"), std::string::npos) << made.out;
  EXPECT_EQ(made.out.find("the log reads with it"), std::string::npos) << made.out;
  const Ended checked = desk.run("check-log log.csv --rig rig.toml");
  EXPECT_EQ(checked.code, 2);
  EXPECT_NE(checked.err.find("volts need a gain"), std::string::npos) << checked.err;
}

TEST(Init, ReadsMatFiles) {
  const Desk desk;
  mat_t* file = Mat_CreateVer((desk / "log.mat").c_str(), nullptr, MAT_FT_MAT5);
  const auto columns = columns_of("healthy/h12_mixed.csv", 2000);
  const char* const names[] = {"t", "i_cmd", "spool"};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> values = columns[k];
    for (double& x : values) x *= k == 0 ? 1 : 1e-3;
    std::size_t shape[2] = {values.size(), 1};
    matvar_t* v = Mat_VarCreate(names[k], MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape, values.data(), 0);
    Mat_VarWrite(file, v, MAT_COMPRESSION_NONE);
    Mat_VarFree(v);
  }
  Mat_Close(file);
  const Ended made = desk.run("init log.mat");
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string rig = bytes_of(desk / "rig.toml");
  EXPECT_NE(rig.find("\n\"t\" = { signal = \"time\", unit = \"s\" }"), std::string::npos) << rig;
  EXPECT_NE(rig.find("\"spool\" = { signal = \"spool_position\", unit = \"m\" }"), std::string::npos) << rig;
}

TEST(Init, WhatIsNoLogIsRefusedAndNothingWritten) {
  const Desk desk;
  const std::string rest(200, '\0');
  const std::pair<const char*, std::string> files[] = {{"a.xlsx", "PK\x03\x04" + rest},
                                                       {"b.tdms", "TDSm" + rest},
                                                       {"c.csv", "\x89HDF\r\n\x1a\n" + rest},
                                                       {"d.csv", "0,1,2\n1,1,2\n"},
                                                       {"g.csv", "t [s],i [mA],x [mm]\n0,0,1,5,2,5\n0,1,1,5,2,5\n"},
                                                       {"h.csv", "t [s],i [mA]\n0,1\n1,2\nt [s],i [mA]\n0,1\n"},
                                                       {"i.csv", "t [s],i [mA]\n0,1\n1,2,5\n"},
                                                       {"j.csv", "t [s],i [mA]\r0,1\r1,2\r"},
                                                       {"e.mat", "no MAT file at all, but words"},
                                                       {"f.csv", "run\n\"a\" b\n" + std::string(20000, ',') + "\n"}};
  for (const auto& [name, bytes] : files) {
    desk.write(name, bytes);
    const auto before = desk.contents();
    for (const std::string& call : {"init " + std::string(name), "check-log " + std::string(name)}) {
      const Ended ended = desk.run(call);
      EXPECT_EQ(ended.code, 2) << call;
      EXPECT_NE(ended.err.find(std::string(name) + ":"), std::string::npos) << ended.err;
      EXPECT_EQ(desk.contents(), before) << call;
    }
  }
}

}  // namespace
}  // namespace servodx
