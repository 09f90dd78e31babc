// What is asked of `check`, before any work.
#include <fmt/format.h>

#include "base/error.h"
#include "prognose/monitor.h"
#include "prognose/track.h"
#include "servodx/trend.h"

namespace servodx {

void CheckOptions::validate() const {
  require_pressure_law(model);
  if (threads < 0)
    throw InputError({.file = "--threads"}, fmt::format("{} threads cannot run", threads),
                     "give 0 for all cores, or how many");
  if (const std::size_t wanted = progressive_faults().size(); !last.empty() && last.size() != wanted)
    throw InputError({.file = "CheckOptions.last"},
                     fmt::format("{} values where {} parameters are tracked", last.size(), wanted),
                     "take them from History::tracked(), or none");
}

}  // namespace servodx
