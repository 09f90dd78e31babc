#include "report/fleet/fleet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/trouble.h"
#include "fleet/fleet_verdict.h"
#include "report/fleet/calibration_report.h"
#include "report/fleet/detectable_report.h"
#include "report/fleet/fleet_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"

namespace servodx::report {
namespace {

Json to_json(const SetAside& s) {
  return {{"file", s.file}, {"line", s.line}, {"column", s.column},
          {"rule", s.rule}, {"mend", s.mend}, {"code", s.code.empty() ? Json(nullptr) : Json(s.code)}};
}

Json to_json(const std::vector<SetAside>& files) {
  Json all = Json::array();
  for (const SetAside& file : files) all.push_back(to_json(file));
  return all;
}

Json to_json(const FleetRow& row) {
  return {{"log", row.log},
          {"file", row.file},
          {"verdict", word_of(row.verdict)},
          {"fault", row.fault.empty() ? Json(nullptr) : Json(row.fault)},
          {"severity",
           {{"value", number(row.severity)},
            {"lower", number(row.severity_lower)},
            {"upper", number(row.severity_upper)},
            {"unit", row.severity_unit}}},
          {"probability", number(row.probability)},
          {"error", number(row.error)},
          {"threshold", number(row.threshold)}};
}

Json to_json(const Confusion& confusion) {
  Json classes = Json::array();
  for (const std::string& label : confusion.classes) {
    const Confusion::OfClass& rates = confusion.rates.at(label);
    const bool is_healthy = label == "healthy";
    Json one = {{"class", label}, {"verdicts", confusion.counts.at(label)}};
    one[is_healthy ? "false_alarms" : "detected"] = rate_json(rates.detected);
    if (!is_healthy) one["named"] = rate_json(rates.named), one["sized"] = rate_json(rates.sized);
    classes.push_back(one);
  }
  return {
      {"classes", classes}, {"without_truth", confusion.without_truth}, {"without_result", confusion.without_result}};
}

std::string set_aside_text(const std::vector<SetAside>& files, const std::string& lead) {
  std::string text;
  for (const SetAside& file : files) text += lead + words_of(file) + "\n";
  return text;
}

// `rest`: where those stand that find no place on a screen.
std::string first_set_aside_text(const std::vector<SetAside>& files, const std::string& rest) {
  constexpr std::size_t most_named = 20;
  const std::size_t named = std::min(files.size(), most_named);
  std::string text = set_aside_text({files.begin(), files.begin() + static_cast<long>(named)}, "  set aside: ");
  if (named < files.size()) text += fmt::format("  and {} more; {}\n", files.size() - named, rest);
  return text;
}

std::string rows_text(const FleetTable& table) {
  if (table.rows.empty()) return "";
  Columns columns("llllrr", 2);
  columns.row({"log", "verdict", "fault", "severity", "probability", "error/threshold"});
  for (const FleetRow& row : table.rows)
    columns.row(
        {row.log, word_of(row.verdict), row.fault, severity_words(row), probability_words(row), digits(row.excess())});
  return columns.text();
}

std::string confusion_text(const Confusion& confusion) {
  Columns counts("l" + std::string(confusion.names.size(), 'r'), 2);
  std::vector<std::string> head = {"truth"};
  head.insert(head.end(), confusion.names.begin(), confusion.names.end());
  counts.row(head);
  for (const std::string& label : confusion.classes) {
    std::vector<std::string> cells = {label};
    for (const std::string& name : confusion.names) cells.push_back(std::to_string(count_of(confusion, label, name)));
    counts.row(cells);
  }
  Columns rates("llll", 2);
  rates.row({"truth", "found (95 %)", "named (95 %)", "severity within its interval (95 %)"});
  for (const std::string& label : confusion.classes) {
    const Confusion::OfClass& of = confusion.rates.at(label);
    if (label == "healthy") continue;
    rates.row({label, rate_words(of.detected), rate_words(of.named), of.sized.of > 0 ? rate_words(of.sized) : ""});
  }
  std::string text = "\nverdicts by truth\n" + counts.text() + "\n";
  if (const auto healthy = confusion.rates.find("healthy"); healthy != confusion.rates.end())
    text += "false alarms: " + rate_words(healthy->second.detected) + "\n";
  if (confusion.rates.size() > confusion.rates.count("healthy")) text += rates.text();
  return text + text_of(confusion.calibration) + text_of(confusion.detectable);
}

}  // namespace

SetAside set_aside_of(const InputError& error) {
  SetAside out{error.where.file, error.where.line, error.where.column, error.rule, error.mend};
  if (const auto trouble = trouble_of(error)) out.code = code_of(*trouble);
  return out;
}

std::string words_of(const SetAside& file) {
  const std::string code = file.code.empty() ? "" : " [" + file.code + "]";
  return InputError({file.file, file.line, file.column}, file.rule, file.mend).what() + code;
}

std::string text_of(const FleetRun& run) {
  return fmt::format("{} logs: {} judged, {} stood already, {} set aside; results in {}\n", run.logs, run.made,
                     run.stood, run.set_aside.size(), run.out) +
         fmt::format("  {} healthy, {} fault, {} unknown\n", run.healthy, run.fault, run.unknown) +
         first_set_aside_text(run.set_aside, "'servodx gather' names them");
}

Json fleet_run_json(const FleetRun& run) {
  return {{"out", run.out},
          {"logs", run.logs},
          {"judged", run.made},
          {"stood", run.stood},
          {"verdicts", {{"healthy", run.healthy}, {"fault", run.fault}, {"unknown", run.unknown}}},
          {"set_aside", to_json(run.set_aside)},
          {"interrupted", run.interrupted}};
}

std::string text_of(const CheckRun& run) {
  return fmt::format("{} checks: {} recorded, {} were in the history already, {} set aside; history in {}\n", run.logs,
                     run.made, run.stood, run.set_aside.size(), run.history) +
         first_set_aside_text(run.set_aside, "'--json FILE' names them");
}

Json check_run_json(const CheckRun& run) {
  return {{"history", run.history},
          {"out", run.out.empty() ? Json(nullptr) : Json(run.out)},
          {"logs", run.logs},
          {"recorded", run.made},
          {"stood", run.stood},
          {"set_aside", to_json(run.set_aside)},
          {"interrupted", run.interrupted}};
}

Json refusal_json(const std::string& log, const InputError& error) {
  return {{"log", log}, {"refused", to_json(set_aside_of(error))}};
}

std::string text_of(const FleetTable& table, const std::optional<Confusion>& confusion) {
  std::string text = fleet_headline(table) + "\n" + rows_text(table);
  text += set_aside_text(table.refused, "  log set aside: ") + set_aside_text(table.unread, "  no result: ");
  return text + (confusion ? confusion_text(*confusion) : "");
}

Json fleet_json(const FleetTable& table, const std::optional<Confusion>& confusion) {
  Json rows = Json::array(), verdicts = Json::object();
  std::map<std::string, long> counts;
  for (const FleetRow& row : table.rows) rows.push_back(to_json(row)), ++counts[row.name()];
  for (const auto& [name, n] : counts) verdicts[name] = n;
  return {{"logs", table.rows.size()},
          {"verdicts", verdicts},
          {"results", rows},
          {"set_aside", to_json(table.refused)},
          {"unread", to_json(table.unread)},
          {"confusion", confusion ? to_json(*confusion) : Json(nullptr)},
          {"calibration", confusion ? to_json(confusion->calibration) : Json(nullptr)},
          {"detectable_found", confusion ? to_json(confusion->detectable) : Json(nullptr)}};
}

namespace {

std::optional<Confusion> whole_of(const FleetCounts* counts) {
  return counts ? std::optional<Confusion>(*counts->whole) : std::nullopt;
}

}  // namespace

std::string text_of(const Fleet& fleet, const FleetCounts* counts) { return text_of(*fleet.whole, whole_of(counts)); }
Json fleet_json(const Fleet& fleet, const FleetCounts* counts) { return fleet_json(*fleet.whole, whole_of(counts)); }
Page fleet_page(const Header& header, const Fleet& fleet, const FleetCounts* counts, const std::string& results) {
  return fleet_page(header, *fleet.whole, whole_of(counts), results);
}

}  // namespace servodx::report
