// What the codes of refusals and warnings mean: in a line each, and as the section of docs/errors.md.
#pragma once
#include <optional>
#include <string>

#include "base/trouble.h"

namespace servodx::report {

bool is_refusal(Trouble trouble);  // else a warning: the call goes on
std::string meaning_of(Trouble trouble);
std::string remedy_of(Trouble trouble);
std::string table_of_troubles();                                 // a line each
std::string section_of(Trouble trouble);                         // of docs/errors.md, as plain text
std::string where_to_read(Trouble trouble);                      // "'servodx help E02' says what to do"
bool looks_like_code(const std::string& word);                   // "E02", "e2", "[W99]", whether it exists or not
std::optional<Trouble> trouble_called(const std::string& word);  // "E02", "e02", "[E02]"
std::string codes_of_troubles();                                 // "E01, E02, ..."

}  // namespace servodx::report
