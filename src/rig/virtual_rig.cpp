#include "rig/virtual_rig.h"

#include <cmath>

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
      plant_(model, Fluid(model, conditions.temperature, conditions.air), conditions.temperature, conditions.wear),
      hysteresis_(model.motor_coercive_mmf, model.motor_hysteresis_flux),
      s_(plant_.rest()) {}

double VirtualRig::demand(double command) const {
  const double quantum = model_.driver_quantum, limit = model_.driver_limit * model_.driver_rated_current;
  const double stepped = quantum > 0.0 ? quantum * std::round(command / quantum) : command;
  return std::fmin(std::fmax(stepped, -limit), limit);
}

void VirtualRig::step(double command, double force, double force_stiffness, double h) {
  last_ = {demand(command), force, force_stiffness};
  State k1, k2, k3, k4;
  Flows flows;
  plant_.rates(s_, last_, hysteresis_, committed_flux_, k1, flows);
  plant_.rates(moved(s_, k1, 0.5 * h), last_, hysteresis_, committed_flux_, k2, flows);
  plant_.rates(moved(s_, k2, 0.5 * h), last_, hysteresis_, committed_flux_, k3, flows);
  plant_.rates(moved(s_, k3, h), last_, hysteresis_, committed_flux_, k4, flows);
  for (int i = 0; i < n_vars; ++i) s_[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
  hysteresis_.commit(s_[flux] - committed_flux_);
  committed_flux_ = s_[flux];
}

Flows VirtualRig::flows() const {
  State ds;
  Flows flows;
  plant_.rates(s_, last_, hysteresis_, committed_flux_, ds, flows);
  return flows;
}

}  // namespace servodx::rig
