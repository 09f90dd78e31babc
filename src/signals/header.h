// Where a log's header is: below the lines that a recorder wrote above it, with rows of text below it or without.
//
// The header is a row above the first row of numbers that has as many cells as that. Of several it is the one with the
// most names that a person would know; where that does not tell, the first row of the file, or the last that is not of
// units. Rows of text below it are passed, and one of units is taken. Where no row has as many cells, the first row of
// the file is taken, and its reader refuses it. A last column of comments (LabVIEW's) may lack its cells. Names behind
// a '#' right above the numbers are a header too. Names that stand over several columns take the names of groups in the
// row above, "Valve Position" and "Cylinder Position".
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/csv.h"

namespace servodx {

// Takes the header from below the lines above it, and says how many rows those are. Throws InputError where there is
// none to take: the first row is numbers, or each signal has a time column of its own.
long pass_lines_above_header(CsvCursor& csv, const std::string& path);

// Throws InputError where the row that serves as a header is one of numbers.
void require_names(const CsvCursor& csv, const std::string& path);

// The rows of text between the header and the first sample: units, the recorder's channels, offsets and factors that
// change nothing.
struct RowsBelow {
  bool in_row = false;             // a sample follows, and its row has begun
  long passed = 0;                 // rows, that of the units included
  std::vector<std::string> units;  // of a row of units; empty: there is none
  long units_at = -1;              // which of the rows it is
};
// `csv`: at the header. Throws InputError where a row holds offsets or factors that change the numbers.
RowsBelow pass_rows_below_header(CsvCursor& csv, const std::string& path);

// The first row of numbers, at which the cursor stands, numbers the channels, "0; 1; 2; 3", or is one value throughout,
// "0; 0; 0", from which the rows below it leap: no sample. `time`: its column. Throws InputError where time does not
// increase from it.
bool begins_with_channel_numbers(const CsvCursor& csv, std::size_t time, const std::string& path);

// Throws InputError where the first row of samples, at which the cursor stands, has more cells than the header: with
// commas between cells that may be a decimal comma.
void require_as_many_cells(const CsvCursor& csv, const std::vector<std::string>& row, const std::string& path);

// Throws InputError of the row at which the cursor stands, which has so many cells, and the header others.
[[noreturn]] void refuse_ragged(const CsvCursor& csv, std::size_t cells, const std::string& path);

// Throws InputError where a second recording begins: the row just read is the header (`is_header`), or that comes again
// before the next row of numbers.
void refuse_second_header(const CsvCursor& csv, bool is_header, const std::string& path);

// The row that a cursor stands at, where it is one of units below a header: no cell is a number, one at least is a
// unit. Without their brackets, and without the word "Unit" before them; empty: it is none.
std::vector<std::string> units_row(CsvCursor& csv);

// The units that LabVIEW writes some lines above its names, one for each but the first column, the time in seconds.
// `csv`: at the header; `text`: the file from its beginning. Empty: there are none.
std::vector<std::string> units_above(std::string_view text, const CsvCursor& csv);

// Two numbers or time stamps at least, and nothing else.
bool is_row_of_numbers(std::string_view line);

// "Comment", "Kommentar".
bool is_name_of_comments(const std::string& name);
// Such a name at the end of a header: its cells may be absent.
bool ends_with_comment(const std::vector<std::string>& header);

}  // namespace servodx
