// JSON from outside the program. nlohmann's parser keeps no stack, but copies, comparisons and dumps of its values
// call themselves level by level: a text nested 100,000 deep overflows the stack long after it was read.
#pragma once
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

namespace servodx {

inline constexpr int deepest_json = 100;  // levels; what servodx writes has fewer than ten

// Whether its brackets, those within texts left out, nest no deeper than that.
inline bool is_shallow_json(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted && c == '\\') ++i;
    if (quoted) continue;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > deepest_json) return false;
  }
  return true;
}

// Discarded (and so neither object nor array) where it is no JSON, nests too deep, or holds a number beyond all
// doubles.
template <class Json>
Json json_or_discarded(const std::string& text) {
  return is_shallow_json(text) ? Json::parse(text, nullptr, false) : Json(Json::value_t::discarded);
}

// Whether it is an object whose `schema` is this number. (`value()` throws where the key is there with another type.)
template <class Json>
bool has_schema(const Json& json, int schema) {
  if (!json.is_object()) return false;
  const auto at = json.find("schema");
  return at != json.end() && at->is_number_integer() && *at == schema;
}

// The text under a key of an object; empty where there is none, or something else.
template <class Json>
std::string text_or_empty(const Json& object, const char* key) {
  const auto at = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && at != object.end() && at->is_string() ? at->template get<std::string>() : "";
}

// The number under a key of an object; NaN where there is none, or something else.
template <class Json>
double number_or_nan(const Json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_number() ? at->template get<double>() : std::nan("");
}

}  // namespace servodx
