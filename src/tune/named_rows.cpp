#include "tune/named_rows.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "effects/effect.h"
#include "effects/registry.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {
namespace {

constexpr std::string_view every_row = "all";

bool is_row(const std::string& name) {
  const auto has_it = [&](const EffectInfo& effect) {
    return std::any_of(effect.parameters.begin(), effect.parameters.end(),
                       [&](const EffectParameter& p) { return p.name == name; });
  };
  return find_parameter(name) >= 0 || std::any_of(effect_list().begin(), effect_list().end(), has_it);
}

void require_profiled(bool there, const std::string& name) {
  if (!there)
    throw InputError({.file = "--profile"}, "the table has no row '" + name + "'",
                     "name rows of the table, with commas between, or 'all'");
}

}  // namespace

void require_row_names(const TuneOptions& options) {
  for (const std::string& name : options.profile) require_profiled(name == every_row || is_row(name), name);
  for (const auto& [name, sd] : options.priors)
    if (!is_row(name)) refuse_prior(name);
}

bool is_profiled(const std::string& row, const TuneOptions& options) {
  return std::any_of(options.profile.begin(), options.profile.end(),
                     [&](const std::string& asked) { return asked == every_row || asked == row; });
}

void refuse_prior(const std::string& row) {
  throw InputError({.file = "--prior"}, "'" + row + "' is not among the rows that are fitted",
                   "name a row with estimate 1; row 41 and the air are each log's own");
}

void require_profiled_rows(const std::vector<Log>& logs, const Table& nominal, const Rig& rig,
                           const TuneOptions& options) {
  const Table table = with_effects(nominal, options.effects.value_or(default_effects(rig_kind(logs, rig))));
  for (const std::string& name : options.profile) require_profiled(name == every_row || table.find(name) >= 0, name);
}

}  // namespace servodx
