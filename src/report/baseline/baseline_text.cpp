#include "report/baseline/baseline_text.h"

#include <fmt/format.h>

#include "diagnose/healthy_law.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "store/baseline_parts.h"

namespace servodx::report {

std::string text_of(const DetectionBaseline& b, const TextOptions& options) {
  std::string text = fmt::format("threshold {} from {}", digits(b.threshold, 4), plural(b.logs, "fault-free log"));
  text += options.written_to.empty() ? "\n" : ": " + options.written_to + "\n";
  text += fmt::format("  {}\n", statement_of(b));
  Columns table("lrr", 2);
  table.row({"log", "score", "adequacy"});
  for (const DetectionBaseline::Score& s : b.scores) table.row({s.log, digits(s.score, 4), digits(s.adequacy)});
  text += table.text();
  for (const DetectionBaseline::Score& s : b.scores)
    if (!is_followed(s.adequacy))
      text += fmt::format(
          "  {}: the model does not follow it, its worst channel is {} times as wrong as on the tuning logs; it sets "
          "no "
          "limit but for tests like its own: tune with a log of its kind\n",
          s.log, digits(s.adequacy, 2));
  return text;
}

std::string text_of(const Baseline& baseline, const TextOptions& options) {
  return text_of(parts_of(baseline).detection, options);
}

}  // namespace servodx::report
