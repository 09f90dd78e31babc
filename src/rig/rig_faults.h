// Faults of the virtual rig, by the labels and severity values of the contract. Each is continuous: at `healthy` the
// rig is bit for bit the healthy one. A new fault is a quantity in wear.h and one entry in the list.
#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "rig/wear.h"

namespace servodx::rig {

struct RigFault {
  std::string name;
  std::string unit;  // of the severity value
  std::string description;
  double healthy;                  // severity value that is no fault
  double low, high;                // allowed range
  std::array<double, 3> severity;  // mild, medium, severe
  double Wear::*quantity;
};
const std::vector<RigFault>& rig_faults();

using FaultSet = std::map<std::string, double>;  // label -> severity value

// Throws InputError for an unknown label (with the list of labels) or a value out of range.
Wear wear_of(const FaultSet& faults);

// "clogged_filter=0.5" or "clogged_filter=medium" into the set. Throws InputError.
void add_fault(const std::string& text, FaultSet& faults);

}  // namespace servodx::rig
