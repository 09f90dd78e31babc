// States of the identification model and what drives it; the stages fill them in this order.
#pragma once
#include "model/asperities.h"

namespace servodx {

// Base states. Effects add theirs behind.
enum State : int {
  s_current,    // [A] coil current
  s_x_flapper,  // [m] flapper at the nozzles if nothing stopped it; positive closes nozzle 1
  s_v_flapper,  // [m/s]
  s_p_filter,   // [Pa] between filter and fixed orifices
  s_p_pilot_1,  // [Pa] spool end 1; drives the spool positive
  s_p_pilot_2,  // [Pa] spool end 2
  s_x_spool,    // [m] positive opens P to A and B to T
  s_v_spool,    // [m/s]
  s_p_a,        // [Pa] chamber A
  s_p_b,        // [Pa] chamber B
  s_x_piston,   // [m] rod relative to body, from mid-stroke
  s_v_piston,   // [m/s] rod, absolute
};
inline constexpr int n_base_states = 12;

// What drives the model at an instant, from the log or the table, and what it remembers of the past.
template <class X, class T = X>
struct Inputs {
  X current;                     // [A] demand at the amplifier, null, hysteresis and limit included
  X supply_pressure;             // [Pa]
  X return_pressure;             // [Pa]
  X load_force;                  // [N] opposes extension
  FrictionMemory<T> friction{};  // constant within a step
};

// The log's oil, the same for every candidate.
struct Oil {
  double density = 860.0;            // [kg/m3] at the log's temperature
  double dynamic_viscosity = 0.012;  // [Pa s] at the log's temperature
  double viscosity_ratio = 1.0;      // over the value at 40 degC
  double stiffness_ratio = 1.0;      // bulk modulus without air over that at 40 degC
};

inline constexpr double coldest_oil = 173.15, hottest_oil = 573.15;  // [K] beyond what any oil bears

// Density, viscosity and stiffness at a temperature: Walther's law (ASTM D341) through the viscosities at 40 and
// 100 degC, the latter 0 where it is not known; the bulk modulus of mineral oils falls by a factor of 10^0.0024 a
// kelvin (Hodges 1996, "Hydraulic Fluids").
Oil oil_at(double density_20, double kinematic_viscosity_40, double temperature_kelvin,
           double kinematic_viscosity_100 = 0.0);

}  // namespace servodx
