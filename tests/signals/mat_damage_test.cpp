// A MAT file that is damaged or made to harm is refused by name; the program goes on.
#include <gtest/gtest.h>
#include <matio.h>
#include <seccomp.h>
#include <sys/prctl.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <random>

#include "base/csv.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

struct Kind {
  const char* name;
  mat_ft level;
  matio_compression packing;
  bool in_structure;
};
void PrintTo(const Kind& kind, std::ostream* to) { *to << kind.name; }

constexpr Kind kinds[] = {{"Level4", MAT_FT_MAT4, MAT_COMPRESSION_NONE, false},
                          {"Level5", MAT_FT_MAT5, MAT_COMPRESSION_NONE, false},
                          {"Level5Packed", MAT_FT_MAT5, MAT_COMPRESSION_ZLIB, false},
                          {"Level5Structure", MAT_FT_MAT5, MAT_COMPRESSION_NONE, true},
                          {"Level73", MAT_FT_MAT73, MAT_COMPRESSION_NONE, false},
                          {"Level73Structure", MAT_FT_MAT73, MAT_COMPRESSION_NONE, true}};

matvar_t* vector_of(const char* name, double step) {
  constexpr std::size_t rows = 24;
  double x[rows];
  for (std::size_t k = 0; k < rows; ++k) x[k] = step * static_cast<double>(k);
  std::size_t shape[2] = {rows, 1};
  return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape, x, 0);
}

// The bytes of a valid file of three signals.
std::string valid(const Kind& kind, const TemporaryFolder& folder) {
  const std::string path = folder / "valid.mat";
  const char* names[] = {"t", "i", "x"};
  const double steps[] = {0.001, 0.01, 0.1};
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, kind.level);
  std::size_t one[2] = {1, 1};
  matvar_t* all = kind.in_structure ? Mat_VarCreateStruct("data", 2, one, names, 3) : nullptr;
  for (int k = 0; k < 3; ++k) {
    matvar_t* v = vector_of(names[k], steps[k]);
    if (all) {
      Mat_VarSetStructFieldByIndex(all, static_cast<std::size_t>(k), 0, v);
      continue;
    }
    Mat_VarWrite(file, v, kind.packing);
    Mat_VarFree(v);
  }
  if (all) {
    Mat_VarWrite(file, all, kind.packing);
    Mat_VarFree(all);
  }
  Mat_Close(file);
  return read_file(path);
}

RigFile rig_of(const Kind& kind, const TemporaryFolder& folder) {
  const std::string in = kind.in_structure ? "data." : "";
  return read_rig_file(folder.write("rig.toml", "[columns]\n\"" + in + "t\" = { signal = \"time\", unit = \"s\" }\n\"" +
                                                    in + "i\" = { signal = \"command\", unit = \"A\" }\n\"" + in +
                                                    "x\" = { signal = \"spool_position\", unit = \"m\" }\n"));
}

// Empty: the file was read.
std::string refusal_of(const std::string& path, const RigFile& rig) {
  try {
    read_log(path, rig);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

class DamagedMat : public testing::TestWithParam<Kind> {};

TEST_P(DamagedMat, CutOffAtAnyLengthIsRefusedByName) {
  const TemporaryFolder folder;
  const std::string bytes = valid(GetParam(), folder);
  const RigFile rig = rig_of(GetParam(), folder);
  ASSERT_EQ(refusal_of(folder / "valid.mat", rig), "");
  // A file of HDF5 is long and a structure is cut as its fields are: a prime step meets every part.
  const std::size_t step = GetParam().level == MAT_FT_MAT73 ? 37 : GetParam().in_structure ? 7 : 1;
  for (std::size_t length = 0; length < bytes.size(); length += step) {
    const std::string path = folder.write("log.mat", bytes.substr(0, length));
    EXPECT_TRUE(refusal_of(path, rig).starts_with(path)) << "cut at " << length << " of " << bytes.size();
  }
}

TEST_P(DamagedMat, AnyByteTurnedIsReadOrRefusedByName) {
  const TemporaryFolder folder;
  const std::string bytes = valid(GetParam(), folder);
  const RigFile rig = rig_of(GetParam(), folder);
  std::mt19937 draw(1);
  for (int k = 0; k < 150; ++k) {
    std::string damaged = bytes;
    // Sizes and names stand in the first bytes of a part; a few turned at once reach what one alone does not.
    for (int turned = 0; turned <= k % 3; ++turned)
      damaged[draw() % damaged.size()] = static_cast<char>(k % 2 ? draw() : (draw() & 1) * 0xFF);
    const std::string path = folder.write("log.mat", damaged);
    const std::string refusal = refusal_of(path, rig);
    EXPECT_TRUE(refusal.empty() || refusal.starts_with(path)) << refusal;
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryLevel, DamagedMat, testing::ValuesIn(kinds),
                         [](const testing::TestParamInfo<Kind>& kind) { return kind.param.name; });

TEST(MatSizes, AVariableOfMoreSamplesThanItsBytesHoldIsNoSignal) {
  const TemporaryFolder folder;
  const Kind& plain = kinds[1];
  std::string bytes = valid(plain, folder);
  // The dimensions of the first matrix: after its tag (8), flags (16) and their own tag (8).
  const std::size_t rows = 128 + 8 + 16 + 8;
  ASSERT_EQ(bytes[rows], 24);
  for (const unsigned claimed : {25u, 4000u, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
    for (std::size_t b = 0; b < 4; ++b) bytes[rows + b] = static_cast<char>(claimed >> 8 * b);
    const std::string path = folder.write("log.mat", bytes);
    EXPECT_TRUE(refusal_of(path, rig_of(plain, folder)).starts_with(path)) << claimed;
  }
}

// The system says no to filters, as some containers do: the other limits hold, and the log says what did not.
TEST(MatBox, AFileReadWithoutAFilterOfSystemCallsSaysSo) {
  const TemporaryFolder folder;
  const Kind& plain = kinds[1];
  valid(plain, folder);
  const RigFile rig = rig_of(plain, folder);
  const auto unguarded = [&] {
    const std::vector<Note> notes = read_log(folder / "valid.mat", rig).notes;
    return std::any_of(notes.begin(), notes.end(), [](const Note& n) {
      return n.kind == Note::Kind::unguarded && n.text.find("without a filter of system calls") != std::string::npos;
    });
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // reading makes threads, which a fork does not take along
  if (unguarded()) GTEST_SKIP() << "this system refuses filters anyway";
  EXPECT_EXIT(
      {
        const scmp_filter_ctx no_filters = seccomp_init(SCMP_ACT_ALLOW);
        seccomp_rule_add(no_filters, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(seccomp), 0);
        seccomp_rule_add(no_filters, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(prctl), 1,
                         scmp_arg_cmp{0, SCMP_CMP_EQ, PR_SET_SECCOMP, 0});
        seccomp_load(no_filters);
        std::_Exit(unguarded() ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace servodx
