// The schema of what the program writes as JSON: one number, one rule for who reads it.
//
// A key that is added changes no schema: readers pass over what they do not know. A key that means something else does.
#pragma once
#include <optional>
#include <string>

#include "base/error.h"

namespace servodx {

inline constexpr int result_schema = 1;

// Of an object that was read: a notice where it is of an earlier version than any schema. Throws InputError where it is
// of a newer one.
template <class Json>
std::optional<std::string> schema_notice(const Json& file, const std::string& path) {
  const auto at = file.find("schema");
  if (at == file.end()) return path + ": carries no schema, as earlier versions wrote it; it is read as far as it goes";
  if (!at->is_number_integer() || at->template get<double>() < 1)
    throw InputError({.file = path}, "key 'schema': " + at->dump() + " is no schema", "make the file again");
  if (at->template get<double>() > result_schema)
    throw InputError({.file = path},
                     "key 'schema': " + at->dump() + " is newer than this program, which reads up to " +
                         std::to_string(result_schema),
                     "read it with the version that wrote it, or make it again with this one");
  return {};
}

}  // namespace servodx
