// TOML files beside the rig file: a certificate's, and what is to be done about a fault.
#include "harness.h"
#include "servodx/actions.h"
#include "servodx/certificate.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const InputFile file(input);
  refusing([&] { read_certificate(file.path()); });
  read_actions(file.path());
}

}  // namespace servodx::fuzz
