#include <fmt/format.h>

#include "base/require_setting.h"
#include "diagnose/constants.h"
#include "servodx/actions.h"
#include "servodx/diagnose.h"

namespace servodx {

void DiagnoseOptions::validate() const {
  namespace k = diagnose_constants;
  require_threads(threads, "DiagnoseOptions.threads");
  for (const auto& [label, action] : default_actions())
    require_setting(actions.contains(label), "DiagnoseOptions.actions", "there is none for '" + label + "'",
                    "begin with default_actions(), and change what is another");
  require_setting(population >= k::least_population && population <= k::most_population, "DiagnoseOptions.population",
                  fmt::format("a sub-group of {}", population),
                  fmt::format("give {} to {}", k::least_population, k::most_population));
}

}  // namespace servodx
