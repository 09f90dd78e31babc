#include "store/history.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <thread>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/reading_limits.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "parameters/table_text.h"
#include "prognose/check.h"
#include "prognose/check_name.h"
#include "prognose/track.h"
#include "servodx/history.h"
#include "servodx/maintenance.h"

namespace servodx {
namespace {

constexpr int application_id = 0x53564458;  // "SVDX": another program's SQLite file is not taken for ours
constexpr int busy_ms = 30000;

// Each brings a file from the version of its place to the next.
constexpr std::array steps = {
    R"(CREATE TABLE valve(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, serial TEXT NOT NULL);
       CREATE TABLE tuned_table(id INTEGER PRIMARY KEY, sha256 TEXT NOT NULL UNIQUE, content TEXT NOT NULL);
       CREATE TABLE recording(id INTEGER PRIMARY KEY, valve INTEGER NOT NULL REFERENCES valve, at REAL NOT NULL,
         cycles REAL, log TEXT NOT NULL, log_sha256 TEXT NOT NULL, tuned_table INTEGER NOT NULL REFERENCES tuned_table,
         temperature REAL NOT NULL, temperature_source TEXT NOT NULL, version TEXT NOT NULL, recorded_at TEXT NOT NULL);
       CREATE TABLE figure(recording INTEGER NOT NULL REFERENCES recording, name TEXT NOT NULL, value REAL,
         std_error REAL, unit TEXT NOT NULL, measured REAL, expected REAL, cause TEXT NOT NULL, PRIMARY KEY(recording, name))
         WITHOUT ROWID;
       CREATE TABLE event(id INTEGER PRIMARY KEY, valve INTEGER NOT NULL REFERENCES valve, at REAL NOT NULL,
         kind TEXT NOT NULL, text TEXT NOT NULL, recorded_at TEXT NOT NULL);)",
    R"(CREATE INDEX recording_of_valve ON recording(valve, at, log_sha256);
       CREATE INDEX event_of_valve ON event(valve, at);)",
};

constexpr std::array<std::pair<EventKind, const char*>, 5> kinds = {{{EventKind::filter_changed, "filter_changed"},
                                                                     {EventKind::valve_swapped, "valve_swapped"},
                                                                     {EventKind::overhauled, "overhauled"},
                                                                     {EventKind::retuned, "retuned"},
                                                                     {EventKind::note, "note"}}};

std::string now() {
  const std::time_t t = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&t, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

// NULL stands for what is not finite.
void bind(SQLite::Statement& s, int at, double value) {
  if (std::isfinite(value))
    s.bind(at, value);
  else
    s.bind(at);
}
double number(const SQLite::Column& c) { return c.isNull() ? std::nan("") : c.getDouble(); }

// The row of a key, made where there is none; `value` stands beside it unless it is empty.
struct Keyed {
  const char *add, *find;
};
constexpr Keyed by_name{
    "INSERT INTO valve(name, serial) VALUES(?, ?) ON CONFLICT(name) DO UPDATE SET serial = "
    "CASE WHEN excluded.serial = '' THEN serial ELSE excluded.serial END",
    "SELECT id FROM valve WHERE name = ?"};
constexpr Keyed by_content{
    "INSERT INTO tuned_table(sha256, content) VALUES(?, ?) ON CONFLICT(sha256) DO UPDATE SET "
    "content = CASE WHEN excluded.content = '' THEN content ELSE excluded.content END",
    "SELECT id FROM tuned_table WHERE sha256 = ?"};
long long id_of(SQLite::Database& db, const Keyed& keyed, const std::string& key, const std::string& value) {
  SQLite::Statement add(db, keyed.add);
  add.bind(1, key);
  add.bind(2, value);
  add.exec();
  SQLite::Statement find(db, keyed.find);
  find.bind(1, key);
  find.executeStep();
  return find.getColumn(0).getInt64();
}

std::optional<long long> find_recording(SQLite::Database& db, long long valve, long long table, const Recording& r) {
  SQLite::Statement find(db,
                         "SELECT id FROM recording WHERE valve = ? AND at = ? AND log_sha256 = ? AND tuned_table = ?");
  find.bind(1, static_cast<std::int64_t>(valve));
  find.bind(2, r.at);
  find.bind(3, r.log_sha256);
  find.bind(4, static_cast<std::int64_t>(table));
  return find.executeStep() ? std::optional(find.getColumn(0).getInt64()) : std::nullopt;
}

void insert(SQLite::Database& db, long long valve, long long table, const Recording& r) {
  SQLite::Statement add(db,
                        "INSERT INTO recording(valve, at, cycles, log, log_sha256, tuned_table, temperature, "
                        "temperature_source, version, recorded_at) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  add.bind(1, static_cast<std::int64_t>(valve));
  add.bind(2, r.at);
  bind(add, 3, r.cycles.value_or(std::nan("")));
  add.bind(4, r.log);
  add.bind(5, r.log_sha256);
  add.bind(6, static_cast<std::int64_t>(table));
  add.bind(7, r.temperature);
  add.bind(8, r.temperature_source);
  add.bind(9, r.version);
  add.bind(10, r.recorded_at.empty() ? now() : r.recorded_at);
  add.exec();
  const long long id = db.getLastInsertRowid();
  SQLite::Statement figure(db,
                           "INSERT INTO figure(recording, name, value, std_error, unit, measured, expected, cause) "
                           "VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
  for (const Check& c : r.checks) {
    figure.bind(1, static_cast<std::int64_t>(id));
    figure.bind(2, c.name.text());
    bind(figure, 3, c.value);
    bind(figure, 4, c.std_error);
    figure.bind(5, c.unit);
    bind(figure, 6, c.measured);
    bind(figure, 7, c.expected);
    figure.bind(8, c.cause);
    figure.exec();
    figure.reset();
  }
}

// The first figure of a check that a stored one holds otherwise or not; empty where it holds all.
std::string unlike(SQLite::Database& db, long long recording, const std::vector<Check>& checks) {
  SQLite::Statement find(db, "SELECT value FROM figure WHERE recording = ? AND name = ?");
  for (const Check& c : checks) {
    find.bind(1, static_cast<std::int64_t>(recording));
    find.bind(2, c.name.text());
    if (!find.executeStep()) return c.name.text();
    const double held = number(find.getColumn(0));
    if (held != c.value && !(std::isnan(held) && std::isnan(c.value))) return c.name.text();
    find.reset();
  }
  return "";
}

bool insert(SQLite::Database& db, long long valve, const Event& e) {
  SQLite::Statement find(db, "SELECT 1 FROM event WHERE valve = ? AND at = ? AND kind = ? AND text = ?");
  SQLite::Statement add(db, "INSERT INTO event(valve, at, kind, text, recorded_at) VALUES(?, ?, ?, ?, ?)");
  for (SQLite::Statement* s : {&find, &add}) {
    s->bind(1, static_cast<std::int64_t>(valve));
    s->bind(2, e.at);
    s->bind(3, name_of(e.kind));
    s->bind(4, e.text);
  }
  if (find.executeStep()) return false;
  add.bind(5, e.recorded_at.empty() ? now() : e.recorded_at);
  add.exec();
  return true;
}

}  // namespace

const char* name_of(EventKind kind) {
  for (const auto& [k, name] : kinds)
    if (k == kind) return name;
  return "note";
}
std::optional<EventKind> find_event(const std::string& name) {
  for (const auto& [kind, known] : kinds)
    if (name == known) return kind;
  return {};
}
std::string event_names() {
  std::string names;
  for (const auto& [kind, name] : kinds) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

// SQLite's errors in the user's words.
template <class F>
auto HistoryFile::guarded(const F& work) const {
  try {
    return work();
  } catch (const SQLite::Exception& e) {
    switch (e.getErrorCode()) {
      case SQLITE_NOTADB:
      case SQLITE_CORRUPT:
        throw InputError({.file = path_}, fmt::format("the file is damaged or no history ({})", e.what()),
                         fmt::format("restore a copy, or salvage it with: sqlite3 '{}' .recover", path_));
      case SQLITE_CANTOPEN:
      case SQLITE_READONLY:
        throw InputError({.file = path_}, fmt::format("cannot be opened for writing ({})", e.what()),
                         "check the folder and its rights");
      case SQLITE_FULL:
        throw std::runtime_error(path_ + ": the disk is full; nothing of this call was stored");
      case SQLITE_BUSY:
        throw std::runtime_error(
            fmt::format("{}: another program held the file for {} s; nothing was stored", path_, busy_ms / 1000));
      default:
        throw std::runtime_error(fmt::format("{}: {}", path_, e.what()));
    }
  }
}

HistoryFile::HistoryFile(const std::string& path, bool create) : path_(path) {
  const char* const mend = "record a check with 'servodx check' first";
  const bool exists = std::filesystem::exists(path);
  if (!create && !exists) throw InputError({.file = path}, "there is no such history", mend);
  if (!create && !there(path)) throw InputError({.file = path}, "is empty, no history", mend);
  if (!exists) make_whole();
  guarded([&] {
    db_ = std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE, busy_ms);
    migrate();
  });
}

bool HistoryFile::there(const std::string& path) {
  std::error_code none;
  return std::filesystem::exists(path, none) &&
         !(std::filesystem::is_regular_file(path, none) && std::filesystem::file_size(path, none) == 0);
}

// SQLite makes an empty file first. Under a name of its own it is nobody's history until it has its tables.
void HistoryFile::make_whole() {
  AtomicFile file(path_);
  guarded([&] {
    db_ = std::make_unique<SQLite::Database>(file.temporary(), SQLite::OPEN_READWRITE, busy_ms);
    migrate();
    db_.reset();  // which takes the files beside it away
  });
  file.commit_new();  // or another first writer's stands there, as good
}
HistoryFile::~HistoryFile() = default;

int HistoryFile::schema_version() { return static_cast<int>(steps.size()); }

void HistoryFile::migrate() {
  int owner = 0, version = 0;
  bool blank = false;
  {
    const SQLite::Transaction at_once(*db_);  // another first writer may be filling it
    blank = db_->execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0;
    owner = db_->execAndGet("PRAGMA application_id").getInt();
    version = db_->execAndGet("PRAGMA user_version").getInt();
  }
  if (owner != application_id && !(blank && owner == 0))
    throw InputError({.file = path_}, "is an SQLite file of another program", "name another file");
  if (version > schema_version())
    throw InputError(
        {.file = path_},
        fmt::format("was written by a newer servodx (schema {}, known up to {})", version, schema_version()),
        "use that version, or export it there as CSV and import it here");
  write_ahead();
  db_->exec("PRAGMA synchronous = FULL");
  db_->exec("PRAGMA foreign_keys = ON");
  if (version == schema_version()) return;
  SQLite::Transaction all(*db_, SQLite::TransactionBehavior::IMMEDIATE);
  version = db_->execAndGet("PRAGMA user_version").getInt();  // another process may have been quicker
  for (; version < schema_version(); ++version) db_->exec(steps[static_cast<std::size_t>(version)]);
  db_->exec(fmt::format("PRAGMA application_id = {}", application_id));
  db_->exec(fmt::format("PRAGMA user_version = {}", version));
  all.commit();
}

// The change of mode asks no busy handler: where two first writers fill an empty file, one is turned away at once.
void HistoryFile::write_ahead() {
  constexpr int pause_ms = 10;
  for (int waited = 0;; waited += pause_ms) try {
      db_->exec("PRAGMA journal_mode = WAL");
      return;
    } catch (const SQLite::Exception& e) {
      if (e.getErrorCode() != SQLITE_BUSY || waited >= busy_ms) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
    }
}

void HistoryFile::record(const std::string& valve, const std::string& serial, const Recording& recording,
                         const std::string& table_text) {
  for (const auto& [what, name] : {std::pair("valve", &valve), std::pair("serial number", &serial)})
    if (name->size() > longest_name)
      throw InputError({.file = path_}, fmt::format("the name of the {} has more than {} bytes", what, longest_name),
                       "shorten it");
  const bool added = guarded([&] {
    SQLite::Transaction all(*db_, SQLite::TransactionBehavior::IMMEDIATE);
    const long long id = id_of(*db_, by_name, valve, serial);
    const long long table = id_of(*db_, by_content, recording.table_sha256, table_text);
    const bool fresh = !find_recording(*db_, id, table, recording);
    if (fresh) insert(*db_, id, table, recording);
    if (fresh) all.commit();
    return fresh;
  });
  if (!added)
    throw InputError({.file = recording.log},
                     fmt::format("is in the history of '{}' at {} h already", valve, recording.at),
                     "name the hours of this check with --at");
}

bool HistoryFile::holds(const std::string& valve, const Recording& recording) const {
  return guarded([&] {
    SQLite::Statement held(*db_,
                           "SELECT 1 FROM recording r JOIN valve v ON v.id = r.valve JOIN tuned_table t ON t.id = "
                           "r.tuned_table WHERE v.name = ? AND r.at = ? AND r.log_sha256 = ? AND t.sha256 = ?");
    held.bind(1, valve);
    held.bind(2, recording.at);
    held.bind(3, recording.log_sha256);
    held.bind(4, recording.table_sha256);
    return held.executeStep();
  });
}

void HistoryFile::add_event(const std::string& valve, const Event& event) {
  const bool added = guarded([&] {
    SQLite::Transaction all(*db_, SQLite::TransactionBehavior::IMMEDIATE);
    const bool fresh = insert(*db_, id_of(*db_, by_name, valve, ""), event);
    if (fresh) all.commit();
    return fresh;
  });
  if (!added)
    throw InputError(
        {.file = path_},
        fmt::format("'{}' at {} h is in the history of '{}' already", name_of(event.kind), event.at, valve),
        "nothing is left to do");
}

std::vector<double> tuned_rows(const std::string& table_text) {
  std::vector<double> rows;
  if (table_text.empty()) return rows;
  try {
    const Table table = parse_table(table_text, "the history's tuned table");
    for (int i = 0; i < n_parameters; ++i) rows.push_back(table[i].nominal);
  } catch (const InputError&) {  // another program's notes: the checks stand without it
  }
  return rows;
}

std::vector<std::string> HistoryFile::valves() const { return names("SELECT name FROM valve ORDER BY name"); }

std::vector<std::string> HistoryFile::figures() const {
  return names("SELECT DISTINCT name FROM figure ORDER BY name");
}

std::vector<std::string> HistoryFile::names(const char* query) const {
  return guarded([&] {
    std::vector<std::string> out;
    SQLite::Statement all(*db_, query);
    while (all.executeStep()) out.push_back(all.getColumn(0).getString());
    return out;
  });
}

std::string HistoryFile::serial(const std::string& valve) const {
  return guarded([&] {
    SQLite::Statement find(*db_, "SELECT serial FROM valve WHERE name = ?");
    find.bind(1, valve);
    return find.executeStep() ? find.getColumn(0).getString() : std::string();
  });
}

ValveHistory HistoryFile::of(const std::string& valve) const {
  ValveHistory out;
  out.valve = valve;
  const bool known = guarded([&] {
    SQLite::Statement find(*db_, "SELECT id, serial FROM valve WHERE name = ?");
    find.bind(1, valve);
    if (!find.executeStep()) return false;
    const std::int64_t id = find.getColumn(0).getInt64();
    out.serial = find.getColumn(1).getString();
    SQLite::Statement rows(
        *db_,
        "SELECT r.id, at, cycles, log, log_sha256, sha256, temperature, temperature_source, version, recorded_at, "
        "name, "
        "value, std_error, unit, measured, expected, cause FROM recording r JOIN tuned_table t ON t.id = r.tuned_table "
        "LEFT JOIN figure f ON f.recording = r.id WHERE valve = ? ORDER BY at, r.id, name");
    rows.bind(1, id);
    std::int64_t current = -1;
    while (rows.executeStep()) {
      if (rows.getColumn(0).getInt64() != current) {
        current = rows.getColumn(0).getInt64();
        Recording r;
        r.at = rows.getColumn(1).getDouble();
        if (!rows.getColumn(2).isNull()) r.cycles = rows.getColumn(2).getDouble();
        r.log = rows.getColumn(3).getString();
        r.log_sha256 = rows.getColumn(4).getString();
        r.table_sha256 = rows.getColumn(5).getString();
        r.temperature = rows.getColumn(6).getDouble();
        r.temperature_source = rows.getColumn(7).getString();
        r.version = rows.getColumn(8).getString();
        r.recorded_at = rows.getColumn(9).getString();
        out.recordings.push_back(std::move(r));
      }
      if (rows.getColumn(10).isNull()) continue;
      out.recordings.back().checks.push_back({rows.getColumn(10).getString(), number(rows.getColumn(11)),
                                              number(rows.getColumn(12)), rows.getColumn(13).getString(),
                                              number(rows.getColumn(14)), number(rows.getColumn(15)),
                                              rows.getColumn(16).getString()});
    }
    SQLite::Statement events(*db_, "SELECT at, kind, text, recorded_at FROM event WHERE valve = ? ORDER BY at, id");
    events.bind(1, id);
    while (events.executeStep())
      out.events.push_back({events.getColumn(0).getDouble(),
                            find_event(events.getColumn(1).getString()).value_or(EventKind::note),
                            events.getColumn(2).getString(), events.getColumn(3).getString()});
    if (!out.recordings.empty()) {
      SQLite::Statement table(*db_, "SELECT content FROM tuned_table WHERE sha256 = ?");
      table.bind(1, out.recordings.back().table_sha256);
      if (table.executeStep()) out.tuned = tuned_rows(table.getColumn(0).getString());
    }
    return true;
  });
  if (known) return out;
  std::string names;
  for (const std::string& name : valves()) names += (names.empty() ? "" : ", ") + name;
  throw InputError({.file = path_}, fmt::format("holds no valve '{}'", valve),
                   names.empty() ? "it holds none yet" : "it holds " + names);
}

std::optional<Recording> HistoryFile::last(const std::string& valve) const {
  const std::vector<std::string> known = valves();
  if (std::find(known.begin(), known.end(), valve) == known.end()) return {};
  ValveHistory all = of(valve);
  if (all.recordings.empty()) return {};
  return std::move(all.recordings.back());
}

HistoryContent HistoryFile::content() const {
  HistoryContent all;
  for (const std::string& name : valves()) all.valves.push_back(of(name));
  guarded([&] {
    SQLite::Statement tables(*db_, "SELECT sha256, content FROM tuned_table ORDER BY id");
    while (tables.executeStep())
      all.tables.emplace_back(tables.getColumn(0).getString(), tables.getColumn(1).getString());
  });
  return all;
}

Restored HistoryFile::restore(const HistoryContent& content) {
  return guarded([&] {
    Restored count;
    SQLite::Transaction all(*db_, SQLite::TransactionBehavior::IMMEDIATE);
    for (const auto& [sha256, text] : content.tables) id_of(*db_, by_content, sha256, text);
    for (const ValveHistory& valve : content.valves) {
      const long long id = id_of(*db_, by_name, valve.valve, valve.serial);
      for (const Recording& r : valve.recordings) {
        const long long table = id_of(*db_, by_content, r.table_sha256, "");
        const auto held = find_recording(*db_, id, table, r);
        if (!held) {
          insert(*db_, id, table, r);
          ++count.recordings;
          continue;
        }
        if (const std::string other = unlike(*db_, *held, r.checks); !other.empty())
          throw InputError(
              {.file = path_},
              fmt::format("holds a check of '{}' at {} h with another '{}', or without it", valve.valve, r.at, other),
              "give the row other hours, or the log_sha256 of its own log; nothing was added");
        ++count.present;
      }
      for (const Event& e : valve.events) ++(insert(*db_, id, e) ? count.events : count.present);
    }
    all.commit();
    return count;
  });
}

std::string HistoryFile::verify() const {
  return guarded([&] { return db_->execAndGet("PRAGMA quick_check(1)").getString(); });
}

}  // namespace servodx
