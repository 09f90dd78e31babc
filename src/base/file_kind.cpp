#include "base/file_kind.h"

#include <algorithm>

#include "base/error.h"
#include "base/trouble.h"

namespace servodx {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view as_csv = "export the signals as CSV: a row of names with units, then a row a sample";
constexpr std::string_view not_json = "a log and a table are CSV; a baseline goes with --baseline";

struct Kind {
  std::string_view mark;  // at the very beginning
  std::string_view what;
  std::string_view mend = as_csv;
};
constexpr Kind kinds[] = {
    {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv, "an Excel workbook of the old kind (.xls)",
     "open it and save the sheet as CSV"},
    {"TDSm"sv, "a LabVIEW recording (.tdms)"},
    {"MDF     "sv, "a measurement data file (.mdf, .mf4)"},
    {"UnFinMF "sv, "an unfinished measurement data file (.mf4)"},
    {"\x89HDF\r\n\x1a\n"sv, "an HDF5 file"},
    {"MATLAB "sv, "a MAT file", "give its name the ending .mat"},
    {"\x1f\x8b"sv, "compressed (gzip)", "unpack it first"},
    {"7z\xbc\xaf\x27\x1c"sv, "an archive (7z)", "unpack it first"},
    {"BZh"sv, "compressed (bzip2)", "unpack it first"},
    {"\xFD"
     "7zXZ"sv,
     "compressed (xz)", "unpack it first"},
    {"\x28\xB5\x2F\xFD"sv, "compressed (zstd)", "unpack it first"},
    {"Rar!"sv, "an archive (rar)", "unpack it first"},
    {"%PDF-"sv, "a PDF page", "export the recording itself as CSV"},
    {"PAR1"sv, "a Parquet file"},
    {"|CF,"sv, "an imc FAMOS recording"},
    {"|CF;"sv, "an imc FAMOS recording"},
    {"DIAEXTENDED"sv, "a DIAdem recording"},
    {"SQLite format 3"sv, "an SQLite database"},
    {"\x89PNG"sv, "a picture (PNG)", "export the recording itself as CSV"},
    {"\xFF\xD8\xFF"sv, "a picture (JPEG)", "export the recording itself as CSV"},
    {"\x7F"
     "ELF"sv,
     "a program"},
    {"<?xml"sv, "XML"},
    {"<!DOCTYPE"sv, "HTML"},
    {"<html"sv, "HTML"},
    {"{\""sv, "JSON", not_json},
    {"{\n"sv, "JSON", not_json},
    {"{\r\n"sv, "JSON", not_json},
};

// Zip is the wrapping of archives and of workbooks: which, the names of its first members say.
constexpr std::string_view zip = "PK\x03\x04"sv, empty_zip = "PK\x05\x06"sv;
constexpr std::string_view of_excel[] = {"xl/"sv, "[Content_Types].xml"sv}, of_open_office = "opendocument"sv;
constexpr std::string_view utf16[] = {"\xFF\xFE"sv, "\xFE\xFF"sv};

constexpr std::size_t looked_at = 4096;  // [byte]
constexpr double many = 0.02;            // part of the bytes that are control characters
constexpr std::size_t few = 3;           // control characters that a damaged text may have

bool is_control(char c) {
  const auto u = static_cast<unsigned char>(c);
  return u < 0x20 && c != '\t' && c != '\r' && c != '\n' && c != '\f' && c != '\v';
}

}  // namespace

void refuse_binary(std::string_view first, const std::string& path) {
  first = first.substr(0, looked_at);
  const auto refuse = [&](std::string_view what, std::string_view mend) {
    throw DocumentedError(Trouble::binary, {path, 0, ""}, "is " + std::string(what) + ", and no text",
                          std::string(mend));
  };
  if (first.starts_with(zip) || first.starts_with(empty_zip)) {
    const bool excel = first.find(of_excel[0]) != first.npos || first.find(of_excel[1]) != first.npos;
    const bool open = first.find(of_open_office) != first.npos;
    if (excel || open)
      refuse(excel ? "an Excel workbook (.xlsx)" : "a workbook (.ods)", "open it and save the sheet as CSV");
    refuse("an archive (zip)", "unpack it first");
  }
  for (const Kind& kind : kinds)
    if (first.starts_with(kind.mark)) {
      const bool text = kind.mark.front() == '<' || kind.mark.front() == '{';
      if (text)
        throw DocumentedError(Trouble::binary, {path, 1, ""}, "is " + std::string(kind.what) + ", and no table",
                              std::string(kind.mend));
      refuse(kind.what, kind.mend);
    }
  if (first.starts_with(utf16[0]) || first.starts_with(utf16[1])) return;  // refused by who reads text
  const auto controls = static_cast<std::size_t>(std::count_if(first.begin(), first.end(), is_control));
  if (first.find('\0') != first.npos ||
      (controls > few && static_cast<double>(controls) > many * static_cast<double>(first.size())))
    refuse("binary", as_csv);
}

}  // namespace servodx
