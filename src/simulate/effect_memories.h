// What effects of the command and of the sensors remember from sample to sample, in the order of the list. An effect
// that has no memory costs nothing. The places and what fills them: model/hooks.h.
#pragma once
#include <tuple>
#include <type_traits>

#include "model/hooks.h"
#include "parameters/list.h"

namespace servodx {

// Current that the torque motor feels at each sample: null added, then the effects' memories in the order of the list.
template <class T, class Effects>
struct Drive;
template <class T, class... E>
struct Drive<T, EffectList<E...>> {
  template <class X>
  static auto memory_of(X) {
    if constexpr (requires { typename X::template Memory<T>; })
      return typename X::template Memory<T>{};
    else
      return Nothing{};
  }
  std::tuple<decltype(memory_of(E{}))...> memory;
  static constexpr bool acts = (requires { typename E::template Memory<T>; } || ... || false);
  void rest([[maybe_unused]] const T& current, [[maybe_unused]] const T& spring, [[maybe_unused]] const T* p,
            [[maybe_unused]] const T& rated) {
    (
        [&] {
          if constexpr (requires { typename E::template Memory<T>; })
            E::rest(std::get<index_of<E>()>(memory), current, spring,
                    p + n_parameters + EffectList<E...>::template parameter_offset<E>(), rated);
        }(),
        ...);
  }
  void take_lane([[maybe_unused]] const Drive& from, [[maybe_unused]] int lane) {
    (
        [&] {
          if constexpr (requires { typename E::template Memory<T>; })
            std::get<index_of<E>()>(memory).take_lane(std::get<index_of<E>()>(from.memory), lane);
        }(),
        ...);
  }
  template <class X>
  static constexpr int index_of() {
    int at = 0, found = -1;
    ((found = std::is_same_v<E, X> ? at : found, ++at), ...);
    return found;
  }
  T operator()([[maybe_unused]] double time, T current, [[maybe_unused]] const T& spring, [[maybe_unused]] const T* p,
               [[maybe_unused]] const T& rated) {
    (
        [&] {
          if constexpr (requires { typename E::template Memory<T>; })
            current = E::drive(std::get<index_of<E>()>(memory), time, current, spring,
                               p + n_parameters + EffectList<E...>::template parameter_offset<E>(), rated);
        }(),
        ...);
    return current;
  }
};

// What the sensors show: the effects that act on them, in the order of the list.
template <class T, class Effects>
struct Sensed;
template <class T, class... E>
struct Sensed<T, EffectList<E...>> {
  template <class X>
  static auto memory_of(X) {
    if constexpr (requires { typename X::template Sensors<T>; })
      return typename X::template Sensors<T>{};
    else
      return Nothing{};
  }
  std::tuple<decltype(memory_of(E{}))...> memory;
  static T behind([[maybe_unused]] int signal, T x, [[maybe_unused]] const T* p) {
    (
        [&] {
          if constexpr (requires { E::behind(signal, x, p); })
            x = E::behind(signal, x, p + n_parameters + EffectList<E...>::template parameter_offset<E>());
        }(),
        ...);
    return x;
  }
  void operator()([[maybe_unused]] double time, [[maybe_unused]] T* shown, [[maybe_unused]] const T* p) {
    (
        [&] {
          if constexpr (requires { typename E::template Sensors<T>; })
            E::observe(std::get<Drive<T, EffectList<E...>>::template index_of<E>()>(memory), time, shown,
                       p + n_parameters + EffectList<E...>::template parameter_offset<E>());
        }(),
        ...);
  }
};

}  // namespace servodx
