// What is known of the valves over their lives: one SQLite file (through SQLiteCpp) with valves, checks, the tuned
// tables they rest on, and maintenance events.
//
// A row is acknowledged when record() returns: written ahead (WAL) and synced, so a crash or a kill after that loses
// nothing and one before it leaves nothing half. Writers of several processes queue for up to 30 s. A full disk
// rolls the whole check back and throws. A file is made whole or not at all, by any number of first writers at once. A
// damaged or foreign file is refused, never overwritten. Steps to newer schemas run when a file is opened, each in one
// transaction; a file of a newer program is refused. Limits: the file must lie on a local disk (SQLite's locks do not
// hold on most network mounts).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "prognose/valve_history.h"
#include "servodx/maintenance.h"

namespace SQLite {
class Database;
}

namespace servodx {

std::optional<EventKind> find_event(const std::string& name);

// The rows of a stored table's text.
std::vector<double> tuned_rows(const std::string& table_text);

// Everything a history holds, to write it as CSV and read it back (history_csv.h).
struct HistoryContent {
  std::vector<ValveHistory> valves;
  std::vector<std::pair<std::string, std::string>> tables;  // SHA-256, text
};

struct Restored {
  long recordings = 0, events = 0, present = 0;  // present: were there already, left alone
};

class HistoryFile {
 public:
  // `create`: a file that is not there() is made, otherwise refused.
  HistoryFile(const std::string& path, bool create);
  // False also of an empty file: what is left where the first writer had no room, or was killed.
  static bool there(const std::string& path);
  ~HistoryFile();

  // All of it or nothing. Refuses a log that this valve's history holds already, unless at other hours or by another
  // table.
  void record(const std::string& valve, const std::string& serial, const Recording& recording,
              const std::string& table_text);
  // Whether record() would refuse it: by valve, hours, hash of the log and hash of the table.
  bool holds(const std::string& valve, const Recording& recording) const;
  void add_event(const std::string& valve, const Event& event);
  std::vector<std::string> valves() const;
  std::vector<std::string> figures() const;                       // names of all checks, of any valve
  ValveHistory of(const std::string& valve) const;                // throws InputError for an unknown valve
  std::string serial(const std::string& valve) const;             // empty where none is known
  std::optional<Recording> last(const std::string& valve) const;  // none where the valve is new

  HistoryContent content() const;
  Restored restore(const HistoryContent& content);  // adds what is not there; all of it or nothing
  std::string verify() const;                       // "ok", or what SQLite finds

  static int schema_version();

 private:
  void make_whole();
  void migrate();
  void write_ahead();
  std::vector<std::string> names(const char* query) const;
  template <class F>
  auto guarded(const F& work) const;
  std::string path_;
  std::unique_ptr<SQLite::Database> db_;
};

}  // namespace servodx
