// Which rows the logs can tell: each driven to its bounds, and by their sensitivities at nominal from one another. What
// they cannot tell is held, an effect at its off value.
#pragma once
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "fit/identifiability.h"
#include "fit/problem.h"
#include "servodx/table.h"
#include "tune/scope.h"
#include "tune/watch.h"

namespace servodx {

struct ScreenedRow {
  std::string name;
  RowVerdict verdict = RowVerdict::bounded;  // or flat, confounded
  std::vector<std::string> confounded_with;
  // Change of the simulation at the row's lower and upper bound, in sigmas; NaN where it fails there.
  std::array<double, 2> effect = {NAN, NAN};
};

// Every row that was free. Those that the logs do not tell leave the scope's shared values.
std::vector<ScreenedRow> screen_rows(TuneScope& scope, TuneWatch& watch);

}  // namespace servodx
