// The words of a column's name, in whatever alphabet and case a recorder writes them.
#pragma once
#include <string>
#include <vector>

namespace servodx {

// Small letters without accents: cut at everything that is no letter or digit, and where camelCase turns.
std::vector<std::string> words_of_name(const std::string& written);

}  // namespace servodx
