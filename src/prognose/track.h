// The fourth check, ours: what the wearing parameters are now. The severities of all progressive faults of the registry
// are fitted together to one log, with the log's own nuisances (null, air, sensor offsets), so that a change is
// credited to the cause that explains it. What a log cannot tell apart stays near its last value with a wide error.
// What wears along with one (corners with a clearance) is fitted beside it: as if they were new, the rest would take it
// up.
//
// Values are those of the row that a fault moves first, in its unit, so that `parameter:1` is row 1 of the table.
// Limits: one log, constant severity within it; errors are of repetition (curvature of the fit, widened where it
// fits worse than on the tuning logs), not of the model's form, which is the same from check to check and
// cancels in a trend. `whole_error` counts no more samples than are independent of one another in the tuned table's
// error model: what a single check may be off by. It is no less than what the bounds of the ranges hold back.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "parameters/table.h"
#include "simulate/scenario.h"

namespace servodx {

// What wears along with a fault (WornAlong), in its unit.
struct TrackedAlong {
  double value = 0, std_error = 0, whole_error = 0;
};

struct TrackedParameter {
  int id = 0;  // row 1..41
  const Fault* fault = nullptr;
  double value = 0, std_error = 0;  // [unit of the row]
  double whole_error = 0;           // [unit of the row] with the model's own, which repeats from check to check
  bool told = false;                // from the tuned value: more than two errors off, and the model's form besides
  double severity = 0;              // [unit of the fault]
  double tuned = 0, failed = 0;     // [unit of the row] where the valve began, and where the fault's `failed` lies
  std::optional<TrackedAlong> along = {};
};

struct Track {
  std::vector<TrackedParameter> parameters;
  ParameterVector healthy;  // the tuned rows with this log's nuisances: what a healthy valve would have done
  double adequacy = 0;      // whitened rms of the worst channel, 1 when as wrong as on the tuning logs
  double null = 0;          // [of rated]
  double null_std_error = 0;
  long simulations = 0, failed = 0;
};

struct TrackOptions {
  double null_limit = 0.05;  // [of rated]
  int threads = 0;
  std::vector<double> last;  // values of the last check, in the order of progressive_faults(): another start
  std::function<void(double part, long simulations)> told = {};  // what is done
  std::function<bool()> stop = {};                               // true: what comes back is of no use
};

// Those of the registry that grow with use, and the row that each moves first.
struct Progressive {
  const Fault* fault;
  int row;  // position in a candidate
};
const std::vector<Progressive>& progressive_faults();

Track track_parameters(const LogData& log, const Table& tuned, const TrackOptions& options);

}  // namespace servodx
