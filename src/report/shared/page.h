// One self-contained HTML file: verdict first, then the parts that show why it holds. Opens offline, fetches nothing
// (its content policy forbids it), prints, follows the reader's light or dark, and is the same bytes for the same
// result.
//
//   Page page(header, "Diagnosis of s1.csv");
//   page.verdict({.tone = Tone::bad, .word = "FAULT", .headline = "..."});
//   page.section("Hypotheses", "Each fitted to the same data.");
//   page.add(Bars{...});
//   write_file("report.html", page.html());
//
// Text is escaped here and nowhere else: parts take it as it came.
#pragma once
#include <string>

#include "report/shared/json.h"
#include "report/shared/parts.h"

namespace servodx::report {

class Page {
 public:
  Page(const Header& header, std::string title);

  void verdict(const Verdict& verdict, const std::string& id = "");
  // Begins a section. Folded ones open on a click.
  void section(const std::string& title, const std::string& lead = "", bool folded = false);
  void text(const std::string& words);
  void add(const Plot& plot);
  void add(const TablePart& table);
  void add(const Bars& bars);
  void add(const Moves& moves);
  void add(const Tornado& tornado);
  void add(const Matrix& matrix);

  void head(const std::string& name, const std::string& value);  // a fact of the page's head

  std::string html();  // ends the page: inputs, settings and notes are its last section

 private:
  void end_section();
  std::string head_html() const;
  std::string csv_button(const std::string& title) const;
  Header header_;
  std::string title_, body_, data_;
  int plots_ = 0, sections_ = 0;
  bool in_section_ = false, folded_ = false;
};

}  // namespace servodx::report
