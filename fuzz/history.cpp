// A history as CSV, and the readings of a seeded-fault test.
#include "harness.h"
#include "store/history_csv.h"
#include "store/seeded_csv.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const InputFile file(input);
  refusing([&] { history_csv(read_history_csv(file.path())); });
  read_seeded_csv(file.path());
}

}  // namespace servodx::fuzz
