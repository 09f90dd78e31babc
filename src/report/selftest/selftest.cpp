#include "report/selftest/selftest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/student.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"

namespace servodx::report {
namespace {

constexpr double promised = 0.95;
constexpr double chance_of_bias =
    0.0027;  // of a row without bias: 3 sigmas; Student's, as the scatter is of few repeats

double share(const SelftestResult& r) {
  return r.counted ? static_cast<double>(r.covered) / static_cast<double>(r.counted) : NAN;
}

bool is_biased(const SelftestRow& row, const SelftestResult& r) {
  return student_tail(row.bias_sigmas, std::max(1, r.repeats - r.failed - 1)) < chance_of_bias;
}

long biased(const SelftestResult& r) {
  return std::count_if(r.rows.begin(), r.rows.end(), [&](const SelftestRow& row) { return is_biased(row, r); });
}

std::string coverage_words(const SelftestResult& r) {
  return fmt::format("{} of its 95 % intervals hold the truth ({} to {}, from {} repeat{})", percent(share(r)),
                     percent(r.coverage_lower), percent(r.coverage_upper), r.repeats - r.failed,
                     r.repeats - r.failed == 1 ? "" : "s");
}

std::string headline(const SelftestResult& r) {
  return fmt::format("{}: {}", file_name(r.log),
                     r.coverage_upper < promised ? "the fit's errors are too small on this input"
                     : biased(r) > 0 ? "nothing speaks against the fit's stated errors, but some parameters are biased"
                                     : "the fit finds the truth again, and nothing speaks against its stated errors");
}

std::string bias_words(const SelftestResult& r) {
  std::vector<std::string> names;
  for (const SelftestRow& row : r.rows)
    if (is_biased(row, r)) names.push_back(row.name);
  return fmt::format("{} of {} parameters are biased beyond chance (3 sigmas){}{}", names.size(), r.rows.size(),
                     names.empty() ? "" : ": ", join(names));
}

}  // namespace

std::string text_of(const SelftestResult& r) {
  std::string text = headline(r) + "\n  " + coverage_words(r) + "\n  " + bias_words(r) + "\n";
  if (r.failed > 0) text += fmt::format("  {} of {} repeats failed\n", r.failed, r.repeats);
  Columns rows("lrrrrrrl", 2);
  rows.row({"parameter", "value", "bias", "in sigmas", "rms error", "says +-", "held truth", "unit"});
  for (const SelftestRow& row : r.rows) {
    const HandyUnit unit = handy_unit(row.unit, std::max(std::abs(row.nominal), row.rms));
    rows.row({row.name, digits(row.nominal * unit.factor), digits(row.bias * unit.factor, 2),
              digits(row.bias_sigmas, 2), digits(row.rms * unit.factor, 2), digits(row.std_error * unit.factor, 2),
              fmt::format("{} of {}", row.covered, row.counted), unit.name});
  }
  text += rows.text();
  if (!r.held.empty()) text += "  held, as this log does not show them: " + join(r.held) + "\n";
  return text + "  the data were made by the model itself: this tests the input and the fit, not the model\n";
}

Json selftest_json(const SelftestResult& r) {
  const auto number = [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); };
  Json rows = Json::array();
  for (const SelftestRow& row : r.rows)
    rows.push_back({{"name", row.name},
                    {"unit", row.unit},
                    {"nominal", number(row.nominal)},
                    {"bias", number(row.bias)},
                    {"bias_sigmas", number(row.bias_sigmas)},
                    {"rms", number(row.rms)},
                    {"std_error", number(row.std_error)},
                    {"covered", row.covered},
                    {"counted", row.counted}});
  return {
      {"log", r.log},
      {"repeats", r.repeats},
      {"failed", r.failed},
      {"coverage",
       {{"value", number(share(r))}, {"lower", r.coverage_lower}, {"upper", r.coverage_upper}, {"promised", promised}}},
      {"biased", biased(r)},
      {"parameters", rows},
      {"held", r.held},
      {"interrupted", r.interrupted}};
}

Page selftest_page(const Header& header, const SelftestResult& r) {
  Page page(header, "Selftest on the input of " + file_name(r.log));
  Verdict v;
  v.tone = r.coverage_upper >= promised && biased(r) == 0 ? Tone::good : Tone::doubt;
  v.headline = headline(r);
  v.detail =
      "Made-up truths, the log's own input and noise: what the fit finds again. The data were made by the model "
      "itself: "
      "this tests the input and the fit, not the model.";
  v.facts = {{"95 % intervals that hold the truth", percent(share(r))},
             {"In the long run between", percent(r.coverage_lower) + " and " + percent(r.coverage_upper)},
             {"Repeats", fmt::format("{}, {} failed", r.repeats, r.failed)},
             {"Biased parameters", fmt::format("{} of {}", biased(r), r.rows.size())}};
  page.verdict(v);
  page.section("Parameter by parameter",
               "Sigmas: the bias over the scatter of its mean. Beyond 3, or more with few repeats, it is no chance.");
  Bars bars{"Share of intervals that hold the truth", "parameter", "share", {}, Mark{promised, "95 %"}, 1.1};
  TablePart table{"Bias and error",
                  "lrrrrrl",
                  {"parameter", "value", "bias", "bias in sigmas", "rms error", "error stated", "unit"},
                  {},
                  0};
  for (const SelftestRow& row : r.rows) {
    const HandyUnit unit = handy_unit(row.unit, std::max(std::abs(row.nominal), row.rms));
    const auto cell = [&](double value) { return Cell(digits(value * unit.factor), value); };
    const double part = row.counted ? static_cast<double>(row.covered) / row.counted : 0;
    bars.rows.push_back({words(row.name), part, fmt::format("{} of {}", row.covered, row.counted), "",
                         part >= 0.8 ? Tone::good : Tone::doubt, ""});
    table.rows.push_back({words(row.name), cell(row.nominal), cell(row.bias),
                          Cell(digits(row.bias_sigmas, 2), row.bias_sigmas), cell(row.rms), cell(row.std_error),
                          unit.name});
  }
  page.add(table);
  page.add(bars);
  if (!r.held.empty()) page.text("Held at the table's value, as this log does not show them: " + join(r.held) + ".");
  return page;
}

}  // namespace servodx::report
