#include "diagnose/hypothesis_settings.h"

#include <string>

#include "base/stages.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/free_values.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "signals/rig_content.h"

namespace servodx {
namespace {

// The seed is of the genetic search alone, which the attempts' stages do not name.
Stages stages_of(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, const DiagnoseOptions& options) {
  if (!options.watch.checkpoint) return {};
  std::vector<std::string> content;
  for (const Log& log : logs) content.push_back(content_hash(log));
  const bool genetic = options.search == FaultSearch::genetic;
  return {options.watch,
          "assess",
          content,
          content_hash(tuned),
          content_bytes(rig),
          options.search,
          genetic ? options.seed : 0};
}

}  // namespace

HypothesisSettings hypothesis_settings(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                                       const DiagnoseOptions& options) {
  HypothesisSettings settings;
  for (const Fault* fault : fault_list())
    if (fault->counted_in) settings.times_drawing[fault] = times_drawing(*fault->counted_in, tuned, rig);
  settings.null_limit = rig.null_limit;
  settings.threads = options.threads;
  settings.stop = options.watch.stop;
  if (options.search == FaultSearch::genetic) settings.genetic = {options.population, options.seed};
  settings.stages = stages_of(logs, tuned, rig, options);
  return settings;
}

}  // namespace servodx
