// The front door of what a history holds.
#include <set>
#include <utility>

#include "base/atomic_file.h"
#include "prognose/check.h"
#include "prognose/check_name.h"
#include "prognose/valve_history.h"
#include "servodx/history.h"
#include "servodx/trend.h"
#include "store/history.h"
#include "store/history_csv.h"

namespace servodx {

std::vector<Recorded> recordings_of(const History& history, const std::string& valve) {
  std::vector<Recorded> out;
  for (const Recording& r : history.file().of(valve).recordings) {
    Recorded& to = out.emplace_back();
    to.at = r.at, to.cycles = r.cycles, to.temperature = r.temperature;
    to.log = r.log, to.log_sha256 = r.log_sha256, to.table_sha256 = r.table_sha256;
    for (const Check& c : r.checks) to.figures.push_back({c.name.text(), c.value, c.std_error, c.unit, c.measured});
  }
  return out;
}

std::vector<RecordedEvent> events_of(const History& history, const std::string& valve) {
  std::vector<RecordedEvent> out;
  for (const Event& e : history.file().of(valve).events) out.push_back({e.at, e.kind, e.text});
  return out;
}

HeldValve held_valve(const History& history, const std::string& valve) {
  const ValveHistory v = history.file().of(valve);
  HeldValve out{v.valve, v.serial, v.recordings.size(), v.recordings.empty() ? 0.0 : v.recordings.back().at, {}};
  for (const Event& e : v.events) out.events.push_back({e.at, e.kind, e.text});
  return out;
}

std::vector<std::string> figures_of(const History& history) { return history.file().figures(); }

std::vector<std::string> figures_of(const History& history, const std::string& valve) {
  std::set<std::string> names;
  for (const Recording& r : history.file().of(valve).recordings)
    for (const Check& c : r.checks) names.insert(c.name.text());
  return {names.begin(), names.end()};
}

Exported export_history(const History& history, const std::string& path) {
  const HistoryContent content = history.file().content();
  write_file(path, history_csv(content));
  return {content.valves.size(), content.tables.size()};
}

Imported import_history(const std::string& history, const std::string& csv) {
  const HistoryContent content = read_history_csv(csv);  // refused before a new history is made
  const Restored added = HistoryFile(history, !HistoryFile::there(history)).restore(content);
  return {added.recordings, added.events, added.present};
}

void rehearse_import(const std::string& history, const std::string& csv) {
  read_history_csv(csv);
  if (HistoryFile::there(history)) HistoryFile(history, false);
}

}  // namespace servodx
