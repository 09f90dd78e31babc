// What one run over a list did.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "fleet/fleet_verdict.h"
#include "fleet/gather.h"
#include "fleet/result_file.h"

namespace servodx {

// How the run over one log of a list ended. stood: what it would make was there.
enum class RowEnd { made, stood, set_aside, interrupted };

struct ListRun {
  std::string out;                  // folder of the results; empty: none
  std::size_t logs = 0;             // that the run goes over
  std::size_t made = 0, stood = 0;  // results made; results that were there
  std::vector<SetAside> set_aside;  // logs without a result, `file` is the log's path
  bool interrupted = false;

  std::size_t done() const { return made + stood + set_aside.size(); }
};

// Of `check --list`.
struct CheckRun : ListRun {
  std::string history;  // its file
};

// Of `diagnose --list` and `watch`.
struct FleetRun : ListRun {
  long healthy = 0, fault = 0, unknown = 0;

  void count(FleetVerdict verdict) {
    healthy += verdict == FleetVerdict::healthy;
    fault += verdict == FleetVerdict::fault;
    unknown += verdict == FleetVerdict::unknown;
  }
};

}  // namespace servodx
