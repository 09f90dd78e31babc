// Faults and hidden effects of a foreign rig: names as in the truth files of rigs A and B, sizes, and what each
// changes.
#pragma once
#include <string>
#include <vector>

#include "base/random.h"
#include "condition.h"
#include "design.h"

namespace servodx::foreign {

struct Fault {
  std::string name;
  double mild, medium, severe;  // [unit of the severity]
  void (*apply)(Condition& c, const Design& d, double severity);
};
const std::vector<Fault>& faults();
// The severity in the fault's unit: that of `cylinder_internal_leakage` is stated per rated flow and supply pressure.
// Faults of driver and sensors, outside the table of three severities.
struct Electric {
  std::string name;     // driver_fault or sensor_fault
  std::string channel;  // of a sensor
  double value;         // current over demand, limit over rated, noise over the usual; 0: frozen
  void (*apply)(Condition&);
};
const std::vector<Electric>& electrics();

double severity_value(const Fault& fault, const Design& d, double severity);

struct Effect {
  std::string name;  // of the contract's list
  // Draws the full size, applies `share` of it and returns what it applied, SI.
  double (*apply)(Condition& c, const Design& d, double share, Random& r);
};
const std::vector<Effect>& effects();

// Oil, air and null of one fault-free log. `wide`: any temperature that this rig may see, else that of a workshop.
Condition draw_condition(const Design& d, Random& r, bool wide);

}  // namespace servodx::foreign
