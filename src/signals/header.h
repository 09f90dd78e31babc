// Where a log's header is: below the lines that a recorder wrote above it, with a row of units below or without.
//
// The header is the last row before the first row of numbers, or the one above that where the last is one of units. It
// is looked for only where the first row has another number of cells than the first row of numbers, which is refused
// else. A last column of comments (LabVIEW's) may lack its cells.
#pragma once
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

// The row that a cursor stands at, where it is one of units below a header: no cell is a number, one at least is a
// unit. Without their brackets; empty: it is none.
std::vector<std::string> units_row(CsvCursor& csv);

// The units that LabVIEW writes some lines above its names, one for each but the first column, the time in seconds.
// `csv`: at the header; `text`: the file from its beginning. Empty: there are none.
std::vector<std::string> units_above(std::string_view text, const CsvCursor& csv);

// Two numbers or time stamps at least, and nothing else.
bool is_row_of_numbers(std::string_view line);

// "Comment" at the end of a header: its cells may be absent.
bool ends_with_comment(const std::vector<std::string>& header);

}  // namespace servodx
