// The header of a log of unknown names, as `init` reads it.
#include "signals/header.h"

#include "base/csv.h"
#include "harness.h"
#include "signals/guess.h"
#include "signals/time_stamp.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  CsvCursor csv(input, "log.csv");
  pass_lines_above_header(csv, "log.csv");
  require_names(csv, "log.csv");
  const std::vector<std::string> units = csv.next_row() ? units_row(csv) : std::vector<std::string>{};
  guess_columns(csv.header(), units);
  do {
    double number = 0;
    for (Cell cell = csv.next_number(number); cell != Cell::none; cell = csv.next_number(number))
      if (cell == Cell::text) parse_time_stamp(csv.last_text());
  } while (csv.next_row());
}

}  // namespace servodx::fuzz
