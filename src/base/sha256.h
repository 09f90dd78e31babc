// SHA-256 of bytes, as lower-case hex: the identity of an input file in every result.
#pragma once
#include <memory>
#include <string>
#include <string_view>

namespace servodx {

std::string sha256(std::string_view bytes);
std::string sha256_base64(std::string_view bytes);    // as content policies of HTML pages write it
std::string sha256_of_file(const std::string& path);  // throws InputError where the file cannot be read

// Piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(std::string_view bytes);
  std::string hex();  // once, after all is added

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace servodx
