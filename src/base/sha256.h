// SHA-256 of bytes, as lower-case hex: the identity of an input file in every result.
#pragma once
#include <string>
#include <string_view>

namespace servodx {

std::string sha256(std::string_view bytes);
std::string sha256_of_file(const std::string& path);  // throws InputError where the file cannot be read

}  // namespace servodx
