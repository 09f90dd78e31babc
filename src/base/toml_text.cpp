#include "base/toml_text.h"

#include <cctype>
#include <vector>

#include "base/error.h"
#include "base/reading_limits.h"

namespace servodx {
namespace {

// Walks over the text and counts the levels it stands in. A dot is a level wherever it stands but in texts and
// comments: no number has more than one. What is no TOML is left to the parser, which stops where it begins.
class Limits {
 public:
  Limits(std::string_view text, const std::string& path, const std::string& mend)
      : text_(text), path_(path), mend_(mend) {}

  void refuse_beyond() {
    for (; at_ < text_.size(); ++at_) {
      step(text_[at_]);
      if (header_ + within_ + key_ > deepest_toml)
        refuse("nests deeper than " + std::to_string(deepest_toml) + " levels");
      if (length_ > longest_name)
        refuse("has a name or a text of more than " + std::to_string(longest_name) + " bytes");
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& rule) const {
    throw InputError({path_, line_, ""}, rule + ", at character " + std::to_string(at_ - line_start_ + 1), mend_);
  }

  void step(char c) {
    ++length_;
    if (std::string_view("=,.[]{}#\n\r\t ").find(c) != std::string_view::npos) length_ = 0;
    switch (c) {
      case '"':
      case '\'':
        return pass_text(c);
      case '#':
        return pass_comment();
      case '\n':
        return end_line();
      case '[':
      case '{':
        return open(c);
      case ']':
      case '}':
        return close();
      case ',':
        key_ = 0;
        return;
      case '=':
        is_value_ = true;
        return;
      case '.':
        ++key_;
        return;
      default:
        if (key_ == 0 && !std::isspace(static_cast<unsigned char>(c))) key_ = 1;
    }
  }

  // A bracket that no '=' precedes in its line begins a section's header, whose name counts from the top.
  void open(char c) {
    if (open_.empty() && !is_value_ && c == '[') {
      header_ = is_header_ ? 1 : 0;  // of [[...]] the element is a level
      key_ = 0;
      is_header_ = true;
      return;
    }
    open_.push_back(key_ + 1);
    within_ += key_ + 1;
    key_ = 0;
  }

  void close() {
    if (is_header_) {
      header_ += key_;
      key_ = 0;
    } else if (!open_.empty()) {
      within_ -= open_.back();
      key_ = 0;
      open_.pop_back();
    }
  }

  void end_line() {
    ++line_;
    line_start_ = at_ + 1;
    is_header_ = false;
    if (!open_.empty()) return;
    key_ = 0;
    is_value_ = false;
  }

  void pass_comment() {
    while (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
  }

  // To the last of its quotes; one that has no end ends with its line, where the parser stops.
  void pass_text(char quote) {
    const std::string triple(3, quote);
    const bool long_text = text_.substr(at_, 3) == triple;
    if (key_ == 0) key_ = 1;
    const std::size_t from = at_ + (long_text ? 3 : 1);
    for (at_ = from; at_ < text_.size(); ++at_) {
      length_ = at_ - from;
      if (length_ > longest_name) return;
      const char c = text_[at_];
      if (c == '\\' && quote == '"' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n') {
        ++at_;
      } else if (c == '\n') {
        if (!long_text) return end_line();
        ++line_;
        line_start_ = at_ + 1;
      } else if (c == quote && !long_text) {
        return;
      } else if (c == quote && text_.substr(at_, 3) == triple) {
        at_ += 2;
        for (int own = 0; own < 2 && at_ + 1 < text_.size() && text_[at_ + 1] == quote; ++own) ++at_;  // """a"""""
        return;
      }
    }
  }

  const std::string_view text_;
  const std::string &path_, &mend_;
  std::size_t at_ = 0, line_start_ = 0;
  std::size_t length_ = 0;  // of the word or text being read
  long line_ = 1;
  int header_ = 0;         // levels of the section's name
  int key_ = 0;            // of the name being read
  int within_ = 0;         // of the names and brackets that hold it
  std::vector<int> open_;  // what each of them added
  bool is_header_ = false, is_value_ = false;
};

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& path, const std::string& mend) {
  Limits(text, path, mend).refuse_beyond();
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    throw InputError({path, static_cast<long>(error.source().begin.line), ""},
                     "is not TOML: " + std::string(error.description()), mend);
  }
}

}  // namespace servodx
