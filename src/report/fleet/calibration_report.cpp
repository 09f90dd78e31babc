#include "report/fleet/calibration_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/wilson.h"
#include "report/fleet/fleet_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/parts.h"

namespace servodx::report {
namespace {

constexpr const char* title = "Stated probabilities of named faults";

std::string range_words(const Calibration::Bin& bin) {
  return fmt::format("{} to {}", digits(100 * bin.from), percent(bin.to));
}

std::string error_words(const Calibration& c) {
  return fmt::format(
      "expected calibration error {} ({} to {}, 95 %); were each probability the true one, 19 of 20 sets of as many "
      "logs would show less than {}",
      percent(c.error), percent(c.lower), percent(c.upper), percent(c.by_chance));
}

// What was stated is the diagonal; probabilities below it are too sure of themselves.
Plot reliability_plot(const Calibration& c) {
  Plot plot{.title = "named rightly [%]", .x_label = "stated probability, mean of its range [%]"};
  Series stated{"as stated", {}, Role::reference}, right{"named rightly", {}, Role::measured, true};
  Band band{"95 %", {}, {}};
  for (const Calibration::Bin& bin : c.bins) {
    const auto n = static_cast<double>(bin.right.of), k = static_cast<double>(bin.right.counted);
    const RateInterval interval = wilson_95(k, n);
    plot.x.push_back(100 * bin.stated);
    stated.y.push_back(100 * bin.stated), right.y.push_back(100 * k / n);
    band.lower.push_back(100 * interval.lower), band.upper.push_back(100 * interval.upper);
  }
  plot.series = {right, stated};
  plot.band = band;
  return plot;
}

}  // namespace

std::string text_of(const Calibration& c) {
  if (c.right.of == 0) return "";
  Columns columns("lll", 2);
  columns.row({"stated", "mean", "named rightly (95 %)"});
  for (const Calibration::Bin& bin : c.bins) columns.row({range_words(bin), chance(bin.stated), rate_words(bin.right)});
  columns.row({"all", chance(c.stated), rate_words(c.right)});
  return fmt::format("\n{} beside their truth\n{}{}\n", title, columns.text(), error_words(c));
}

Json to_json(const Calibration& c) {
  Json bins = Json::array();
  for (const Calibration::Bin& bin : c.bins)
    bins.push_back(
        {{"from", bin.from}, {"to", bin.to}, {"stated", number(bin.stated)}, {"right", rate_json(bin.right)}});
  return {{"bins", bins},
          {"stated", number(c.stated)},
          {"right", rate_json(c.right)},
          {"error", number(c.error)},
          {"lower", number(c.lower)},
          {"upper", number(c.upper)},
          {"by_chance", number(c.by_chance)}};
}

void add_calibration(Page& page, const Calibration& c) {
  if (c.right.of == 0) return;
  constexpr std::size_t fewest_drawn = 3;  // ranges; of fewer the table says all
  TablePart part{title, "lll", {"stated", "mean", "named rightly (95 %)"}, {}, 0};
  for (const Calibration::Bin& bin : c.bins)
    part.rows.push_back({range_words(bin), Cell(chance(bin.stated), bin.stated), rate_cell(bin.right)});
  part.rows.push_back({"all", Cell(chance(c.stated), c.stated), rate_cell(c.right)});
  page.add(part);
  page.text(sentence(error_words(c)));
  if (c.bins.size() >= fewest_drawn) page.add(reliability_plot(c));
}

}  // namespace servodx::report
