// A file that is no text is known by its first bytes and refused with what to export; a text never is.
#include "base/file_kind.h"

#include <gtest/gtest.h>

#include <string>

#include "base/csv.h"
#include "base/error.h"
#include "base/random.h"

namespace servodx {
namespace {

std::string refusal(const std::string& bytes) {
  try {
    refuse_binary(bytes, "log.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FileKind, EachFormatIsNamedWithItsFileAndMend) {
  const std::string rest(300, '\x01');
  const struct {
    std::string first, what;
  } files[] = {{std::string("PK\x03\x04") + "[Content_Types].xml", "an Excel workbook (.xlsx)"},
               {std::string("PK\x03\x04") + "a.csv", "an archive (zip)"},
               {"TDSm", ".tdms"},
               {"MDF     4.10", ".mf4"},
               {"\x89HDF\r\n\x1a\n", "HDF5"},
               {"\x1f\x8b\x08", "gzip"},
               {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", ".xls"},
               {"%PDF-1.4\n", "PDF"},
               {"PAR1", "Parquet"},
               {"7z\xbc\xaf\x27\x1c", "7z"},
               {"|CF,2,1,1;", "FAMOS"},
               {"MATLAB 5.0 MAT-file", "a MAT file"}};
  for (const auto& [first, what] : files) {
    const std::string said = refusal(first + rest);
    EXPECT_TRUE(said.starts_with("log.csv: is ")) << said;
    EXPECT_NE(said.find(what), std::string::npos) << said;
    EXPECT_NE(said.find("; "), std::string::npos) << said;
  }
  EXPECT_NE(refusal("<?xml version=\"1.0\"?>").find("XML"), std::string::npos);
  for (const char* json : {"{\"time\": [0]}", "{\n  \"time\": [0]\n}", "{\r\n  \"time\": [0]\r\n}"})
    EXPECT_NE(refusal(json).find("JSON"), std::string::npos) << json;
}

TEST(FileKind, RandomBytesAreBinaryAndTextsAreNot) {
  Random random(3);
  std::string bytes;
  for (int k = 0; k < 5000; ++k) bytes += static_cast<char>(random.bits64());
  EXPECT_NE(refusal(bytes).find("is binary"), std::string::npos);
  for (const char* text : {"", "time [s],command [mA]\n0,1\n", "t;p\r\n0,1;2\r\n", "\xEF\xBB\xBFt\tp\n",
                           "\xD6l;T (\xB0"
                           "C)\n",
                           "com\x7Fmand,sp\x01ool\n", "Pressure,MDF\n", "\xE6\x97\xB6\xE9\x97\xB4,x\n"})
    EXPECT_EQ(refusal(text), "accepted") << text;
}

TEST(FileKind, EveryReaderOfTablesAsks) {
  EXPECT_THROW(CsvCursor(std::string_view("TDSm\x0e, and so on\n"), "log.csv"), InputError);
}

}  // namespace
}  // namespace servodx
