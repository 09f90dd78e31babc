// Refusals and warnings that have a section of their own in docs/errors.md, and the code by which they are found there.
//
// The code travels by type: a DocumentedError carries its Trouble, a warning is made with its Trouble. No code is read
// from words. `servodx list errors` says what each one means.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "servodx/error.h"

namespace servodx {

enum class Trouble {
  unit,           // E01 a unit is missing or unknown
  signal,         // E02 a required signal is missing
  time,           // E03 time does not increase
  row,            // E04 a row is ragged, or a cell is no number
  binary,         // E05 the file is no text
  key,            // E06 a key is not known
  untuned,        // E07 the table is not tuned
  other_table,    // E08 the baseline was made with another table
  unlike_test,    // W01 no log of the baseline is of a test like this
  few_logs,       // W02 the rate asked for takes more fault-free logs
  implausible,    // W03 values that can be read but hardly believed
  rig_forgotten,  // W04 the baseline was made with a rig file, and the call names none
  other_rig,      // W05 the rig file says other things than the one that the baseline was made with
};
inline constexpr int n_troubles = 13;

constexpr const char* code_of(Trouble trouble) {
  constexpr std::array<const char*, n_troubles> codes = {"E01", "E02", "E03", "E04", "E05", "E06",
                                                         "E07", "E08", "W01", "W02", "W03", "W04", "W05"};
  return codes[static_cast<std::size_t>(trouble)];
}

// A refusal with a page.
class DocumentedError : public InputError {
 public:
  DocumentedError(Trouble which, Place at, std::string broken_rule, std::string how_to_mend)
      : InputError(std::move(at), std::move(broken_rule), std::move(how_to_mend)), trouble(which) {}
  Trouble trouble;
};

// " [E01]", to stand at the end of a message; of a refusal without a page nothing.
inline std::string mark_of(Trouble trouble) { return std::string(" [") + code_of(trouble) + "]"; }
inline std::optional<Trouble> trouble_of(const InputError& error) {
  const auto* documented = dynamic_cast<const DocumentedError*>(&error);
  return documented ? std::optional(documented->trouble) : std::nullopt;
}

// What a refusal says, with its code.
inline std::string told(const InputError& error) {
  const auto trouble = trouble_of(error);
  return error.what() + (trouble ? mark_of(*trouble) : "");
}

// Throws the same refusal at another place or with other words: its page stays.
[[noreturn]] inline void throw_like(const InputError& error, Place at, std::string rule, std::string mend) {
  if (const auto trouble = trouble_of(error))
    throw DocumentedError(*trouble, std::move(at), std::move(rule), std::move(mend));
  throw InputError(std::move(at), std::move(rule), std::move(mend));
}

}  // namespace servodx
