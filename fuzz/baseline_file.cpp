// A baseline: what diagnose takes of it, and what explain does.
#include "report/baseline_file.h"

#include "harness.h"
#include "report/explain_report.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const InputFile file(input);
  refusing([&] { report::read_baseline(file.path()); });
  report::read_healthy(file.path());
}

}  // namespace servodx::fuzz
