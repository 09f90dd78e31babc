// What is asked of `explain`, before any work.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/nearest.h"
#include "base/require_setting.h"
#include "effects/registry.h"
#include "effects/row_effects.h"
#include "servodx/explain.h"

namespace servodx {

void ExplainOptions::validate() const {
  require_threads(threads);
  require_setting(level > 0 && level < 1, "ExplainOptions.level", fmt::format("{} is not a rate", level),
                  "give a number between 0 and 1, such as 0.01");
  std::vector<std::string> known;
  for (const EffectInfo& effect : effect_list()) known.push_back(effect.name);
  for (const RowEffect& effect : row_effects()) known.emplace_back(effect.name);
  for (const std::string& name : without)
    require_setting(std::find(known.begin(), known.end(), name) != known.end(), "--without",
                    "unknown effect '" + name + "'",
                    did_you_mean(name, known) + fmt::format("use one of {}", fmt::join(known, ", ")));
}

}  // namespace servodx
