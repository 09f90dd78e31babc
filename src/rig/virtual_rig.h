// One virtual rig that can be stepped: the plant, its magnetic memory, and a classical fixed-step Runge-Kutta 4.
// Explicit on purpose: the fitted model uses an implicit stepper, and a shared numerical error would flatter the fit.
// The stiffest parts are a chamber at its smallest volume behind a wide-open edge with no pressure across it (1.9 us,
// hot oil) and the spool bristles (about 10 us); RK4 is stable to 2.8 time constants. tests/rig shows convergence.
#pragma once
#include "rig/plant.h"

namespace servodx::rig {

struct Conditions {
  double temperature = 40.0 + zero_celsius;  // [K]
  double air = 0.005;                        // [1] free air at atmospheric pressure
  Wear wear = {};
};

class VirtualRig {
 public:
  VirtualRig(const RigModel& model, const Conditions& conditions);

  void set_wear(const Wear& wear) { plant_.set_wear(wear); }
  // Holds `command` [A] (before driver limit and converter), and the load, over one step of h [s].
  void step(double command, double force, double force_stiffness, double h);

  const RigModel& model() const { return model_; }
  const Plant& plant() const { return plant_; }
  const State& state() const { return s_; }
  State& state() { return s_; }
  Flows flows() const;                                                  // of the present state
  double piston_position() const { return s_[x_piston] - s_[x_body]; }  // [m] rod relative to body
  double piston_speed() const { return s_[v_piston] - s_[v_body]; }     // [m/s]

 private:
  double demand(double command) const;
  RigModel model_;
  Plant plant_;
  Hysteresis hysteresis_;
  State s_;
  double committed_flux_ = 0.0;
  Inputs last_;
};

}  // namespace servodx::rig
