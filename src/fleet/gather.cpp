#include "fleet/gather.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <tuple>

#include "base/csv.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/result_schema.h"
#include "faults/registry.h"
#include "fleet/result_file.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// What a file is not, and how that is mended.
struct Unfit {
  std::string rule, mend;
};
constexpr const char* make_again = "run 'servodx diagnose --list' again: it makes what is damaged anew";
constexpr const char* move_away = "move it out of the folder";

const Json& at(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key)) throw Unfit{std::string("has no '") + key + "'", make_again};
  return object[key];
}

std::string text_at(const Json& object, const char* key) {
  const Json& value = at(object, key);
  if (!value.is_string()) throw Unfit{std::string("'") + key + "' is not a text", make_again};
  return value.get<std::string>();
}

// null, which stands for what is not finite, is NaN.
double number_at(const Json& object, const char* key) {
  const Json& value = at(object, key);
  if (value.is_null()) return NAN;
  if (!value.is_number()) throw Unfit{std::string("'") + key + "' is not a number", make_again};
  return value.get<double>();
}

// Earlier results have none.
std::vector<LeastShown> detectable_of(const Json& result) {
  std::vector<LeastShown> out;
  if (!result.contains("detectable")) return out;
  const Json& all = at(result, "detectable");
  if (!all.is_object()) throw Unfit{"'detectable' is no list by fault", make_again};
  for (const auto& [label, least] : all.items())
    if (const Fault* fault = find_fault(label)) out.push_back({fault, number_at(least, "value")});
  return out;
}

FleetRow row_of(const Json& result, const std::string& file) {
  FleetRow row;
  row.file = file;
  row.log = text_at(result, "log");
  const std::string verdict = text_at(result, "verdict");
  row.verdict = verdict_named(verdict);
  if (row.verdict == FleetVerdict::none) throw Unfit{"'" + verdict + "' is no verdict", make_again};
  if (!at(result, "fault").is_null()) row.fault = text_at(result, "fault");
  const Json& severity = at(result, "severity");
  row.severity = number_at(severity, "value");
  row.severity_lower = number_at(severity, "lower");
  row.severity_upper = number_at(severity, "upper");
  row.severity_unit = text_at(severity, "unit");
  const Json& probabilities = at(result, "probabilities");
  row.probability = probabilities.contains(row.name()) ? number_at(probabilities, row.name().c_str()) : NAN;
  row.error = number_at(result, "error");
  row.threshold = number_at(result, "threshold");
  row.detectable = detectable_of(result);
  return row;
}

SetAside refusal_of(const Json& file) {
  const Json& refused = at(file, "refused");
  SetAside log;
  log.file = text_at(file, "log");
  const double line = number_at(refused, "line");
  log.line = line > 0 ? std::lround(std::min(line, 1e9)) : 0;
  log.column = text_at(refused, "column");
  log.rule = text_at(refused, "rule");
  log.mend = text_at(refused, "mend");
  if (refused.contains("code") && !refused["code"].is_null()) log.code = text_at(refused, "code");
  return log;
}

// The log's own page beside its result; empty where there is none.
std::string page_beside(const std::string& result) {
  std::error_code ignored;
  const fs::path page = fs::path(result).replace_extension(page_ending);
  return fs::is_regular_file(page, ignored) ? page.filename().string() : "";
}

void read_into(FleetTable& table, const std::string& path, const std::string& name) {
  const Json file = json_in_file<Json>(path, make_again);
  if (!file.is_object()) throw Unfit{"is no whole JSON", make_again};
  const std::string command = file.contains("command") ? text_at(file, "command") : "";
  if (command != "diagnose")
    throw Unfit{command.empty() ? "is no result of servodx" : "is a result of '" + command + "', not of 'diagnose'",
                move_away};
  table.without_schema += schema_notice(file, path).has_value();
  if (file.contains("refused")) return table.refused.push_back(refusal_of(file));
  const Json& results = at(file, "results");
  if (!results.is_array() || results.empty()) throw Unfit{"'results' is no list of results", make_again};
  std::vector<FleetRow> rows;  // of a damaged file none counts
  const std::string page = page_beside(path);
  for (const Json& result : results) rows.push_back(row_of(result, name)), rows.back().page = page;
  table.rows.insert(table.rows.end(), rows.begin(), rows.end());
}

bool is_passed_over(const std::string& name) {
  return name.find(".servodx-tmp") != std::string::npos || name.ends_with(".manifest.json") || name.ends_with(".html");
}

// Names only: 100,000 of them take a few megabytes.
std::vector<std::string> names_in(const std::string& folder) {
  std::error_code failed;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
    if (std::string name = entry->path().filename().string(); !is_passed_over(name)) names.push_back(std::move(name));
  if (failed)
    throw InputError({folder, 0, ""}, "cannot be read as a folder",
                     "name the folder that 'servodx diagnose --list' wrote");
  if (names.empty())
    throw InputError({folder, 0, ""}, "holds no results", "name the folder that 'servodx diagnose --list' wrote");
  std::sort(names.begin(), names.end());
  return names;
}

double order_of(double excess) { return std::isnan(excess) ? HUGE_VAL : excess; }

void sort(FleetTable& table) {
  std::sort(table.rows.begin(), table.rows.end(), [](const FleetRow& a, const FleetRow& b) {
    const auto key = [](const FleetRow& r) { return std::tuple(r.is_healthy(), -order_of(r.excess())); };
    return key(a) != key(b) ? key(a) < key(b) : std::tie(a.log, a.file) < std::tie(b.log, b.file);
  });
  std::sort(table.refused.begin(), table.refused.end(),
            [](const SetAside& a, const SetAside& b) { return a.file < b.file; });
}

void append(std::string& row, double value) {
  row += ',';
  if (std::isfinite(value)) append_number(row, value);
}

void append(std::string& row, std::string_view text) {
  row += ',';
  append_cell(row, text);
}

}  // namespace

FleetTable gather(const std::string& folder, const std::atomic<bool>& stop,
                  const std::function<void(std::size_t done, std::size_t of)>& progress) {
  FleetTable table;
  const std::vector<std::string> names = names_in(folder);
  std::size_t done = 0;
  for (const std::string& name : names) {
    table.interrupted = stop;
    if (table.interrupted) break;
    const std::string path = (fs::path(folder) / name).string();
    std::error_code ignored;
    try {
      if (fs::is_directory(path, ignored)) throw Unfit{"is a folder", "gather it by itself, or move it away"};
      if (!name.ends_with(result_ending)) throw Unfit{"is no JSON", move_away};
      read_into(table, path, name);
    } catch (const Unfit& unfit) {
      table.unread.push_back({name, 0, "", unfit.rule, unfit.mend});
    } catch (const InputError& error) {
      table.unread.push_back({name, error.where.line, error.where.column, error.rule, error.mend});
    }
    if (progress) progress(++done, names.size());
  }
  sort(table);
  return table;
}

std::string csv_of(const FleetTable& table) {
  std::string text =
      "log,verdict,fault,severity,severity_lower,severity_upper,severity_unit,probability,error,threshold\n";
  for (const FleetRow& row : table.rows) {
    append_cell(text, row.log);
    append(text, word_of(row.verdict));
    append(text, row.fault);
    for (const double value : {row.severity, row.severity_lower, row.severity_upper}) append(text, value);
    append(text, row.severity_unit);
    for (const double value : {row.probability, row.error, row.threshold}) append(text, value);
    text += '\n';
  }
  return text;
}

}  // namespace servodx
