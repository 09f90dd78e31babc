// JSON from outside the program. nlohmann's parser keeps no stack, but copies, comparisons and dumps of its values
// call themselves level by level: a text nested 100,000 deep overflows the stack long after it was read.
#pragma once
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/reading_limits.h"

namespace servodx {

inline constexpr int deepest_json = 100;  // levels; what servodx writes has fewer than ten

// Whether `holds` is true of each character outside its texts, in their order.
template <class Holds>
bool holds_outside_texts(std::string_view text, const Holds& holds) {
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted && c == '\\') ++i;
    if (!quoted && !holds(c)) return false;
  }
  return true;
}

// Whether its brackets nest no deeper than that.
inline bool is_shallow_json(std::string_view text) {
  int depth = 0;
  return holds_outside_texts(text, [&](char c) {
    depth += (c == '{' || c == '[') - (c == '}' || c == ']');
    return depth <= deepest_json;
  });
}

// Whether its brackets and commas, one at least before each value but the first, are no more than most_json_values.
inline bool has_few_values(std::string_view text) {
  long values = 0;
  return holds_outside_texts(text, [&](char c) {
    values += c == '{' || c == '[' || c == ',';
    return values <= most_json_values;
  });
}

// Throws InputError that names the limit.
inline void refuse_beyond_limits(std::string_view text, const std::string& path, const std::string& mend) {
  if (!is_shallow_json(text))
    throw InputError({path, 0, ""}, "nests deeper than " + std::to_string(deepest_json) + " levels", mend);
  if (!has_few_values(text))
    throw InputError({path, 0, ""}, "holds more than " + std::to_string(most_json_values) + " values", mend);
}

// Of a file from outside; discarded where it is no JSON, or holds a number beyond all doubles. Throws InputError where
// it goes beyond the limits, of size too.
template <class Json>
Json json_in_file(const std::string& path, const std::string& mend) {
  const std::string text = read_file_within(path, largest_json);
  refuse_beyond_limits(text, path, mend);
  return Json::parse(text, nullptr, false);
}

// Discarded (and so neither object nor array) where it is no JSON, goes beyond these limits, or holds a number
// beyond all doubles.
template <class Json>
Json json_or_discarded(const std::string& text) {
  return is_shallow_json(text) && has_few_values(text) ? Json::parse(text, nullptr, false)
                                                       : Json(Json::value_t::discarded);
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
