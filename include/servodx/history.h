// What a history holds, read back; and a history as CSV, out and in. docs/prognosis.md.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

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
  double at = 0;           // [h]
  std::string kind, text;  // filter_changed, valve_swapped, overhauled, retuned or note
};
// By hours. Both throw InputError for a valve that the history does not know.
std::vector<Recorded> recordings_of(const History& history, const std::string& valve);
std::vector<RecordedEvent> events_of(const History& history, const std::string& valve);

// As `servodx history export` writes. Throws InputError where the file cannot be written.
void export_history(const History& history, const std::string& path);
struct Imported {
  long checks = 0, events = 0, present = 0;  // added; and rows that were there
};
// What a CSV of an export holds and the history, by its path, does not: all of it or nothing. The history is made where
// it is not there. Throws InputError.
Imported import_history(const std::string& history, const std::string& csv);

}  // namespace servodx
