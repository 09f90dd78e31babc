// Small helpers shared by the rig's tests.
#pragma once
#include <cmath>
#include <string>

#include "base/celsius.h"
#include "rig/fluid.h"
#include "rig/passage.h"
#include "rig/rig_faults.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "rig/virtual_rig.h"

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

// Through one edge and its drilling [m3/s] at 40 degC, p_from = dp and p_to = 0 gauge.
inline double edge_flow(const RigModel& m, EdgeName edge, double x_spool, double dp, double p_to = 0.0) {
  const Oil oil(m, 40.0 + zero_celsius, 0.0);
  return flows_through(Edges(m).at(x_spool).law, oil, Four(p_to + dp), Four(p_to)).volume[edge];
}

inline Conditions with_faults(const std::vector<std::string>& list) {
  FaultSet faults;
  for (const auto& fault : list) add_fault(fault, faults);
  return {.wear = wear_of(faults)};
}
inline Conditions with_fault(const std::string& fault) { return with_faults({fault}); }

}  // namespace servodx::rig
