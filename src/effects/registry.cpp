#include "effects/registry.h"

#include <stdexcept>
#include <type_traits>

#include "parameters/list.h"

namespace servodx {
namespace {

// What an effect states about itself; what it does not state stays as EffectInfo has it.
template <class E>
void take_meaning(EffectInfo& e) {
  if constexpr (requires { E::stand_only; }) e.stand_only = E::stand_only;
  if constexpr (requires { E::as_made; }) e.as_made = E::as_made;
  if constexpr (requires { E::freed; }) e.freed = E::freed;
  if constexpr (requires { E::shapes_rows; }) e.shapes_rows = E::shapes_rows;
  if constexpr (requires { E::sought_as; }) e.sought_as = E::sought_as;
  if constexpr (requires { E::known_oil_only; }) e.known_oil_only = E::known_oil_only;
  if constexpr (requires { E::of_construction; }) e.of_construction = E::of_construction;
  if constexpr (requires { E::best_test; }) e.best_test = E::best_test;
  if constexpr (requires { E::along; }) e.along = E::along;
  if constexpr (requires { E::as_large_as_rig; }) e.as_large_as_rig = E::as_large_as_rig;
}

template <class E, class... Common>
constexpr bool is_among(EffectList<Common...>) {
  return (std::is_same_v<E, Common> || ...);
}

template <class... E>
std::vector<EffectInfo> describe(EffectList<E...>) {
  int at = n_parameters;
  std::vector<EffectInfo> all;
  (
      [&] {
        all.push_back({.name = E::name,
                       .place = E::place,
                       .meaning = E::meaning,
                       .first = at,
                       .parameters = {E::parameters, E::parameters + E::n_parameters},
                       .rare = !is_among<E>(CommonEffects{})});
        take_meaning<E>(all.back());
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
