#include "effects/registry.h"

#include <stdexcept>
#include <type_traits>

#include "effects/stiction.h"
#include "parameters/list.h"

namespace servodx {
namespace {

// What an effect states about itself; what it does not state stays as EffectInfo has it.
template <class E>
struct Meaning : E {};
template <>
struct Meaning<Stiction> : Stiction {
  static constexpr RowAlong along = {row::spool_friction, true};  // what sticks also drags: silt and lacquer
  static constexpr const char* best_test =
      "slow small triangle: the spool stands still at each reversal, longer the slower";
};

template <class E>
void take_meaning(EffectInfo& e) {
  using M = Meaning<E>;
  if constexpr (requires { M::stand_only; }) e.stand_only = M::stand_only;
  if constexpr (requires { M::as_made; }) e.as_made = M::as_made;
  if constexpr (requires { M::freed; }) e.freed = M::freed;
  if constexpr (requires { M::shapes_rows; }) e.shapes_rows = M::shapes_rows;
  if constexpr (requires { M::sought_as; }) e.sought_as = M::sought_as;
  if constexpr (requires { M::known_oil_only; }) e.known_oil_only = M::known_oil_only;
  if constexpr (requires { M::of_construction; }) e.of_construction = M::of_construction;
  if constexpr (requires { M::best_test; }) e.best_test = M::best_test;
  if constexpr (requires { M::along; }) e.along = M::along;
  if constexpr (requires { M::as_large_as_rig; }) e.as_large_as_rig = M::as_large_as_rig;
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
