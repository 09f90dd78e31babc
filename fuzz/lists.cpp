// Lists of a fleet: logs, checks, and the truth.
#include "fleet/check_list.h"
#include "fleet/confusion.h"
#include "fleet/log_list.h"
#include "harness.h"
#include "servodx/fleet.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const InputFile file(input);
  refusing([&] { read_log_list(file.path()); });
  refusing([&] { read_check_list(file.path(), ""); });
  read_truth(file.path());
}

}  // namespace servodx::fuzz
