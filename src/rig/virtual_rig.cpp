#include "rig/virtual_rig.h"

#include <cmath>

#include "rig/fluid.h"
#include "rig/rig_model.h"
#include "rig/wear.h"

namespace servodx::rig {
namespace {

State moved(const State& s, const State& ds, double h) {
  State out;
  for (int i = 0; i < n_vars; ++i) out[i] = s[i] + h * ds[i];
  return out;
}

}  // namespace

VirtualRig::VirtualRig(const RigModel& model, const Conditions& conditions)
    : model_(model),
      plant_(model, Oil(model, conditions.temperature, conditions.air, conditions.viscosity), conditions.temperature,
             conditions.wear),
      hysteresis_(model),
      s_(plant_.rest()),
      position_gain_(conditions.wear.position_gain) {}

void VirtualRig::set_wear(const Wear& wear) {
  plant_.set_wear(wear);
  position_gain_ = wear.position_gain;
}

double VirtualRig::demand(double command) const {
  const double rated = model_.driver_rated_current;
  const double quantum = model_.driver_quantum, limit = model_.driver_limit * rated;
  double wanted = quantum > 0.0 ? quantum * std::round(command / quantum) : command;
  if (model_.driver_dither_amplitude > 0.0) {
    const double turn = model_.driver_dither_frequency * time_;
    wanted += model_.driver_dither_amplitude * rated * std::sin(2.0 * std::numbers::pi * (turn - std::floor(turn)));
  }
  return limited(wanted, -limit, limit);
}

void VirtualRig::step(double command, double force, double force_stiffness, double h) {
  last_ = {demand(command), force, force_stiffness, offset_};
  State k1, k2, k3, k4;
  Flows flows;
  plant_.rates(s_, last_, hysteresis_, k1, flows_);
  plant_.rates(moved(s_, k1, 0.5 * h), last_, hysteresis_, k2, flows);
  plant_.rates(moved(s_, k2, 0.5 * h), last_, hysteresis_, k3, flows);
  plant_.rates(moved(s_, k3, h), last_, hysteresis_, k4, flows);
  for (int i = 0; i < n_vars; ++i) s_[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
  hysteresis_.commit(s_[flux]);
  time_ += h;
}

Flows VirtualRig::flows() const {
  State ds;
  Flows flows;
  plant_.rates(s_, last_, hysteresis_, ds, flows);
  return flows;
}

}  // namespace servodx::rig
