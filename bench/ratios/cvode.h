// The model under SUNDIALS' CVODE: BDF held to order 2 (the lightly damped pilot mode lies in the lobe where orders 3
// to 5 are unstable), analytic Jacobian from the same dual numbers, dense direct solver, the state scaled by tolerances
// of its own. Friction's anchors are dragged after each of its steps, as they are after each of ours.
#pragma once
#include <optional>

#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx::bench {

struct CvodeSetting {
  double tolerance = 1e-5;     // relative; absolute: times each state's typical size
  bool stop_at_knots = false;  // at every sample, where the input bends
};

// The reason why there is none, or null.
const char* cvode_missing();
// Empty: it failed.
std::optional<Trajectory> run_cvode(const Scenario& scenario, const ParameterVector& candidate,
                                    const CvodeSetting& setting, const Trajectory& start);

}  // namespace servodx::bench
