// What a row means, in a line: of the table, or of an effect.
#pragma once
#include <string>

namespace servodx {

std::string meaning_of_row(const std::string& name);  // "" of a name that is no row's

}  // namespace servodx
