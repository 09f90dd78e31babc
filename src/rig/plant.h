// The virtual rig's equations: two-stage flapper-nozzle servovalve, actuator on a flexible structure, supply.
// Layout after Borello, Dalla Vedova, Jacazio & Sorli 2009, Fig. 3, at component level (Merritt 1967). One explicit
// state vector, one right-hand side read from top to bottom in plant.cpp; the stage files say their own limits.
//
// Signs: positive current turns the flapper towards nozzle 1 -> pilot_pressure_1 rises -> spool moves positive ->
// P to A and B to T open -> piston extends. The wire's ball moves with the spool and against the flapper tip, so its
// stretch is x_spool + ball_arm * angle.
// Not modelled: lines (the valve sits on the actuator), heat, dissolved air, vapour, pump ripple, unbalanced spool
// lateral forces other than through the friction level.
#pragma once
#include <array>

#include "rig/contact.h"
#include "rig/fluid.h"
#include "rig/magnetics.h"
#include "rig/passage.h"
#include "rig/rig_model.h"
#include "rig/wear.h"

namespace servodx::rig {

enum Var : int {
  // electric and magnetic
  current,  // [A] coil
  flux,     // [Wb] armature
  // first stage
  angle,       // [rad] armature, positive towards nozzle 1
  angle_rate,  // [rad/s]
  p_filter,    // [Pa] behind the screen; all pressures gauge
  p_pilot_1,   // [Pa]
  p_pilot_2,   // [Pa]
  // spool
  x_spool,  // [m]
  v_spool,  // [m/s]
  z_spool,  // [m] bristle
  // actuator; absolute positions
  p_a,        // [Pa]
  p_b,        // [Pa]
  x_piston,   // [m]
  v_piston,   // [m/s]
  z_piston,   // [m] seal bristle
  x_body,     // [m]
  v_body,     // [m/s]
  x_surface,  // [m]
  v_surface,  // [m/s]
  // supply
  p_supply,       // [Pa] at the valve
  p_return,       // [Pa] at the valve
  p_accumulator,  // [Pa]
  q_pump,         // [m3/s]
  // audit: reference oil that entered from the accumulator and left to the tank
  oil_in,   // [m3]
  oil_out,  // [m3]
  n_vars
};
using State = std::array<double, n_vars>;

struct Inputs {
  double demand = 0.0;           // [A] at the driver's output stage, limited and quantised
  double force = 0.0;            // [N] on the surface, positive opposes extension
  double force_stiffness = 0.0;  // [N/m] spring from the surface to mid-stroke
};

// Flows and forces of one instant, for sensors, tests and plots.
struct Flows {
  double q_pa, q_at, q_pb, q_bt;                                   // [m3/s] in the direction of their name
  double q_a, q_b;                                                 // [m3/s] out of the valve into the port
  double q_filter, q_nozzle_1, q_nozzle_2, q_supply, q_return;     // [m3/s]
  double spool_friction, flow_force, wire_force, piston_friction;  // [N] on the spool or the piston
};

class Plant {
 public:
  Plant(const RigModel& m, const Fluid& oil, double temperature, const Wear& wear);
  void set_wear(const Wear& wear);

  // ds/dt; `hysteresis` and the flux at which it was committed are the step's memory
  void rates(const State& s, const Inputs& in, const Hysteresis& hysteresis, double committed_flux, State& ds,
             Flows& flows) const;
  State rest() const;                       // valve centred, chambers at half supply
  double stored_oil(const State& s) const;  // [m3] of reference oil in all nodes between accumulator and tank
  double volume_a(const State& s) const;    // [m3]
  double volume_b(const State& s) const;    // [m3]

 private:
  RigModel m_;
  Fluid oil_;
  double temperature_;
  Wear wear_;
  Magnetics magnetics_;
  Edge edge_;
  Nozzle nozzle_1_, nozzle_2_;
  Friction spool_friction_, piston_friction_;
  Loss orifice_, filter_, supply_line_, return_line_;
  double piston_area_, spool_area_, nozzle_area_, end_leak_, piston_leak_, driver_rate_, null_mmf_, jet_cosine_,
      surface_damping_, earth_damping_, wire_;
};

}  // namespace servodx::rig
