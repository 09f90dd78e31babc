// What a watched log gave, as a line of text and as JSON.
#pragma once
#include <string>

#include "diagnose/judge.h"
#include "online/alarm_limits.h"
#include "online/arrivals.h"
#include "online/watcher.h"
#include "report/shared/json.h"

namespace servodx::report {

std::string text_of(const WatchEvent& event);  // one line; "" of a window, whose diagnosis is told instead
Json to_json(const WatchEvent& event);
Json to_json(const WatchLimits& limits);

// What a window came to that was due for a diagnosis.
struct WindowDiagnosis {
  long number = 0;                     // of its event
  const Diagnosis* verdict = nullptr;  // null: refused
  std::string refused = {};
};
std::string text_of(const WindowDiagnosis& diagnosis);  // the verdict's first line
Json to_json(const WindowDiagnosis& diagnosis);

struct WatchSummary {
  std::string source;
  double seconds = 0;  // of the log
  long alarms = 0;
  ArrivalCounts samples;
  long bad_lines = 0;  // that are no sample
};
std::string text_of(const WatchSummary& summary);
Json to_json(const WatchSummary& summary);

}  // namespace servodx::report
