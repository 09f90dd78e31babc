#include "report/curves/data_sheet.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/units.h"
#include "fit/constants.h"
#include "parameters/list.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/data_sheet.h"

namespace servodx::report {
namespace {

const char* key_of(SheetKind kind) {
  constexpr const char* keys[] = {"step_rise_time", "gain", "phase_lag"};
  return keys[static_cast<std::size_t>(kind)];
}
const char* si_unit(SheetKind kind) {
  constexpr const char* units[] = {"s", "dB", "rad"};
  return units[static_cast<std::size_t>(kind)];
}
const char* key_of(SheetRows rows) {
  constexpr const char* keys[] = {"formulas", "fitted", "tuned"};
  return keys[static_cast<std::size_t>(rows)];
}

std::string readable(SheetKind kind, double value) {
  switch (kind) {
    case SheetKind::step_rise_time:
      return digits(value * 1e3, 3) + " ms";
    case SheetKind::gain:
      return fmt::format("{:.1f} dB", value);
    case SheetKind::phase_lag:
      return fmt::format("{:.0f} deg", value * 180 / std::numbers::pi);
  }
  return "";
}

std::string of_what(const SheetFigure& f) {
  const std::string amplitude = digits(100 * f.amplitude, 3) + " % of rated";
  if (f.kind == SheetKind::step_rise_time) return "step to " + amplitude;
  return digits(f.frequency, 4) + " Hz, +-" + amplitude;
}

std::string at(const SheetFit& sheet, const std::vector<double>& simulated, std::size_t k) {
  return simulated.empty() ? "-" : readable(sheet.figures[k].kind, simulated[k]);
}

bool is_met(const SheetFit& sheet, std::size_t k) {
  if (sheet.after.empty()) return false;
  const SheetFigure& f = sheet.figures[k];
  return std::fabs(sheet.after[k] - f.stated) <= fit_constants::met_within * f.tolerance;
}
std::string word_of(bool met) { return met ? "met" : "NOT MET"; }

const char* words_of(SheetRows rows) {
  switch (rows) {
    case SheetRows::formulas:
      return "The rows follow from the sheet's other facts by formulas; 'step_rise_time' or 'frequency_response' in "
             "the "
             "rig file has them fitted.";
    case SheetRows::fitted:
      return "The rows were fitted to these figures, ahead of any log.";
    case SheetRows::tuned:
      return "The table is tuned: its rows are of logs, and the sheet does not move them.";
  }
  return "";
}

std::string name_of(const SheetRow& r) {
  return std::string(parameter_list[static_cast<std::size_t>(r.position)].name);
}

constexpr const char* tells_head = "a tenth more moves the figures by [tolerances]";

}  // namespace

std::string text_of(const SheetFit& sheet) {
  if (sheet.figures.empty()) return "The rig file states no step, frequency response or phase lag of the valve.\n";
  const bool fitted = sheet.rows_are == SheetRows::fitted;
  Columns figures("llrrrl", 2);
  figures.row({"data sheet", "", "stated", fitted ? "by formulas" : "", "simulated", ""});
  for (std::size_t k = 0; k < sheet.figures.size(); ++k)
    figures.row({key_of(sheet.figures[k].kind), of_what(sheet.figures[k]),
                 readable(sheet.figures[k].kind, sheet.figures[k].stated), fitted ? at(sheet, sheet.before, k) : "",
                 at(sheet, sheet.after, k), word_of(is_met(sheet, k))});
  Columns rows("lrrlr", 2);
  rows.row({"row", fitted ? "by formulas" : "", "value", "unit", tells_head});
  for (const SheetRow& r : sheet.rows)
    rows.row({name_of(r), fitted ? digits(r.before, 4) : "", digits(r.after, 4),
              std::string(parameter_list[static_cast<std::size_t>(r.position)].unit), digits(r.tells, 2)});
  return figures.text() + words_of(sheet.rows_are) + "\n" + rows.text();
}

Json data_sheet_json(const SheetFit& sheet) {
  Json figures = Json::array(), rows = Json::array();
  const auto value = [&](const std::vector<double>& simulated, std::size_t k) {
    return simulated.empty() ? Json(nullptr) : number(simulated[k]);
  };
  for (std::size_t k = 0; k < sheet.figures.size(); ++k) {
    const SheetFigure& f = sheet.figures[k];
    figures.push_back({{"name", key_of(f.kind)},
                       {"frequency", f.kind == SheetKind::step_rise_time ? Json(nullptr) : number(f.frequency)},
                       {"amplitude", f.amplitude},
                       {"stated", f.stated},
                       {"by_formulas", value(sheet.before, k)},
                       {"simulated", value(sheet.after, k)},
                       {"tolerance", f.tolerance},
                       {"unit", si_unit(f.kind)},
                       {"met", is_met(sheet, k)}});
  }
  for (const SheetRow& r : sheet.rows)
    rows.push_back({{"name", name_of(r)},
                    {"by_formulas", r.before},
                    {"nominal", r.after},
                    {"unit", parameter_list[static_cast<std::size_t>(r.position)].unit},
                    {"tells", number(r.tells)}});
  return {{"rows_are", key_of(sheet.rows_are)}, {"figures", figures}, {"rows", rows}};
}

void add_data_sheet(Page& page, const SheetFit& sheet) {
  page.section("Data sheet", std::string("What it states of the dynamics, and what the table's valve does. ") +
                                 words_of(sheet.rows_are));
  TablePart figures{"Dynamics", "llrrrl", {"figure", "at", "stated", "by formulas", "simulated", ""}, {}, 0};
  for (std::size_t k = 0; k < sheet.figures.size(); ++k) {
    Cell judgement = word_of(is_met(sheet, k));
    judgement.tone = is_met(sheet, k) ? Tone::good : Tone::bad;
    figures.rows.push_back({words(key_of(sheet.figures[k].kind)), of_what(sheet.figures[k]),
                            readable(sheet.figures[k].kind, sheet.figures[k].stated), at(sheet, sheet.before, k),
                            at(sheet, sheet.after, k), judgement});
  }
  page.add(figures);
  TablePart rows{"Rows", "lrrlr", {"row", "by formulas", "value", "unit", tells_head}, {}, 0};
  for (const SheetRow& r : sheet.rows)
    rows.rows.push_back({words(name_of(r)), Cell(digits(r.before, 4), r.before), Cell(digits(r.after, 4), r.after),
                         std::string(parameter_list[static_cast<std::size_t>(r.position)].unit),
                         Cell(digits(r.tells, 2), r.tells)});
  page.add(rows);
}

Page data_sheet_page(const Header& header, const SheetFit& sheet) {
  Page page(header, "Data sheet and table");
  long met_ones = 0;
  for (std::size_t k = 0; k < sheet.figures.size(); ++k) met_ones += is_met(sheet, k);
  const bool all = met_ones == static_cast<long>(sheet.figures.size());
  Verdict v;
  v.tone = all ? Tone::good : Tone::bad;
  v.word = all ? "MET" : "NOT MET";
  v.headline = fmt::format("The table's valve meets {} of {} figures", met_ones, sheet.figures.size());
  page.verdict(v);
  add_data_sheet(page, sheet);
  return page;
}

}  // namespace servodx::report
