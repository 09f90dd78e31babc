// A folder of results, one JSON a log, as rows of a table.
//
// Files are read one at a time; of each only its rows stay. What is no result of `diagnose` is named and left out.
// Pages, manifests and files that are just being written are passed over; folders inside are not entered.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "faults/fault.h"
#include "fleet/fleet_verdict.h"

namespace servodx {

// The least of a fault that a log would have shown.
struct LeastShown {
  const Fault* fault = nullptr;
  double severity = 0;  // [the fault's unit] NaN: it would not have shown the worst of it
};

struct FleetRow {
  std::string file;  // in the folder
  std::string page;  // of the log, in the folder too; empty: none stands there
  std::string log;   // its path as the result says
  FleetVerdict verdict = FleetVerdict::none;
  std::string fault;                                            // label; empty where none is named
  double severity = 0, severity_lower = 0, severity_upper = 0;  // [severity_unit] NaN where none is known; 95 %
  std::string severity_unit;
  double probability = 0;           // of the fault named, else of the verdict; NaN where none is known
  double error = 0, threshold = 0;  // [deviates] NaN where none is known
  std::vector<LeastShown> detectable;

  bool is_healthy() const { return verdict == FleetVerdict::healthy; }
  std::string name() const { return fault.empty() ? word_of(verdict) : fault; }
  double excess() const { return error / threshold; }
};

struct SetAside {
  std::string file;    // in the folder; of a log its path
  long line = 0;       // 0 where none applies
  std::string column;  // empty where none applies
  std::string rule, mend;
  std::string code = {};  // of docs/errors.md; empty where there is none
};

struct FleetTable {
  std::vector<FleetRow> rows;     // worst first: what is not healthy, then by error over threshold, then by path
  std::vector<SetAside> refused;  // logs that the list's run set aside, by path
  std::vector<SetAside> unread;   // files of the folder that are no results, by name
  bool interrupted = false;
  std::size_t without_schema = 0;  // results of earlier versions
};

// Throws InputError where the folder is none or holds nothing of a fleet. `done`: files read so far, of how many.
FleetTable gather(const std::string& folder, const std::atomic<bool>& stop,
                  const std::function<void(std::size_t done, std::size_t of)>& progress = {});

// CSV with a header; severities in the SI unit beside them, worst first.
std::string csv_of(const FleetTable& table);

}  // namespace servodx
