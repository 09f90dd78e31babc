#include "effects/registry.h"

#include <stdexcept>

namespace servodx {
namespace {
template <class... E>
std::vector<EffectInfo> describe(EffectList<E...>) {
  int at = n_parameters;
  std::vector<EffectInfo> all;
  (
      [&] {
        all.push_back({E::name, E::place, E::meaning, at, {E::parameters, E::parameters + E::n_parameters}});
        if constexpr (requires { E::stand_only; }) all.back().stand_only = E::stand_only;
        if constexpr (requires { E::as_made; }) all.back().as_made = E::as_made;
        if constexpr (requires { E::freed; }) all.back().freed = E::freed;
        if constexpr (requires { E::shapes_rows; }) all.back().shapes_rows = E::shapes_rows;
        at += E::n_parameters;
      }(),
      ...);
  return all;
}
}  // namespace

const std::vector<EffectInfo>& effect_list() {
  static const std::vector<EffectInfo> list = describe(CorrectedEffects{});
  return list;
}

const EffectParameter& parameter_at(int position) {
  for (const EffectInfo& e : effect_list())
    if (const auto j = static_cast<std::size_t>(position - e.first); position >= e.first && j < e.parameters.size())
      return e.parameters[j];
  throw std::out_of_range("no effect's parameter at this position");
}

}  // namespace servodx
