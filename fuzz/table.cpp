// A parameter table with the state that a tune left in it; what is accepted can be written and read again.
#include "parameters/table.h"

#include "fit/tuned_state.h"
#include "harness.h"
#include "parameters/table_text.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const Table table = parse_table(std::string(input), "table.csv");
  parse_table(table_text(table), "table.csv");
  tuned_state(table);
}

}  // namespace servodx::fuzz
