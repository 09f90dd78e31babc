// ASCII letters made small; all else, the bytes of UTF-8 too, stays.
#pragma once
#include <cctype>
#include <string>

namespace servodx {

inline std::string in_small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace servodx
