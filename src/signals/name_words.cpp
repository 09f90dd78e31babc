#include "signals/name_words.h"

#include <cctype>
#include <cstddef>
#include <string_view>
#include <utility>

namespace servodx {
namespace {

// Umlauts as they are written without, "Oeltemperatur", and letters without their accents, "presion".
std::string without_accents(std::string text) {
  constexpr std::pair<std::string_view, std::string_view> letters[] = {
      {"\xC3\xA4", "ae"}, {"\xC3\xB6", "oe"}, {"\xC3\xBC", "ue"}, {"\xC3\x9F", "ss"}, {"\xC3\x84", "Ae"},
      {"\xC3\x96", "Oe"}, {"\xC3\x9C", "Ue"}, {"\xC3\xA0", "a"},  {"\xC3\x80", "A"},  {"\xC3\xA1", "a"},
      {"\xC3\x81", "A"},  {"\xC3\xA2", "a"},  {"\xC3\x82", "A"},  {"\xC3\xA3", "a"},  {"\xC3\x83", "A"},
      {"\xC3\xA5", "a"},  {"\xC3\x85", "A"},  {"\xC4\x85", "a"},  {"\xC4\x84", "A"},  {"\xC3\xA7", "c"},
      {"\xC3\x87", "C"},  {"\xC4\x87", "c"},  {"\xC4\x86", "C"},  {"\xC4\x8D", "c"},  {"\xC4\x8C", "C"},
      {"\xC3\xA8", "e"},  {"\xC3\x88", "E"},  {"\xC3\xA9", "e"},  {"\xC3\x89", "E"},  {"\xC3\xAA", "e"},
      {"\xC3\x8A", "E"},  {"\xC3\xAB", "e"},  {"\xC3\x8B", "E"},  {"\xC4\x99", "e"},  {"\xC4\x98", "E"},
      {"\xC4\x9B", "e"},  {"\xC4\x9A", "E"},  {"\xC3\xAC", "i"},  {"\xC3\x8C", "I"},  {"\xC3\xAD", "i"},
      {"\xC3\x8D", "I"},  {"\xC3\xAE", "i"},  {"\xC3\x8E", "I"},  {"\xC3\xAF", "i"},  {"\xC3\x8F", "I"},
      {"\xC5\x82", "l"},  {"\xC5\x81", "L"},  {"\xC3\xB1", "n"},  {"\xC3\x91", "N"},  {"\xC5\x84", "n"},
      {"\xC5\x83", "N"},  {"\xC5\x88", "n"},  {"\xC5\x87", "N"},  {"\xC3\xB2", "o"},  {"\xC3\x92", "O"},
      {"\xC3\xB3", "o"},  {"\xC3\x93", "O"},  {"\xC3\xB4", "o"},  {"\xC3\x94", "O"},  {"\xC3\xB5", "o"},
      {"\xC3\x95", "O"},  {"\xC3\xB8", "o"},  {"\xC3\x98", "O"},  {"\xC5\x9B", "s"},  {"\xC5\x9A", "S"},
      {"\xC5\xA1", "s"},  {"\xC5\xA0", "S"},  {"\xC3\xB9", "u"},  {"\xC3\x99", "U"},  {"\xC3\xBA", "u"},
      {"\xC3\x9A", "U"},  {"\xC3\xBB", "u"},  {"\xC3\x9B", "U"},  {"\xC5\xAF", "u"},  {"\xC5\xAE", "U"},
      {"\xC5\xBA", "z"},  {"\xC5\xB9", "Z"},  {"\xC5\xBC", "z"},  {"\xC5\xBB", "Z"},  {"\xC5\xBE", "z"},
      {"\xC5\xBD", "Z"},  {"\xC3\xBD", "y"},  {"\xC3\x9D", "Y"},  {"\xC5\x99", "r"},  {"\xC5\x98", "R"}};
  for (const auto& [accented, plain] : letters)
    for (auto at = text.find(accented); at != text.npos; at = text.find(accented, at))
      text.replace(at, accented.size(), plain);
  return text;
}

// Cyrillic capitals as small letters.
std::string small_cyrillic(std::string text) {
  for (std::size_t k = 0; k + 1 < text.size(); ++k) {
    const auto low = static_cast<unsigned char>(text[k + 1]);
    if (static_cast<unsigned char>(text[k]) != 0xD0 || low < 0x90 || low > 0xAF) continue;
    if (low >= 0xA0) text[k] = static_cast<char>(0xD1);
    text[k + 1] = static_cast<char>(low >= 0xA0 ? low - 0x20 : low + 0x20);
  }
  return text;
}

}  // namespace

std::vector<std::string> words_of_name(const std::string& written) {
  const std::string name = small_cyrillic(without_accents(written));
  std::vector<std::string> words;
  std::string word;
  bool was_lower = false;
  const auto end = [&] {
    if (!word.empty()) words.push_back(word);
    word.clear();
  };
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u)) {
      if (std::isupper(u) && was_lower) end();
      word += static_cast<char>(std::tolower(u));
      was_lower = std::islower(u) != 0;
    } else if (u >= 0x80) {  // a letter of another alphabet
      word += c;
      was_lower = true;
    } else {
      end();
      was_lower = false;
    }
  }
  end();
  return words;
}

}  // namespace servodx
