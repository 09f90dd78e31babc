// The manifest beside a result: as `rerun` reads it, and as who looks for its inputs does.
#include "manifest.h"

#include <nlohmann/json.hpp>

#include "harness.h"
#include "read_manifest.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const InputFile file(input);
  inputs_of_manifest(file.path());
  fingerprint(std::string(input));
  read_manifest(file.path());
}

}  // namespace servodx::fuzz
