#include "effects/registry.h"

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

}  // namespace servodx
