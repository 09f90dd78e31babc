// The virtual rig's equations: two-stage servovalve (flapper-nozzle or jet-pipe first stage), actuator on a flexible
// structure or a test stand's blocked or connected ports, supply. Layout after Borello, Dalla Vedova, Jacazio & Sorli
// 2009, Fig. 3, at component level (Merritt 1967). One explicit state vector, one right-hand side read from top to
// bottom in plant.cpp; the stage files say their own limits.
//
// Oil network: eight nodes with pressures, restrictions between them, one law for all (passage.h). Flows are of
// reference oil, so that they balance. Signs: positive current turns the flapper towards nozzle 1 (the jet towards
// receiver 1) -> pilot_pressure_1 rises -> spool moves positive -> P to A and B to T open -> piston extends. The wire's
// ball moves with the spool and against the flapper tip, so its stretch is x_spool + ball_arm * angle. Not modelled:
// lines (the valve sits on the actuator), heat, dissolved air, vapour, pump ripple, unbalanced spool lateral forces
// other than through the friction level, the reaction of a jet pipe's jet.
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
  // oil nodes, first so that they load as whole vectors; all pressures gauge
  p_filter,       // [Pa] behind the screen
  p_pilot_1,      // [Pa]
  p_pilot_2,      // [Pa]
  p_a,            // [Pa]
  p_b,            // [Pa]
  p_supply,       // [Pa] at the valve
  p_return,       // [Pa] at the valve
  p_accumulator,  // [Pa]
  q_pump,         // [m3/s]
  // electric and magnetic
  controller,  // [V] integral part of the driver's current controller
  current,     // [A] of the driver
  flux,        // [Wb] armature
  // first stage
  angle,       // [rad] armature, positive towards nozzle 1
  angle_rate,  // [rad/s]
  // spool
  x_spool,  // [m]
  v_spool,  // [m/s]
  z_spool,  // [m] bristle
  // actuator; absolute positions
  x_piston,   // [m]
  v_piston,   // [m/s]
  z_piston,   // [m] seal bristle
  x_body,     // [m]
  v_body,     // [m/s]
  x_surface,  // [m]
  v_surface,  // [m/s]
  // audit: reference oil that entered from the accumulator and left to the tank; energy that sources put in (coils,
  // null adjustment, supply less return, less work on the load) and that resistances, friction and iron took
  oil_in,       // [m3]
  oil_out,      // [m3]
  energy_in,    // [J]
  energy_lost,  // [J]
  n_vars
};
struct alignas(64) State : std::array<double, n_vars> {};

struct Inputs {
  double demand = 0.0;           // [A] at the driver's output stage, limited and quantised
  double force = 0.0;            // [N] on the surface, positive opposes extension
  double force_stiffness = 0.0;  // [N/m] spring from the surface to mid-stroke
  double offset = 0.0;           // [1] of rated current: what return pressure and temperature add to the null
};

// Flows and forces of one instant, for sensors, tests and plots.
struct Flows {
  double q_pa, q_at, q_pb, q_bt;                                   // [m3/s] in the direction of their name
  double q_a, q_b;                                                 // [m3/s] out of the valve into the port
  double q_across;                                                 // [m3/s] A to B: piston leakage or flow meter
  double q_filter, q_nozzle_1, q_nozzle_2, q_supply, q_return;     // [m3/s]
  double spool_friction, flow_force, wire_force, piston_friction;  // [N] on the spool or the piston
  double motor_torque;                                             // [N m]
};

class Plant {
 public:
  Plant(const RigModel& m, const Oil& oil, double temperature, const Wear& wear);
  void set_wear(const Wear& wear);

  // ds/dt; `hysteresis` is the step's magnetic memory
  void rates(const State& s, const Inputs& in, const Hysteresis& hysteresis, State& ds, Flows& flows) const;
  State rest() const;                       // valve centred, chambers at half supply
  double stored_oil(const State& s) const;  // [m3] of reference oil in all nodes between accumulator and tank
  // [J] in oil between accumulator and tank, magnetic circuit, springs and masses; the audit counts what bristles and
  // stops and iron hold back as lost
  double stored_energy(const State& s) const;
  double volume_a(const State& s) const;  // [m3]
  double volume_b(const State& s) const;  // [m3]

 private:
  struct Jets {
    Restrictions pilot;  // as pilot_
    Restriction bypass;
  };
  Jets jets(double x) const;
  std::array<Four, 2> volumes(const State& s) const;

  RigModel m_;
  Oil oil_;
  double tank_enthalpy_;
  double temperature_;
  Wear wear_;
  Magnetics magnetics_;
  Restrictions plumbing_;  // supply to filter, accumulator to supply, return to tank, A to B
  Restrictions pilot_;     // filter to pilot chambers 1 and 2, pilot chambers to return; flapper centred
  Edges edges_;
  Nozzle nozzle_1_, nozzle_2_;
  double jet_left_ = 1.0;  // [1] of a jet pipe's jet
  Friction spool_friction_, piston_friction_;
  double piston_area_a_, piston_area_b_, spool_area_, nozzle_area_, end_leak_, jet_momentum_, cushion_, moving_, null_mmf_, turns_,
      resistance_, leakage_, gain_, integral_, surface_damping_, earth_damping_, wire_, pump_pressure_;
  // reciprocals of what every evaluation divides by
  double per_accumulator_, per_pump_lag_, per_leakage_, per_gain_, per_inertia_, per_spool_mass_, per_piston_mass_,
      per_surface_mass_, per_body_mass_;
};

}  // namespace servodx::rig
