// What one run over the logs of a fleet did.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "fleet/fleet_verdict.h"
#include "fleet/gather.h"
#include "fleet/result_file.h"

namespace servodx {

struct FleetRun {
  std::string out;                    // folder of the results
  std::size_t logs = 0;               // of the list's chunk
  std::size_t judged = 0, stood = 0;  // results made; results that were there
  long healthy = 0, fault = 0, unknown = 0;
  std::vector<SetAside> set_aside;  // logs without a result, `file` is the log's path
  bool interrupted = false;

  std::size_t done() const { return judged + stood + set_aside.size(); }
  void count(FleetVerdict verdict) {
    healthy += verdict == FleetVerdict::healthy;
    fault += verdict == FleetVerdict::fault;
    unknown += verdict == FleetVerdict::unknown;
  }
};

}  // namespace servodx
