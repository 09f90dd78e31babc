// Where a log was recorded: supply, return, oil, load and drive, beside the data sheet and the fault-free logs.
//
// Read from the samples before any fit. A supply at two thirds of its pressure or oil from the cold store explains more
// of a log than any fault does, and no threshold was made for it.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {

enum class Condition { supply, return_pressure, oil, load, drive };
inline constexpr int n_conditions = 5;

// Pressures [Pa] and oil [K]: the median of the record. Load [N] and drive [A]: the largest size. None: not recorded.
using OperatingPoint = std::array<std::optional<double>, n_conditions>;

OperatingPoint operating_point_of(const Log& log);
// What the rig file says of it; it says nothing of the load.
OperatingPoint sheet_point(const Rig& rig);

struct ConditionRow {
  Condition of = Condition::supply;
  std::optional<double> value, sheet;     // of this log; of the data sheet
  std::optional<double> lowest, highest;  // of the fault-free logs
  bool beyond = false;                    // what those show; without them the tuning logs, or what the sheet says
  std::optional<double> tuned_lowest = {}, tuned_highest = {};  // of the logs that tuned the table
};

// The conditions that a log or the sheet knows, in the order of `Condition`. Of several logs of one state the first,
// but where another is beyond what the fault-free logs show.
std::vector<ConditionRow> conditions_beside(const std::vector<OperatingPoint>& logs, const OperatingPoint& sheet,
                                            const std::vector<OperatingPoint>& healthy);
// Adds what the logs that tuned the table show, where they are known.
void set_beside_tuning(std::vector<ConditionRow>& rows, const std::vector<OperatingPoint>& tuning);

}  // namespace servodx
