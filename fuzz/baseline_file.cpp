// A baseline: what diagnose takes of it, and what explain does.
#include "store/baseline_file.h"

#include "harness.h"
#include "store/healthy_file.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const InputFile file(input);
  refusing([&] { store::read_baseline(file.path()); });
  store::read_healthy(file.path());
}

}  // namespace servodx::fuzz
