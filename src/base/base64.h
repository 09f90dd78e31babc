// Bytes as base64 (RFC 4648), in one line.
#pragma once
#include <string>
#include <string_view>

namespace servodx {

std::string base64(std::string_view bytes);

}  // namespace servodx
