// A MAT library that does what it must not, or is not there: the program refuses the file by name, and goes by the
// rest.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "program.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

// The program with another library in the place of libmatio, as the loader finds it.
class WithLibrary {
 public:
  explicit WithLibrary(const std::string& folder) { ::setenv("LD_LIBRARY_PATH", folder.c_str(), 1); }
  ~WithLibrary() { ::unsetenv("LD_LIBRARY_PATH"); }
  WithLibrary(const WithLibrary&) = delete;
  WithLibrary& operator=(const WithLibrary&) = delete;
};

// Of level 4: one matrix of nothing, named as what the library is to do (tests/cli/hostile/matio.cpp).
std::string file_named(const std::string& deed) {
  std::string bytes(20, '\0');
  bytes[16] = static_cast<char>(deed.size() + 1);
  return bytes + deed + '\0';
}

TEST(MatBoxOfTheProgram, WhateverTheLibraryDoesTheFileIsRefusedByName) {
  const WithLibrary hostile(SERVODX_HOSTILE_MATIO);
  struct Case {
    const char *deed, *told;
  };
  for (const Case& c : {Case{"socket", "ask the system for what reading does not need"},
                        Case{"program", "ask the system for what reading does not need"},
                        Case{"crash", "the MAT library crashed on it"}, Case{"loop", "s of processor"},
                        Case{"memory", "it asks for more than"}, Case{"quiet", "cannot be read"}}) {
    const Desk desk;
    desk.write("log.mat", file_named(c.deed));
    const Ended ended = desk.run("check-log log.mat");
    EXPECT_EQ(ended.code, 2) << c.deed;
    EXPECT_TRUE(ended.err.starts_with("servodx: log.mat: ")) << c.deed << ": " << ended.err;
    EXPECT_NE(ended.err.find(c.told), std::string::npos) << c.deed << ": " << ended.err;
    EXPECT_FALSE(std::filesystem::exists(desk.path / "made")) << c.deed;
  }
}

TEST(MatBoxOfTheProgram, WithoutTheLibraryAMatFileIsRefusedWithTheMendAndACsvLogIsRead) {
  const TemporaryFolder empty;
  const std::string library = empty.write(SERVODX_MATIO_LIBRARY, "");
  const WithLibrary absent(empty.path.string());
  const Desk desk;
  desk.write("log.mat", file_named("quiet"));
  desk.write("log.csv", small_log());
  const Ended ended = desk.run("check-log log.mat");
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err, "servodx: log.mat: cannot be read here: the library " SERVODX_MATIO_LIBRARY
                       " is missing or damaged; install it (Debian: 'apt install " SERVODX_MATIO_PACKAGE
                       "'), or write a CSV log\n");
  EXPECT_EQ(desk.run("check-log log.csv").code, 0);
}

// What is loaded before main(): nothing that reads MAT files, and no client of a network.
TEST(Program, CarriesNoLibraryThatReadingCsvDoesNotNeed) {
  std::string loaded;
  std::FILE* ldd = ::popen("ldd '" SERVODX_PROGRAM "'", "r");
  ASSERT_NE(ldd, nullptr);
  for (char piece[4096]; const std::size_t n = std::fread(piece, 1, sizeof piece, ldd);) loaded.append(piece, n);
  if (::pclose(ldd) != 0) GTEST_SKIP() << "no ldd here";
  EXPECT_NE(loaded.find("libc.so"), std::string::npos);
  for (const char* never : {"matio", "hdf5", "curl", "ssh", "ldap", "rtmp", "krb5", "gnutls", "nghttp"})
    EXPECT_EQ(loaded.find(never), std::string::npos) << loaded;
}

}  // namespace
}  // namespace servodx
