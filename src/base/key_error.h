// Refusals of files that hold keys, not columns: "rig.toml:2: key 'valve.rated_current': has no unit; ...".
#pragma once
#include <string>
#include <utility>

#include "base/error.h"
#include "base/trouble.h"

namespace servodx {

// `at.column` is the key.
inline InputError key_error(const Place& at, const std::string& rule, std::string mend) {
  return {{at.file, at.line, ""}, at.column.empty() ? rule : "key '" + at.column + "': " + rule, std::move(mend)};
}
// What a reader of quantities, which knows of columns only, said of a key.
[[noreturn]] inline void throw_of_key(const InputError& error) {
  InputError of_key = key_error(error.where, error.rule, error.mend);
  throw_like(error, of_key.where, of_key.rule, of_key.mend);
}

}  // namespace servodx
