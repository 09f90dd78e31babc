#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/wilson.h"
#include "fleet/confusion.h"
#include "fleet/fleet_verdict.h"
#include "fleet/gather.h"
#include "report/fleet/calibration_report.h"
#include "report/fleet/detectable_report.h"
#include "report/fleet/fleet.h"
#include "report/fleet/fleet_words.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"

namespace servodx::report {
namespace {

// Rows of logs on a page: a browser opens 20,000 in 5 s and 2,000 in 1.2 s. The CSV of `gather` has all.
constexpr std::size_t most_logs = 2000;
constexpr std::size_t rows_shown = 50;  // of a table; the others open on a click

struct VerdictCounts {
  long healthy = 0, fault = 0, unknown = 0;
};

VerdictCounts counts_of(const FleetTable& table) {
  VerdictCounts n;
  for (const FleetRow& row : table.rows) {
    n.healthy += row.is_healthy();
    n.fault += row.verdict == FleetVerdict::fault;
    n.unknown += row.verdict == FleetVerdict::unknown;
  }
  return n;
}

void add_names(Page& page, const FleetTable& table) {
  std::map<std::string, long> counts;
  for (const FleetRow& row : table.rows) ++counts[row.name()];
  Bars bars;
  bars.title = "Verdicts";
  bars.label = "verdict", bars.unit = "logs";
  for (const auto& [name, n] : counts)
    bars.rows.push_back({words(name), static_cast<double>(n), std::to_string(n), "",
                         name == "healthy"   ? Tone::good
                         : name == "unknown" ? Tone::doubt
                                             : Tone::bad});
  std::stable_sort(bars.rows.begin(), bars.rows.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
  if (!bars.rows.empty()) page.add(bars);
}

// A path as an address: what is no plain character stands as its bytes (RFC 3986).
std::string address_of(const std::string& path) {
  std::string out;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

Cell log_cell(const FleetRow& row, const std::string& results) {
  Cell cell(row.log);
  if (!row.page.empty() && !results.empty()) cell.link = address_of(results + "/" + row.page);
  return cell;
}

void add_rows(Page& page, const FleetTable& table, const std::string& results) {
  const std::size_t rows = std::min(table.rows.size(), most_logs);
  TablePart part{
      rows == table.rows.size() ? "Logs, worst first" : fmt::format("The worst {} of {} logs", rows, table.rows.size()),
      "lllrrr",
      {"log", "verdict", "fault", "severity (95 %)", "probability", "error / threshold"},
      {},
      rows_shown};
  for (std::size_t i = 0; i < rows; ++i) {
    const FleetRow& row = table.rows[i];
    Cell verdict(word_of(row.verdict));
    verdict.tone = row.is_healthy() ? Tone::good : row.verdict == FleetVerdict::fault ? Tone::bad : Tone::doubt;
    const std::string size = severity_words(row);
    part.rows.push_back({log_cell(row, results), verdict, words(row.fault),
                         size.empty() ? Cell("") : Cell(size, row.severity),
                         Cell(probability_words(row), row.probability), Cell(digits(row.excess()), row.excess())});
  }
  page.add(part);
}

void add_set_aside(Page& page, const std::string& title, const std::vector<SetAside>& files) {
  if (files.empty()) return;
  TablePart part{title, "lrlll", {"file", "line", "column", "rule", "mend"}, {}, rows_shown};
  for (const SetAside& f : files)
    part.rows.push_back({f.file, f.line > 0 ? std::to_string(f.line) : "", f.column, f.rule, f.mend});
  page.add(part);
}

void add_confusion(Page& page, const Confusion& confusion) {
  page.section("Truth", "Rows are what the logs are, columns what was said of them.");
  Matrix m{"Verdicts by truth", "truth", "verdict", {}, {}, {}, "", true};
  for (const std::string& name : confusion.names) m.columns.push_back(words(name));
  for (const std::string& label : confusion.classes) {
    m.rows.push_back(words(label));
    m.value.emplace_back();
    for (const std::string& name : confusion.names)
      m.value.back().push_back(static_cast<double>(count_of(confusion, label, name)));
  }
  page.add(m);
  TablePart part{"Rates with Wilson's 95 % interval",
                 "lllll",
                 {"truth", "found", "named", "severity within its interval", "false alarms"},
                 {},
                 0};
  for (const std::string& label : confusion.classes) {
    const Confusion::OfClass& of = confusion.rates.at(label);
    if (label == "healthy")
      part.rows.push_back({words(label), "", "", "", rate_cell(of.detected)});
    else
      part.rows.push_back({words(label), rate_cell(of.detected), rate_cell(of.named), rate_cell(of.sized), ""});
  }
  page.add(part);
  add_calibration(page, confusion.calibration);
  add_detectable_found(page, confusion.detectable);
}

}  // namespace

std::string fleet_headline(const FleetTable& table) {
  const VerdictCounts n = counts_of(table);
  std::string text =
      fmt::format("{} logs: {} healthy, {} fault, {} unknown", table.rows.size(), n.healthy, n.fault, n.unknown);
  if (!table.refused.empty()) text += fmt::format("; {} set aside", table.refused.size());
  if (!table.unread.empty()) text += fmt::format("; {} files are no results", table.unread.size());
  return text;
}

std::string severity_words(const FleetRow& row) {
  if (row.fault.empty() || !std::isfinite(row.severity)) return "";
  return handy_interval(row.severity, row.severity_lower, row.severity_upper, row.severity_unit);
}

std::string probability_words(const FleetRow& row) {
  return row.verdict == FleetVerdict::fault ? chance(row.probability) : "-";
}

std::string rate_words(const CountedRate& rate) {
  if (rate.of == 0) return "none";
  const auto of = static_cast<double>(rate.of);
  const RateInterval interval = wilson_95(static_cast<double>(rate.counted), of);
  return fmt::format("{} of {}, {} ({} to {})", rate.counted, rate.of, percent(static_cast<double>(rate.counted) / of),
                     percent(interval.lower), percent(interval.upper));
}

Cell rate_cell(const CountedRate& rate) {
  if (rate.of == 0) return "";
  return Cell(rate_words(rate), static_cast<double>(rate.counted) / static_cast<double>(rate.of));
}

Json rate_json(const CountedRate& rate) {
  const RateInterval interval = wilson_95(static_cast<double>(rate.counted), static_cast<double>(rate.of));
  return {{"counted", rate.counted}, {"of", rate.of}, {"lower", interval.lower}, {"upper", interval.upper}};
}

long count_of(const Confusion& confusion, const std::string& label, const std::string& name) {
  const auto row = confusion.counts.find(label);
  if (row == confusion.counts.end()) return 0;
  const auto cell = row->second.find(name);
  return cell == row->second.end() ? 0 : cell->second;
}

Page fleet_page(const Header& header, const FleetTable& table, const std::optional<Confusion>& confusion,
                const std::string& results) {
  Page page(header, "Fleet");
  const VerdictCounts n = counts_of(table);
  Verdict v;
  v.tone = n.fault > 0 ? Tone::bad : n.unknown > 0 ? Tone::doubt : Tone::good;
  v.headline = fleet_headline(table);
  page.verdict(v);
  page.section("Logs");
  add_names(page, table);
  add_rows(page, table, results);
  add_set_aside(page, "Logs that were set aside", table.refused);
  add_set_aside(page, "Files of the folder that are no results", table.unread);
  if (confusion) add_confusion(page, *confusion);
  return page;
}

}  // namespace servodx::report
