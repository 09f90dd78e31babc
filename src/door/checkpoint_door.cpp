// The front door of checkpoints.
#include <memory>
#include <string>

#include "base/checkpoint.h"
#include "servodx/checkpoint.h"
#include "servodx/instruction_set.h"

namespace servodx {

// Instruction sets differ in the last digits, so what one of them has made serves no other.
std::shared_ptr<Checkpoint> open_checkpoint(const std::string& path, CheckpointUse use) {
  const std::string build = SERVODX_VERSION " " + build_identity() + " " + instruction_set();
  return std::make_shared<Checkpoint>(path, use, build);
}

CheckpointReport report_of(const Checkpoint& checkpoint) { return checkpoint.report(); }

}  // namespace servodx
