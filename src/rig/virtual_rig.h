// One virtual rig that can be stepped: the plant, its magnetic memory, and a classical fixed-step Runge-Kutta 4.
// Explicit on purpose: the fitted model uses an implicit stepper, and a shared numerical error would flatter the fit.
// The stiffest parts are a chamber at its smallest volume behind a wide-open edge with no pressure across it, and the
// supply line without flow (about 2 us each, hot oil); RK4 is stable to 2.8 time constants. tests/rig shows
// convergence.
#pragma once
#include "base/celsius.h"
#include "rig/fluid.h"
#include "rig/magnetics.h"
#include "rig/plant.h"
#include "rig/rig_model.h"
#include "rig/wear.h"

namespace servodx::rig {

struct Conditions {
  double temperature = 40.0 + zero_celsius;  // [K]
  double air = 0.005;                        // [1] free air at atmospheric pressure
  Wear wear = {};
  double viscosity = 1.0;  // [1] of the oil, over what the model's law says; drawings are stated with the model's oil
};

class VirtualRig {
 public:
  VirtualRig(const RigModel& model, const Conditions& conditions);

  void set_wear(const Wear& wear);
  void set_offset(double fraction) { offset_ = fraction; }  // [1] of rated current, added behind the logged command
  // Holds `command` [A] (before driver limit, converter and dither), and the load, over one step of h [s].
  void step(double command, double force, double force_stiffness, double h);

  const RigModel& model() const { return model_; }
  const Plant& plant() const { return plant_; }
  const State& state() const { return s_; }
  State& state() { return s_; }
  double time() const { return time_; }                                 // [s] since it was made
  Flows flows() const;                                                  // of the present state
  const Flows& last_flows() const { return flows_; }                    // where the last step began
  double piston_position() const { return s_[x_piston] - s_[x_body]; }  // [m] rod relative to body
  double piston_speed() const { return s_[v_piston] - s_[v_body]; }     // [m/s]
  double position_gain() const { return position_gain_; }               // [1] what wear left of the position sensor's

 private:
  double demand(double command) const;
  RigModel model_;
  Plant plant_;
  Hysteresis hysteresis_;
  State s_;
  double time_ = 0.0, offset_ = 0.0, position_gain_ = 1.0;
  Inputs last_;
  Flows flows_{};
};

}  // namespace servodx::rig
