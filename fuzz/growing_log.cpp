// The bytes of `watch -`, which come in pieces: the first byte of the input is their size.
#include "signals/growing_log.h"

#include <algorithm>
#include <cstddef>

#include "harness.h"
#include "servodx/rig.h"
#include "signals/sample.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  static const RigFile rig;
  if (input.empty()) return;
  const std::size_t piece = 1 + static_cast<unsigned char>(input.front());
  input.remove_prefix(1);
  GrowingLog log("-", rig);
  const auto pass = [](const Sample&, std::uint64_t) {};
  for (; !input.empty(); input.remove_prefix(std::min(piece, input.size()))) log.feed(input.substr(0, piece), pass);
  log.end(pass);
  if (!log.begun()) return;
  GrowingLog again("-", rig);  // as a watch that goes on reads what it kept
  again.begin_with(log.head(), 0);
}

}  // namespace servodx::fuzz
