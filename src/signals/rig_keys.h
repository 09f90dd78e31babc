// The keys of rig.toml (servodx/rig.h) with their dimensions: what a fact's unit may be, and which side a limit bounds.
#pragma once
#include <string_view>
#include <vector>

#include "base/units.h"
#include "servodx/rig.h"
#include "signals/signal.h"

namespace servodx {

// Behind the mapping of a column that 'init' leaves a comment: what it asks of it follows.
inline constexpr std::string_view asks_of_column = "  # ? ";

struct LimitInfo {
  std::string_view figure;
  Dimension dimension;
  bool upper;             // the usual side of a single value
  std::string_view unit;  // of the figure on a sheet
};
const std::vector<LimitInfo>& limit_list();

struct RigFact {
  std::string_view key;  // dotted
  Dimension dimension;
  bool may_be_zero;
};
const std::vector<RigFact>& rig_facts();

}  // namespace servodx
