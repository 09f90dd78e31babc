// Faults of the virtual rig, by the labels and severity values of the contract, and further degradations and sudden
// failures. Each is continuous: at `healthy` the rig is bit for bit the healthy one. Each may be there from the start,
// step in at a time, or grow from one time to another, in proportion to its severity value. A new fault is a quantity
// in wear.h and one entry in the list; one that moves two of them is one entry with a law.
#pragma once
#include <array>
#include <limits>
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
  // What wears along with it, and where that stands at a severity; null: nothing does.
  double Wear::*beside = nullptr;
  double (*beside_at)(double severity) = nullptr;
};
const std::vector<RigFault>& rig_faults();
// The contract's label of a fault that the rig calls by what it does ("driver_fault" of "open_coil"); else its name.
std::string label_of(const std::string& name);
// By which a user sets it: the contract's label, unless another fault has that for its name.
std::string word_of(const RigFault& fault);

struct FaultCourse {
  double severity = 0.0;  // at its end
  double start = -1.0;    // [s] negative: there from the start of the log
  double end = -1.0;      // [s] beyond `start`: grows linearly between the two; else it steps in

  FaultCourse() = default;
  FaultCourse(double value, double from = -1.0, double until = -1.0) : severity(value), start(from), end(until) {}
  bool changes() const { return start >= 0.0; }
  double at(double time, double healthy) const;
};
using FaultSet = std::map<std::string, FaultCourse>;  // by label

inline constexpr double fully_grown = std::numeric_limits<double>::infinity();
// Throws InputError for an unknown label (with the list of labels) or a value out of range.
Wear wear_of(const FaultSet& faults, double time = fully_grown);

// Into the set, by name or label: "clogged_filter=0.5" or "clogged_filter=medium" from the start, "...=0.5@2" stepping
// in at 2 s, "...=0.5@2..10" growing from 2 to 10 s. Throws InputError, also where another of the set moves the same.
void add_fault(const std::string& text, FaultSet& faults);

}  // namespace servodx::rig
