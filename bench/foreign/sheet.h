// What the user of a foreign rig knows of it: the design's numbers with a data sheet's tolerance, and the figures that
// a maker measures: leakages and the frequency of 90 degrees lag, taken from the machine itself.
#pragma once
#include "design.h"

namespace servodx::foreign {

struct Sheet {
  double rated_flow, stroke, stop, spool_diameter, clearance, nozzle, orifice, gap, lag_frequency, null_leakage,
      pilot_leakage, motor_frequency, area_a, area_b, actuator_stroke, mass, mount, line_length, line_bore, pressure,
      return_pressure, density, viscosity;  // SI
};

Sheet draw_sheet(const Design& design);

}  // namespace servodx::foreign
