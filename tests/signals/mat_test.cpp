// MAT logs follow the rules of CSV logs: names are signals, units come from the rig file.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "base/sha256.h"
#include "servodx/error.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

using Vectors = std::vector<std::pair<std::string, std::vector<double>>>;

matvar_t* column(const std::string& name, const std::vector<double>& x) {
  std::size_t shape[2] = {x.size(), 1};
  return Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape, const_cast<double*>(x.data()), 0);
}

void write_mat(const std::string& path, const Vectors& vectors, mat_ft level = MAT_FT_MAT5) {
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, level);
  for (const auto& [name, x] : vectors) {
    matvar_t* v = column(name, x);
    Mat_VarWrite(file, v, MAT_COMPRESSION_ZLIB);
    Mat_VarFree(v);
  }
  Mat_Close(file);
}

constexpr const char* rig_text = R"([columns]
"t" = { signal = "time", unit = "ms" }
"i" = { signal = "command", unit = "mA" }
"xs" = { signal = "spool_position", gain = "0.1 mm/V" }
)";

RigFile rig_of(const TemporaryFolder& folder, const std::string& text = rig_text) {
  return read_rig_file(folder.write("rig.toml", text));
}

Vectors plain(int n = 30) {
  Vectors v = {{"t", {}}, {"i", {}}, {"xs", {}}};
  for (int k = 0; k < n; ++k) {
    v[0].second.push_back(k);
    v[1].second.push_back(k % 7 - 3);
    v[2].second.push_back(0.01 * ((k * 5) % 11));
  }
  return v;
}

TEST(Mat, VariablesArriveInSiAtEveryLevelOfTheFormat) {
  for (mat_ft level : {MAT_FT_MAT4, MAT_FT_MAT5, MAT_FT_MAT73}) {
    const TemporaryFolder folder;
    const std::string path = folder / "log.mat";
    Vectors v = plain();
    v.push_back({"gain_setting", {3.0}});
    write_mat(path, v, level);
    const Log log = read_log(path, rig_of(folder));
    ASSERT_EQ(log.samples(), 30u) << level;
    EXPECT_EQ(log.time[3], 0.003);
    EXPECT_EQ(log[Signal::command][0], -3e-3);
    EXPECT_DOUBLE_EQ(log[Signal::spool_position][1], 0.05 * 1e-4);
    EXPECT_EQ(log.sha256, sha256_of_file(path));
    ASSERT_FALSE(log.notes.empty());
    EXPECT_EQ(log.notes[0].kind, Note::Kind::ignored_columns);
    EXPECT_NE(log.notes[0].text.find("ignored 1 further variable: 'gain_setting'"), std::string::npos)
        << log.notes[0].text;
  }
}

TEST(Mat, RowsIntegersSinglesAndAStructureReadAlike) {
  const TemporaryFolder folder;
  const std::string path = folder / "LOG.MAT";
  const Vectors v = plain();
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
  std::vector<float> t(v[0].second.begin(), v[0].second.end());
  std::vector<std::int16_t> i(v[1].second.begin(), v[1].second.end());
  std::size_t row[2] = {1, 30}, one[2] = {1, 1};
  const char* fields[] = {"t", "i", "xs"};
  matvar_t* data = Mat_VarCreateStruct("data", 2, one, fields, 3);
  Mat_VarSetStructFieldByName(data, "t", 0, Mat_VarCreate(nullptr, MAT_C_SINGLE, MAT_T_SINGLE, 2, row, t.data(), 0));
  Mat_VarSetStructFieldByName(data, "i", 0, Mat_VarCreate(nullptr, MAT_C_INT16, MAT_T_INT16, 2, row, i.data(), 0));
  Mat_VarSetStructFieldByName(data, "xs", 0, column("xs", v[2].second));
  Mat_VarWrite(file, data, MAT_COMPRESSION_NONE);
  Mat_VarFree(data);
  Mat_Close(file);
  const Log log = read_log(path, rig_of(folder, R"([columns]
"data.t" = { signal = "time", unit = "ms" }
"data.i" = { signal = "command", unit = "mA" }
"data.xs" = { signal = "spool_position", gain = "0.1 mm/V" }
)"));
  EXPECT_EQ(log.samples(), 30u);
  EXPECT_EQ(log[Signal::command][1], -2e-3);
}

// A matrix of the three signals, and the texts that name its columns.
void write_matrix(const std::string& path, const Vectors& v, bool named) {
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
  std::vector<double> all;
  for (const auto& each : v) all.insert(all.end(), each.second.begin(), each.second.end());
  std::size_t shape[2] = {v[0].second.size(), v.size()}, cells[2] = {v.size(), 1};
  matvar_t* matrix = Mat_VarCreate("run", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape, all.data(), 0);
  Mat_VarWrite(file, matrix, MAT_COMPRESSION_NONE);
  Mat_VarFree(matrix);
  if (named) {
    matvar_t* names = Mat_VarCreate("names", MAT_C_CELL, MAT_T_CELL, 2, cells, nullptr, 0);
    for (std::size_t k = 0; k < v.size(); ++k) {
      std::size_t letters[2] = {1, v[k].first.size()};
      Mat_VarSetCell(
          names, static_cast<int>(k),
          Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UINT8, 2, letters, const_cast<char*>(v[k].first.data()), 0));
    }
    Mat_VarWrite(file, names, MAT_COMPRESSION_NONE);
    Mat_VarFree(names);
  }
  Mat_Close(file);
}

TEST(Mat, AMatrixIsItsColumnsByNameOrByNumber) {
  const TemporaryFolder folder;
  write_matrix(folder / "named.mat", plain(), true);
  const Log named = read_log(folder / "named.mat", rig_of(folder));
  EXPECT_EQ(named.samples(), 30u);
  EXPECT_EQ(named[Signal::command][1], -2e-3);
  write_matrix(folder / "bare.mat", plain(), false);
  const Log bare = read_log(folder / "bare.mat", rig_of(folder, R"toml([columns]
"run(:,1)" = { signal = "time", unit = "ms" }
"run(:,2)" = { signal = "command", unit = "mA" }
"run(:,3)" = { signal = "spool_position", unit = "mm" }
)toml"));
  EXPECT_EQ(bare.time[3], 0.003);
  EXPECT_EQ(bare[Signal::command][1], -2e-3);
}

TEST(Mat, ABillionRowsOfNoLettersAreNoListOfNamesAndCostNothing) {
  const TemporaryFolder folder;
  const std::string path = folder / "log.mat";
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
  std::size_t shape[2] = {std::size_t{1} << 30, 0};
  matvar_t* list = Mat_VarCreate("names", MAT_C_CHAR, MAT_T_UINT8, 2, shape, nullptr, 0);
  Mat_VarWrite(file, list, MAT_COMPRESSION_NONE);
  Mat_VarFree(list);
  for (const auto& [name, x] : plain()) {
    matvar_t* v = column(name, x);
    Mat_VarWrite(file, v, MAT_COMPRESSION_NONE);
    Mat_VarFree(v);
  }
  Mat_Close(file);
  EXPECT_EQ(read_log(path, rig_of(folder)).samples(), 30u);
}

TEST(Mat, MissingSamplesAreCountedAndLeftOut) {
  const TemporaryFolder folder;
  Vectors v = plain(40);
  v[2].second[7] = NAN;
  write_mat(folder / "log.mat", v);
  const Log log = read_log(folder / "log.mat", rig_of(folder));
  EXPECT_TRUE(std::isnan(log[Signal::spool_position][7]));
  EXPECT_EQ(log.channels[index(Signal::spool_position)].missing, 1u);
}

TEST(Mat, EachRefusalNamesVariableRuleAndMend) {
  const auto refusal = [](const Vectors& v, const std::string& rig = rig_text) -> std::string {
    const TemporaryFolder folder;
    const std::string path = folder / "log.mat";
    write_mat(path, v);
    try {
      read_log(path, rig_of(folder, rig));
    } catch (const InputError& error) {
      const std::string what = error.what();
      return what.starts_with(path) ? "log.mat" + what.substr(path.size()) : what;
    }
    return "accepted";
  };
  Vectors v = plain();
  EXPECT_EQ(refusal(v), "accepted");
  EXPECT_EQ(refusal(v, "[columns]\n\"t\" = { signal = \"time\" }\n"),
            "log.mat: column 't': the variable has no unit; add \"t\" = { signal = \"time\", unit = \"s\" } to "
            "[columns] of the rig file (--rig); accepted: s, ms, us, min, h");
  EXPECT_EQ(refusal({v[0], v[2]}),
            "log.mat: column 'command': required signal is missing, and so is 'coil_current'; add a variable "
            "'command', or map one of yours in [columns] of the rig file");
  v[1].second.pop_back();
  EXPECT_EQ(refusal(v),
            "log.mat: column 'i': has 29 samples, the time has 30; save signals of one length; for a second recorder "
            "see 'servodx join'");
  v = plain();
  v[0].second[9] = 8;
  EXPECT_EQ(refusal(v),
            "log.mat: column 't': sample 10: time does not increase: 0.008 s after 0.008 s; export times with more "
            "digits, or remove the repeated row");
  v = plain();
  v[2].second[4] = INFINITY;
  EXPECT_EQ(refusal(v), "log.mat: column 'xs': sample 5: is infinite; write NaN for a missing sample");
  v = plain();
  v[2].second[4] = v[2].second[5] = NAN;
  EXPECT_EQ(refusal(v),
            "log.mat: column 'xs': sample 5: 2 of 30 samples are missing, more than 5 %; cut the log to where the "
            "signal is complete, or drop the column");
  EXPECT_EQ(refusal(plain(5)), "log.mat: the log has 5 rows, at least 20 are needed; record for longer");
}

TEST(Mat, WhatIsNoMatFileIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.write("log.mat", "time [s],command [mA]\n");
  try {
    read_log(path);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), path + ": is not a MAT file; save it with MATLAB's 'save', or write a CSV log");
  }
  EXPECT_THROW(read_log(folder / "none.mat"), InputError);
}

// A benchmark of a motor-driven slide; not part of this project.
TEST(ForeignLogs, OfAMotorDrivenSlideReads) {
  const std::filesystem::path path = std::filesystem::path(SERVODX_SHARED_DIR) / "data/real/emps/DATA_EMPS.mat";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
  const TemporaryFolder folder;
  const Log log = read_log(path, rig_of(folder, R"([columns]
"t" = { signal = "time", unit = "s" }
"vir" = { signal = "command", gain = "1 mA/V" }
"qm" = { signal = "piston_position", unit = "m" }
"qg" = { signal = "setpoint", unit = "m" }
)"));
  EXPECT_EQ(log.samples(), 24841u);
  EXPECT_NEAR(log.time.back() - log.time.front(), 24.84, 1e-6);
}

}  // namespace
}  // namespace servodx
