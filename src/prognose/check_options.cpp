// What is asked of `check`, before any work.
#include <fmt/format.h>

#include "base/require_setting.h"
#include "prognose/monitor.h"
#include "prognose/track.h"
#include "servodx/trend.h"

namespace servodx {

void CheckOptions::validate() const {
  require_pressure_law(model);
  require_threads(threads);
  const std::size_t wanted = progressive_faults().size();
  require_setting(last.empty() || last.size() == wanted, "CheckOptions.last",
                  fmt::format("{} values where {} parameters are tracked", last.size(), wanted),
                  "take them from History::tracked(), or none");
}

}  // namespace servodx
