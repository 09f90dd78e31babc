// What is known of a valve over its life: its checks by hours of use, and what maintenance did to it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "prognose/check.h"
#include "servodx/maintenance.h"

namespace servodx {

struct Recording {
  double at = 0;                 // [h] of use
  std::optional<double> cycles;  // of use, where counted
  std::string log, log_sha256, table_sha256, version, recorded_at;
  double temperature = 0;  // [K]
  std::string temperature_source;
  std::vector<Check> checks;
};

// Values of the tracked parameters, in the order of progressive_faults(); NaN where missing.
std::vector<double> tracked_in(const Recording& recording);

// What a maintenance event resets: the trends of checks that it renews start again from it.
bool resets(EventKind kind, const Check& check);

struct Event {
  double at = 0;  // [h]
  EventKind kind = EventKind::note;
  std::string text, recorded_at;
};

struct ValveHistory {
  std::string valve, serial;
  std::vector<Recording> recordings;  // by hours
  std::vector<Event> events;
  std::vector<double> tuned;  // the 41 rows of the last check's table; empty where the history does not hold it
};

}  // namespace servodx
