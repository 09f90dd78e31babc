// The oil of a rig file at a temperature, and at a thickness.
#pragma once
#include "model/state.h"
#include "servodx/rig.h"

namespace servodx {

// kelvin: [K]
inline Oil oil_of(const Fluid& fluid, double kelvin) {
  return oil_at(fluid.density, fluid.kinematic_viscosity, kelvin, fluid.kinematic_viscosity_100);
}

// The temperature at which the fluid is so many times as thick as at 40 degC, between -70 and 180 degC. [K]
double kelvin_where(const Fluid& fluid, double viscosity_ratio);

}  // namespace servodx
