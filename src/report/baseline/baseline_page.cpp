#include "report/baseline/baseline_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/celsius.h"
#include "diagnose/baseline.h"
#include "diagnose/healthy_law.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "store/baseline_parts.h"

namespace servodx::report {

Page baseline_page(const Header& header, const DetectionBaseline& b, const std::vector<Replay>& replays) {
  Page page(header, fmt::format("Baseline of {} fault-free logs", b.logs));
  const bool kept = keeps_rate(b);
  Verdict v;
  v.tone = kept ? Tone::good : Tone::doubt;
  v.headline = fmt::format("A log is not healthy above an error of {}", digits(b.threshold));
  v.detail = statement_of(b);
  v.facts = {{"False alarms asked for", percent(b.asked)},
             {"Promised on average", percent(b.promised)},
             {"Below, with 95 % confidence", percent(b.promised_95)},
             {"Logs needed for what was asked", std::to_string(b.logs_needed)}};
  if (!kept)
    v.reasons.push_back(fmt::format("{} logs cannot promise {}: give {} more.", b.logs, percent(b.asked),
                                    std::max(0, b.logs_needed - b.logs)));
  v.reasons.push_back(
      "The promise holds for logs of like excitation and temperature as these; a diagnosis says where a log is unlike "
      "all of them.");
  page.verdict(v);

  page.section(
      "What fault-free logs score",
      "The threshold is made of these scores. A log far beyond the others deserves a look: is it fault-free, is its "
      "excitation unlike the rest? One that the model does not follow sets limits for tests like its own alone: tune "
      "with a log of its kind.");
  auto order = b.scores;
  std::stable_sort(order.begin(), order.end(), [](const auto& x, const auto& y) { return x.score > y.score; });
  Bars bars{"Scores", "log", "score", {}, Mark{b.threshold, "threshold"}, {}};
  for (const DetectionBaseline::Score& s : order)
    bars.rows.push_back({s.log, s.score, digits(s.score),
                         fmt::format("worst channel {} times its usual error{}", digits(s.adequacy, 2),
                                     is_followed(s.adequacy) ? "" : "; the model does not follow it"),
                         s.score > b.threshold || !is_followed(s.adequacy) ? Tone::doubt : Tone::good, ""});
  page.add(bars);
  if (std::all_of(order.begin(), order.end(), [](const auto& s) { return s.test.has_value(); })) {
    TablePart tests{
        "What tests the promise covers", "lrrr", {"log", "drive spans [mA]", "at about [Hz]", "oil [degC]"}, {}, 0};
    for (const DetectionBaseline::Score& s : order)
      tests.rows.push_back({s.log, Cell(digits(1e3 * s.test->drive_span), 1e3 * s.test->drive_span),
                            Cell(digits(s.test->drive_band, 2), s.test->drive_band),
                            s.test->temperature
                                ? Cell(digits(*s.test->temperature - zero_celsius), *s.test->temperature - zero_celsius)
                                : Cell("")});
    page.add(tests);
  }
  for (const DetectionBaseline::Score& s : order)
    for (const Replay& r : replays) {
      if (r.log != s.log) continue;
      page.section(fmt::format("{}: score {}", file_name(s.log), digits(s.score)),
                   "The tuned model, its null and air fitted to this log, against the measurement.",
                   &s != &order.front());
      add_replay(page, r, {.shown = {}, .onset = {}, .logs = replays.size()});
    }
  return page;
}

Page baseline_page(const Header& header, const Baseline& baseline, const std::vector<Replay>& replays) {
  return baseline_page(header, parts_of(baseline).detection, replays);
}

}  // namespace servodx::report
