// A foreign rig's equations of motion: amplifier, torque motor, flapper and nozzles, spool, metering edges, lines,
// cylinder on its mount, supply and return. Explicit, stepped by Runge and Kutta's fourth order with a fixed step.
//
// The laws are chosen to be other than those of the fitted model and of the virtual rig: magnetic loops after Dahl,
// orifices by a hyperbolic tangent or a rational law of a Reynolds-like number, edges as a rounded orifice in series
// with a laminar land, friction by LuGre bristles, lines as inertance between two volumes. Flows are volumes at the
// node's own pressure: compression is in the nodes, not in the edges. Positive current moves the flapper to nozzle 1,
// raises pilot pressure 1, moves the spool positive, opens P to A and B to T, extends the piston.
#pragma once
#include <array>

#include "condition.h"
#include "design.h"
#include "oil.h"

namespace servodx::foreign {

enum Var : int {
  current,        // [A] in the coil
  loop_1,         // [1] magnetic loops
  loop_2,         // [1]
  x_flapper,      // [m] towards nozzle 1
  v_flapper,      // [m/s]
  x_spool,        // [m]
  v_spool,        // [m/s]
  z_spool,        // [m] bristle
  p_screen,       // [Pa] behind the screen; all pressures gauge
  p_pilot_1,      // [Pa]
  p_pilot_2,      // [Pa]
  p_valve_a,      // [Pa] in the manifold
  p_valve_b,      // [Pa]
  q_line_a,       // [m3/s] towards the cylinder
  q_line_b,       // [m3/s]
  p_chamber_a,    // [Pa]
  p_chamber_b,    // [Pa]
  p_supply,       // [Pa] at the valve
  p_accumulator,  // [Pa]
  q_supply,       // [m3/s] towards the valve
  p_return,       // [Pa] at the valve
  x_piston,       // [m] absolute
  v_piston,       // [m/s]
  z_piston,       // [m] bristle
  x_body,         // [m]
  v_body,         // [m/s]
  n_vars
};
using State = std::array<double, n_vars>;

struct Drive {
  double demand = 0.0;  // [A]
  double force = 0.0;   // [N] external, opposes extension
  double spring = 0.0;  // [N/m] external, to mid-stroke
  double drag = 0.0;    // [N s/m] external
};

struct Flows {
  std::array<double, n_edges> edge;                         // [m3/s] in the direction of the edge's name
  double screen, orifice_1, orifice_2, nozzle_1, nozzle_2;  // [m3/s]
  double across;                                            // [m3/s] A to B past the piston
  double load;                                              // [N]
};

class Machine {
 public:
  Machine(const Design& design, const Condition& condition);
  void rates(const State& s, const Drive& in, State& ds, Flows& flows) const;
  void step(State& s, const Drive& in, double h) const;
  State rest() const;

 private:
  double edge_flow(double opening, double p_from, double p_to) const;
  double orifice(double area, double width, double discharge, double p_from, double p_to) const;
  void motor(const State& s, const Drive& in, State& ds) const;
  void pilot(const State& s, State& ds, Flows& flows) const;
  void metering(const State& s, Flows& flows) const;
  void spool(const State& s, State& ds, const Flows& flows) const;
  void lines(const State& s, State& ds, const Flows& flows) const;
  void supply(const State& s, State& ds, const Flows& flows) const;
  void cylinder(const State& s, const Drive& in, State& ds, Flows& flows) const;

  Design d_;
  Condition c_;
  Oil oil_;
  double rho_, spool_area_, nozzle_area_, clearance_, rounding_, line_area_, line_laminar_, line_turbulent_, volume_a_,
      volume_b_, softness_a_, softness_b_, spool_coulomb_, spool_breakaway_, spool_bristle_, spool_viscous_, mount_,
      mount_damping_, screen_a_, screen_b_;
};

}  // namespace servodx::foreign
