#include <fmt/format.h>

#include "base/error.h"
#include "diagnose/constants.h"
#include "servodx/diagnose.h"

namespace servodx {

void DiagnoseOptions::validate() const {
  namespace k = diagnose_constants;
  if (threads < 0)
    throw InputError({.file = "DiagnoseOptions.threads"}, fmt::format("{} threads cannot run", threads),
                     "give 0 for all cores, or how many");
  if (population < k::least_population || population > k::most_population)
    throw InputError({.file = "DiagnoseOptions.population"}, fmt::format("a sub-group of {}", population),
                     fmt::format("give {} to {}", k::least_population, k::most_population));
}

}  // namespace servodx
