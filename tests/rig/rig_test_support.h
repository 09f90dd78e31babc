// Small helpers shared by the rig's tests.
#pragma once
#include <cmath>
#include <string>

#include "rig/rig_run.h"

namespace servodx::rig {

inline const RigModel& flight_rig() {
  static const RigModel model = read_rig_model(std::string(SERVODX_SOURCE_DIR) + "/params/rigs/borello2009.toml");
  return model;
}

inline void hold(VirtualRig& rig, double command, double seconds, double force = 0.0, double h = 0.0) {
  if (h == 0.0) h = rig.model().solver_step;
  const long n = std::lround(seconds / h);
  for (long i = 0; i < n; ++i) rig.step(command, force, 0.0, h);
}

// A rig whose piston starts at `x` [m], settled for 0.1 s.
inline VirtualRig settled(const Conditions& conditions = {}, double x = 0.0) {
  VirtualRig rig(flight_rig(), conditions);
  rig.state()[x_piston] = rig.state()[x_surface] = x;
  hold(rig, 0.0, 0.1);
  return rig;
}

inline Conditions with_fault(const std::string& fault) {
  FaultSet faults;
  add_fault(fault, faults);
  return {.wear = wear_of(faults)};
}

}  // namespace servodx::rig
