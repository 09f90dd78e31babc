// The model linearised along one of its runs: how a deviation of the state at one sample goes on to the next, and what
// something that is missing at a place of the model adds on the way.
//
// Jacobians are the integrator's own (duals), and so is the discretisation: columns of the identity take its steps on
// the linear system, L-stable as on the model itself. What dry friction remembers belongs to the state: a stuck part
// that stands elsewhere stays there, and no spring of its asperities pulls it back. What is missing is one more state
// at each place, constant in the model. Leaves out: breakaway friction's memory; a stop or a reversal that the
// deviation would bring about earlier or later than the run has it; valves on a test stand.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {

// Where something may be missing: places of the hooks (model/hooks.h).
struct MissingPlace {
  const char *where, *quantity, *unit;
  double typical;  // [unit]
};
inline constexpr MissingPlace missing_places[] = {
    {"drive", "current", "A", 2e-4},          // in the torque motor: a force on the flapper over the motor's gain
    {"spool", "force", "N", 2.0},             // positive opens P to A
    {"metering", "opening", "m", 2e-6},       // of the edges beyond the spool's travel
    {"flow_a", "flow", "m3/s", 2e-6},         // into chamber A
    {"flow_b", "flow", "m3/s", 2e-6},         // into chamber B
    {"flow_a", "flow across", "m3/s", 2e-6},  // out of B into A
    {"piston_force", "force", "N", 100.0},    // positive extends
    {"supply", "pressure", "Pa", 1e5},        // at the valve
};
inline constexpr int n_missing_places = static_cast<int>(std::size(missing_places));

struct Linearisation {
  bool ok = false;
  // The model's states (model/state.h), the effects' behind, then what friction remembers, then what is missing.
  int states = 0;
  std::vector<Eigen::MatrixXd> transition;  // to the next sample, or the `stride`-th: states x states, SI
  Eigen::VectorXd at_rest;                  // [states] how far a part at rest may stand from where its friction is none
};

// The missing inputs are the last states, in the order of their list.
Linearisation linearise(const Scenario& scenario, const ParameterVector& candidate, const SimulateOptions& options = {},
                        int stride = 1);

}  // namespace servodx
