// Pickling: a type lists its fields once, and its state is the tuple of them, through vectors, maps and optionals.
#pragma once
#include <array>
#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "define.h"

namespace servodx::python {

// fields(T&) is a tie of all that T holds, but for what is the library's own.
template <class T>
concept Listed = requires(T& t) {
  fields(t);
};

template <class T>
py::object state_of(const T& value);
template <class T>
void take_state(T& to, py::handle state);

template <class T>
struct State {
  static py::object of(const T& value) {
    if constexpr (Listed<T>) {
      return std::apply([](const auto&... field) -> py::object { return py::make_tuple(state_of(field)...); },
                        fields(const_cast<T&>(value)));
    } else if constexpr (std::is_enum_v<T>) {
      return py::int_(static_cast<int>(value));
    } else {
      return py::cast(value);
    }
  }
  static void take(T& to, py::handle state) {
    if constexpr (Listed<T>) {
      auto into = fields(to);
      const auto from = py::cast<py::tuple>(state);
      if (from.size() != std::tuple_size_v<decltype(into)>)
        throw py::value_error("pickled by another version of servodx: make it again");
      std::apply([&, at = std::size_t{0}](auto&... field) mutable { (take_state(field, from[at++]), ...); }, into);
    } else if constexpr (std::is_enum_v<T>) {
      to = static_cast<T>(py::cast<int>(state));
    } else {
      to = py::cast<T>(state);
    }
  }
};

template <>
struct State<std::vector<double>> {
  static py::object of(const std::vector<double>& value) { return array_of(value); }
  static void take(std::vector<double>& to, py::handle state) {
    const auto from = py::cast<Array>(state);
    to.assign(from.data(), from.data() + from.size());
  }
};

template <class T>
struct State<std::vector<T>> {
  static py::object of(const std::vector<T>& value) {
    py::list out;
    for (const T& v : value) out.append(state_of(v));
    return out;
  }
  static void take(std::vector<T>& to, py::handle state) {
    to.clear();
    for (const py::handle v : py::cast<py::list>(state)) take_state(to.emplace_back(), v);
  }
};

template <class T, std::size_t n>
struct State<std::array<T, n>> {
  static py::object of(const std::array<T, n>& value) { return state_of(std::vector<T>(value.begin(), value.end())); }
  static void take(std::array<T, n>& to, py::handle state) {
    const auto from = py::cast<py::list>(state);
    if (from.size() != n) throw py::value_error("pickled by another version of servodx: make it again");
    for (std::size_t i = 0; i < n; ++i) take_state(to[i], from[i]);
  }
};

template <class T>
struct State<std::optional<T>> {
  static py::object of(const std::optional<T>& value) { return value ? state_of(*value) : py::none(); }
  static void take(std::optional<T>& to, py::handle state) {
    to.reset();
    if (!state.is_none()) take_state(to.emplace(), state);
  }
};

template <class T>
struct State<std::map<std::string, T>> {
  static py::object of(const std::map<std::string, T>& value) {
    py::dict out;
    for (const auto& [key, v] : value) out[py::str(key)] = state_of(v);
    return out;
  }
  static void take(std::map<std::string, T>& to, py::handle state) {
    to.clear();
    for (const auto& [key, v] : py::cast<py::dict>(state)) take_state(to[py::cast<std::string>(key)], v);
  }
};

template <class T>
py::object state_of(const T& value) {
  return State<T>::of(value);
}
template <class T>
void take_state(T& to, py::handle state) {
  State<T>::take(to, state);
}

template <class T>
auto pickled() {
  return py::pickle([](const T& value) { return py::make_tuple(state_of(value)); },
                    [](const py::tuple& state) {
                      T value;
                      take_state(value, state[0]);
                      return value;
                    });
}

}  // namespace servodx::python
