#include "report/list/trouble_words.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "report/shared/assets.h"
#include "report/shared/columns.h"

namespace servodx::report {
namespace {

struct Words {
  const char* meaning;
  const char* remedy;
};

Words words_of(Trouble trouble) {
  switch (trouble) {
    case Trouble::unit:
      return {"a column or a quantity has no unit, or one that is not known",
              "write it as 'name [unit]', or map the column in the rig file"};
    case Trouble::signal:
      return {"the log lacks time, the drive or every response",
              "map your column's name to the signal in [columns] of the rig file; 'servodx init LOG' begins one"};
    case Trouble::time:
      return {"a time stamp is not after the one above it", "sort the rows, remove repeated ones, look at the unit"};
    case Trouble::row:
      return {"a row has another number of cells than the header, or a cell is no number",
              "mend the line that is named; a decimal comma needs ';' between the cells"};
    case Trouble::binary:
      return {"the file is a workbook, an archive or a recorder's own form, and no text", "export it as CSV"};
    case Trouble::key:
      return {"a key of a TOML file is not known there", "correct its spelling, or move it to its section"};
    case Trouble::untuned:
      return {"the table has no standard errors: it was not made by 'servodx tune'",
              "tune it on fault-free logs, and give the tuned table"};
    case Trouble::other_table:
      return {"the baseline was made with another table than the one that is given",
              "give that table, or make a baseline with this one"};
    case Trouble::unlike_test:
      return {"no fault-free log of the baseline is of a test like this one",
              "record fault-free logs of this test, and make a baseline with them"};
    case Trouble::few_logs:
      return {"the rate of false alarms that was asked for takes more fault-free logs",
              "record as many more as the message says, or ask for a higher rate"};
    case Trouble::implausible:
      return {"a log holds values that can be read but hardly believed",
              "look at the signal's unit, sign, gain and sensor; 'servodx check-log LOG' says more"};
    case Trouble::rig_forgotten:
      return {"the baseline was made with a rig file, and this call names none", "add --rig RIG.toml"};
    case Trouble::other_rig:
      return {"the rig file says other things than the one that the baseline was made with",
              "give that file, or make table and baseline anew with this one"};
  }
  return {"", ""};
}

// As it stands in a message or as it is typed: "[E02]", "e02".
std::string bare_code(const std::string& word) {
  std::string code;
  for (const char c : word)
    if (c != '[' && c != ']') code += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return code;
}

}  // namespace

bool is_refusal(Trouble trouble) { return trouble <= Trouble::other_table; }
std::string meaning_of(Trouble trouble) { return words_of(trouble).meaning; }
std::string remedy_of(Trouble trouble) { return words_of(trouble).remedy; }

std::string table_of_troubles() {
  Columns table("llll");
  table.row({"code", "kind", "meaning", "what to do"});
  for (int i = 0; i < n_troubles; ++i) {
    const auto trouble = static_cast<Trouble>(i);
    table.row({code_of(trouble), is_refusal(trouble) ? "refusal" : "warning", meaning_of(trouble), remedy_of(trouble)});
  }
  return table.text() + "'servodx help CODE' says more\n";
}

std::string section_of(Trouble trouble) {
  const std::string_view page = assets::errors_page;
  const std::string head = std::string("\n## ") + code_of(trouble) + "\n";
  const auto at = page.find(head);
  if (at == std::string_view::npos) return "";
  const auto from = at + head.size(), to = page.find("\n## ", from);
  std::string text = std::string(code_of(trouble)) + ": " + std::string(page.substr(from, to - from));
  for (auto mark = text.find("**"); mark != std::string::npos; mark = text.find("**")) text.erase(mark, 2);
  text.erase(text.find_last_not_of('\n') + 1);
  return text + "\n";
}

std::string where_to_read(Trouble trouble) {
  return std::string("'servodx help ") + code_of(trouble) + "' says what to do";
}

bool looks_like_code(const std::string& word) {
  const std::string code = bare_code(word);
  return code.size() > 1 && (code[0] == 'E' || code[0] == 'W') &&
         std::all_of(code.begin() + 1, code.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::optional<Trouble> trouble_called(const std::string& word) {
  const std::string code = bare_code(word);
  for (int i = 0; i < n_troubles; ++i)
    if (const auto trouble = static_cast<Trouble>(i); code_of(trouble) == code) return trouble;
  return std::nullopt;
}

std::string codes_of_troubles() {
  std::string codes;
  for (int i = 0; i < n_troubles; ++i)
    codes += (codes.empty() ? "" : ", ") + std::string(code_of(static_cast<Trouble>(i)));
  return codes;
}

}  // namespace servodx::report
