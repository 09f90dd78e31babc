#include "fleet/confusion.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "base/csv.h"
#include "base/error.h"
#include "base/sha256.h"
#include "fleet/fleet_verdict.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;

bool is_healthy(const std::string& label) { return verdict_named(label) == FleetVerdict::healthy; }

struct Columns {
  std::size_t log, label;
  std::optional<std::size_t> severity;
};

Columns columns_of(const CsvCursor& cursor, const std::string& path) {
  const auto& header = cursor.header();
  const auto find = [&](const char* name) -> std::optional<std::size_t> {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) return {};
    return static_cast<std::size_t>(found - header.begin());
  };
  for (const char* name : {"log", "class"})
    if (!find(name))
      throw InputError({path, cursor.header_line(), name}, "the column is missing",
                       "write the header log,class or log,class,severity");
  return {*find("log"), *find("class"), find("severity")};
}

std::string normal(const std::string& path) { return fs::path(path).lexically_normal().generic_string(); }

FleetTruth::Row read_row(CsvCursor& cursor, const Columns& columns, const std::string& path) {
  FleetTruth::Row row;
  row.line = cursor.line();
  const auto refuse = [&](const char* column, const std::string& rule, const char* mend) {
    throw InputError({path, row.line, column}, rule, mend);
  };
  std::string cell;
  for (std::size_t c = 0; c < cursor.header().size(); ++c) {
    if (c == columns.severity) {
      double value = 0;
      const Cell kind = cursor.next_number(value);
      if (kind == Cell::text) refuse("severity", "'" + cursor.last_text() + "' is not a number", "leave it empty");
      if (kind == Cell::number) row.severity = value;
      continue;
    }
    if (!cursor.next_cell(cell)) break;
    if (c == columns.log && !cell.empty()) row.log = normal(cell);
    if (c == columns.label) row.label = cell;
  }
  if (row.log.empty()) refuse("log", "the cell is empty", "write the path of the log");
  if (row.label.empty()) refuse("class", "the cell is empty", "write healthy or the name of the fault");
  return row;
}

// The truth of the longest end of the log's path that the file holds.
const FleetTruth::Row* truth_of(const std::string& log, const std::map<std::string, const FleetTruth::Row*>& by_path) {
  std::string end = normal(log);
  while (true) {
    if (const auto found = by_path.find(end); found != by_path.end()) return found->second;
    const auto slash = end.find('/');
    if (slash == std::string::npos) return nullptr;
    end.erase(0, slash + 1);
  }
}

// What is counted once all rows are there.
struct Cases {
  std::vector<Statement> statements;
  std::vector<BoundCase> sized;
};

void collect(Cases& cases, const FleetRow& row, const FleetTruth::Row& truth) {
  if (!row.fault.empty()) cases.statements.push_back({row.probability, row.fault == truth.label});
  if (!truth.severity) return;
  if (const auto sized = bound_case_of(row, truth.label, *truth.severity)) cases.sized.push_back(*sized);
}

void count(Confusion& all, const FleetRow& row, const FleetTruth::Row& truth) {
  ++all.counts[truth.label][row.name()];
  Confusion::OfClass& rates = all.rates[truth.label];
  const bool is_named = row.name() == truth.label;
  ++rates.detected.of, ++rates.named.of;
  rates.detected.counted += !row.is_healthy();
  rates.named.counted += is_named;
  if (!is_named || row.fault.empty() || !truth.severity) return;
  ++rates.sized.of;
  rates.sized.counted += row.severity_lower <= *truth.severity && *truth.severity <= row.severity_upper;
}

// Rows and columns in one order, so that what is right lies on the diagonal.
void order(Confusion& all) {
  std::set<std::string> others;
  for (const auto& [label, names] : all.counts) {
    all.classes.insert(is_healthy(label) ? all.classes.begin() : all.classes.end(), label);
    for (const auto& [name, n] : names) others.insert(name);
  }
  all.names = all.classes;
  for (const std::string& label : all.classes) others.erase(label);
  const std::string unknown = word_of(FleetVerdict::unknown);
  const bool has_unknown = others.erase(unknown) > 0;
  all.names.insert(all.names.end(), others.begin(), others.end());
  if (has_unknown) all.names.push_back(unknown);
}

}  // namespace

FleetTruth read_truth(const std::string& path) {
  const std::string text = read_file(path);
  FleetTruth truth;
  truth.path = path;
  truth.sha256 = sha256(text);
  CsvCursor cursor(text, path);
  const Columns columns = columns_of(cursor, path);
  std::set<std::string> seen;
  while (cursor.next_row()) {
    truth.rows.push_back(read_row(cursor, columns, path));
    if (!seen.insert(truth.rows.back().log).second)
      throw InputError({path, truth.rows.back().line, "log"}, "'" + truth.rows.back().log + "' is named twice",
                       "keep one of the rows");
  }
  return truth;
}

Confusion confusion_of(const FleetTable& table, const FleetTruth& truth, std::uint64_t seed) {
  std::map<std::string, const FleetTruth::Row*> by_path;
  for (const FleetTruth::Row& row : truth.rows) by_path[row.log] = &row;
  std::map<const FleetTruth::Row*, std::string> used;
  Confusion all;
  Cases cases;
  for (const FleetRow& row : table.rows) {
    const FleetTruth::Row* of = truth_of(row.log, by_path);
    if (!of) {
      ++all.without_truth;
      continue;
    }
    const auto [before, is_first] = used.try_emplace(of, row.log);
    if (!is_first)
      throw InputError({truth.path, of->line, "log"},
                       "'" + of->log + "' is " + before->second + " as well as " + row.log,
                       "write more of the path, or gather each log once");
    count(all, row, *of);
    collect(cases, row, *of);
  }
  all.without_result = static_cast<long>(truth.rows.size() - used.size());
  all.calibration = calibration_of(std::move(cases.statements), seed);
  all.detectable = detectable_found_of(cases.sized);
  order(all);
  return all;
}

}  // namespace servodx
