// The bytes of `watch -`, which come in pieces: the first byte of the input is their size. A watch that goes on has to
// be able to read the head that it kept.
#include "signals/growing_log.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "harness.h"
#include "servodx/rig.h"
#include "signals/sample.h"
#include "signals/signal.h"

namespace servodx::fuzz {
namespace {

// No refusal: a log that was begun is begun again.
void require_kept(const GrowingLog& log, const RigFile& rig) {
  GrowingLog again("-", rig);
  try {
    again.begin_with(log.head(), 0);
  } catch (const InputError& error) {
    std::fprintf(stderr, "the kept head cannot be read back: %s\n%s", error.what(), log.head().c_str());
    std::abort();
  }
  for (const SignalInfo& signal : signal_list) {
    if (again.has(signal.signal) == log.has(signal.signal)) continue;
    std::fprintf(stderr, "the kept head has other signals:\n%s", log.head().c_str());
    std::abort();
  }
}

}  // namespace

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
  require_kept(log, rig);
}

}  // namespace servodx::fuzz
