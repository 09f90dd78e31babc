#include "rig/rig_faults.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"

namespace servodx::rig {
namespace {

const RigFault& find(const std::string& name) {
  std::string names;
  for (const auto& fault : rig_faults()) {
    if (fault.name == name) return fault;
    names += (names.empty() ? "" : ", ") + fault.name;
  }
  throw InputError({"", 0, "--fault"}, fmt::format("unknown fault '{}'", name), "known are " + names);
}

void check(const RigFault& fault, double value) {
  if (!(value >= fault.low && value <= fault.high)) {
    throw InputError(
        {"", 0, "--fault"},
        fmt::format("{} = {} is outside {} to {} {}", fault.name, value, fault.low, fault.high, fault.unit),
        fmt::format("{} is healthy; mild, medium and severe are {}, {} and {}", fault.healthy, fault.severity[0],
                    fault.severity[1], fault.severity[2]));
  }
}

}  // namespace

const std::vector<RigFault>& rig_faults() {
  static const std::vector<RigFault> list{
      {"clogged_filter",
       "1",
       "blocked fraction of the pilot screen",
       0.0,
       0.0,
       0.999,
       {0.25, 0.50, 0.75},
       &Wear::filter_blocked},
      {"torque_motor_loss",
       "1",
       "ampere turns left of the torque motor",
       1.0,
       0.0,
       1.0,
       {0.8, 0.5, 0.2},
       &Wear::torque_gain},
      {"feedback_wire_backlash",
       "m",
       "clearance of the feedback ball in the spool",
       0.0,
       0.0,
       2e-4,
       {5e-6, 10e-6, 20e-6},
       &Wear::wire_clearance},
      {"feedback_wire_lost",
       "1",
       "stiffness left of the feedback wire",
       1.0,
       0.0,
       1.0,
       {0.5, 0.2, 0.0},
       &Wear::wire_stiffness},
      {"sticky_spool",
       "1",
       "multiplier of the spool friction",
       1.0,
       1.0,
       100.0,
       {4.0, 10.0, 20.0},
       &Wear::spool_friction},
      {"radial_clearance_wear",
       "1",
       "multiplier of the radial clearance at the metering edges",
       1.0,
       1.0,
       20.0,
       {3.0, 6.0, 10.0},
       &Wear::edge_clearance},
      {"null_shift",
       "1",
       "shift of the null, fraction of rated current",
       0.0,
       -0.5,
       0.5,
       {0.06, 0.12, 0.20},
       &Wear::null},
  };
  return list;
}

Wear wear_of(const FaultSet& faults) {
  Wear wear;
  for (const auto& [name, value] : faults) {
    const RigFault& fault = find(name);
    check(fault, value);
    wear.*fault.quantity = value;
  }
  return wear;
}

void add_fault(const std::string& text, FaultSet& faults) {
  const auto equals = text.find('=');
  const RigFault& fault = find(text.substr(0, equals));
  const std::string size = equals == std::string::npos ? "" : text.substr(equals + 1);
  static const std::array<std::string, 3> words{"mild", "medium", "severe"};
  double value = 0.0;
  bool known = false;
  for (int i = 0; i < 3; ++i) {
    if (size == words[i]) value = fault.severity[i], known = true;
  }
  if (!known) {
    const auto number = parse_number(size);
    if (!number) {
      throw InputError(
          {"", 0, "--fault"}, fmt::format("'{}' has no severity", text),
          fmt::format("write {}={} or {}=mild, medium or severe", fault.name, fault.severity[1], fault.name));
    }
    value = *number;
  }
  check(fault, value);
  if (!faults.emplace(fault.name, value).second) {
    throw InputError({"", 0, "--fault"}, fmt::format("{} is given twice", fault.name), "give it once");
  }
}

}  // namespace servodx::rig
