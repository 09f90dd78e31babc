// The file of a checkpoint, and what a search, a fit and a list of names would take its stages for.
#include "base/checkpoint.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "harness.h"
#include "optimise/genetic_state.h"

namespace servodx::fuzz {
namespace {

void take(std::string_view bytes) {
  from_bytes<std::vector<std::map<std::string, std::optional<double>>>>(bytes);
  from_bytes<std::vector<std::vector<std::string>>>(bytes);
  refusing([&] { to_json(genetic_state_from_json(std::string(bytes))); });
}

}  // namespace

void read(std::string_view input) {
  // No input comes upon the hash of its own bytes: a stage that is made of it stands before it.
  const std::string key(64, '0');
  const CheckpointText before = parse_checkpoint(std::string(input) + stage_text(key, input));
  const CheckpointText text = parse_checkpoint("servodx checkpoint 1\n" + stage_text(key, input) + std::string(input));
  if (text.stages.at(key) != input) __builtin_trap();
  for (const auto& [name, bytes] : before.stages) take(bytes);
  take(input);
}

}  // namespace servodx::fuzz
