// A virtual rig's numbers, and the limits of a test stand's facts.
#include "harness.h"
#include "rig/facts.h"
#include "rig/rig_model.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const InputFile file(input);
  refusing([&] { rig::read_rig_model(file.path()); });
  rig::read_fact_limits(file.path(), "rig");
}

}  // namespace servodx::fuzz
