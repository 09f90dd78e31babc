// What is simulated of each test: the tuned valve, the same moved by each of its tolerances, and with each fault at
// some severities.
//
// A tolerance or nuisance moves by one standard deviation of its prior and is taken as linear between; a fault is not:
// it stands at severities along its range, as a filter that is half blocked does nothing like five times a tenth.
#pragma once
#include <string>
#include <vector>

#include "faults/fault.h"
#include "fit/log_data.h"
#include "parameters/table.h"
#include "simulate/scenario.h"

namespace servodx {

struct Lane {
  ParameterVector candidate;
  double scale = 1;  // its effect times this is that of one standard deviation; 1 of a fault
};

struct SeverityLanes {
  std::vector<double> severity;  // [the fault's unit] from the mildest on
  std::vector<int> lanes;
};
struct RivalLanes {
  const Fault* fault = nullptr;
  std::vector<SeverityLanes> sides;  // one, or two
  std::vector<int> beside;           // lanes of what its hypothesis leaves free beside its severity
};
struct TargetLane {
  const Fault* fault = nullptr;
  double severity = 0;  // [the fault's unit]
  int lane = 0;
};
struct RowLane {
  std::string name, unit;
  double before = 0;  // [unit] standard deviation without a test
  int lane = 0;
};

struct LaneSet {
  ParameterVector base;
  std::vector<Lane> lanes;
  std::vector<int> health;         // lanes of what health leaves free
  std::vector<int> of_log;         // of these what is the log's own, no tolerance
  std::vector<RivalLanes> rivals;  // every fault that a fit of such a log can show
  std::vector<TargetLane> targets;
  std::vector<RowLane> rows;     // that are wanted
  std::vector<int> beside_rows;  // lanes of all rows that a fit would free, and the log's own
};

struct LaneWishes {
  std::vector<TargetLane> targets = {};  // fault and severity
  std::vector<std::string> rows = {};
  int grid = 4;  // severities of a rival on either side
};

// `like`: a log as the test's will be. Throws InputError for a row that no fit may free.
LaneSet lanes_of(const LogData& like, const Table& tuned, double null_limit, const LaneWishes& wishes);

}  // namespace servodx
