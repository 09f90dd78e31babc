// What a history holds, read back; and a history as CSV, out and in. docs/prognosis.md.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "servodx/maintenance.h"
#include "servodx/trend.h"

namespace servodx {

struct Recorded {
  struct Figure {
    std::string name;
    double value = 0, std_error = 0;  // [unit] corrected
    std::string unit;
    double measured = 0;  // [unit]
  };
  double at = 0;                 // [h] of use
  std::optional<double> cycles;  // of use, where counted
  std::string log, log_sha256, table_sha256;
  double temperature = 0;  // [K]
  std::vector<Figure> figures;
};
struct RecordedEvent {
  double at = 0;  // [h]
  EventKind kind = EventKind::note;
  std::string text;
};
// By hours. Both throw InputError for a valve that the history does not know.
std::vector<Recorded> recordings_of(const History& history, const std::string& valve);
std::vector<RecordedEvent> events_of(const History& history, const std::string& valve);

// What is known of a valve, in short. Throws InputError for one that the history does not know.
struct HeldValve {
  std::string valve, serial;  // serial: empty where none is known
  std::size_t checks = 0;
  double last_at = 0;  // [h] of the last check; 0 without one
  std::vector<RecordedEvent> events;
};
HeldValve held_valve(const History& history, const std::string& valve);

// Names of all figures that it holds, of any valve and of one.
std::vector<std::string> figures_of(const History& history);
std::vector<std::string> figures_of(const History& history, const std::string& valve);
// Throws InputError where no check is called so: mean_error, fidelity, correlation@5Hz, parameter:1 to parameter:41.
void require_check(const std::string& name);

const char* name_of(EventKind kind);  // as a history has it: "filter_changed"
std::string event_names();            // the kinds of events, with commas between
// Throws InputError for hours [h] and a kind that History::add_event() would refuse.
void require_event(double at, const std::string& kind);

// As `servodx history export` writes. Throws InputError where the file cannot be written.
struct Exported {
  std::size_t valves = 0, tables = 0;  // tuned tables that the checks rest on
};
Exported export_history(const History& history, const std::string& path);
struct Imported {
  long checks = 0, events = 0, present = 0;  // added; and rows that were there
};
// What a CSV of an export holds and the history, by its path, does not: all of it or nothing. The history is made where
// it is not there. Throws InputError.
Imported import_history(const std::string& history, const std::string& csv);
// Refuses what import_history() would refuse of either file, and writes nothing.
void rehearse_import(const std::string& history, const std::string& csv);

}  // namespace servodx
