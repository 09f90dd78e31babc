// A text as TOML writes it.
#pragma once
#include <fmt/format.h>

#include <string>

namespace servodx {

inline std::string toml_quoted(const std::string& text) {
  std::string safe = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') safe += '\\';
    // TOML wants these by their number.
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7F)
      safe += fmt::format("\\u{:04X}", byte);
    else
      safe += c;
  }
  return safe + "\"";
}

}  // namespace servodx
