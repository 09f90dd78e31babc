// The front door of what a history holds.
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
  for (const Event& e : history.file().of(valve).events) out.push_back({e.at, name_of(e.kind), e.text});
  return out;
}

void export_history(const History& history, const std::string& path) {
  write_file(path, history_csv(history.file().content()));
}

Imported import_history(const std::string& history, const std::string& csv) {
  const HistoryContent content = read_history_csv(csv);  // refused before a new history is made
  const Restored added = HistoryFile(history, !HistoryFile::there(history)).restore(content);
  return {added.recordings, added.events, added.present};
}

}  // namespace servodx
