#include "tune/kept.h"

#include "signals/rig_content.h"

namespace servodx {

Stages stages_of_tune(const std::vector<Log>& logs, const Table& nominal, const RigFile& rig,
                      const TuneOptions& options) {
  if (!options.watch.checkpoint) return {};
  std::vector<std::string> content;
  for (const Log& log : logs) content.push_back(content_hash(log));
  return {options.watch,   "tune",          content,        content_hash(nominal), content_bytes(rig),    options.seed,
          options.heldout, options.effects, options.priors, options.local,         options.moving_average};
}

}  // namespace servodx
