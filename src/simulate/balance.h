// The equations of the actuator with measured signals in place of simulated ones: what flow and what force they miss.
//
// The model is not run; so what one block has wrong does not leak into the next. Over a window T
//   missing flow A  = C_A (p_A(T) - p_A(0)) / T - mean of what the edges and the seal let in, less A_A (x(T) - x(0)) /
//   T missing force   = m (x(T) - 2 x(T/2) + x(0)) / (T/2)^2 - the net force, weighed by a hat over the window
// so nothing is differentiated. Flow B likewise. Needs spool, piston and both pressures for the flows, piston and both
// pressures for the force. Leaves out: effects with states of their own (a mount that gives way), and what happens
// within a window; friction follows the measured way of the rod.
#pragma once
#include <vector>

#include "simulate/scenario.h"

namespace servodx {

// Measured, in SI, NaN where missing; null where the log has none.
struct Measured {
  const std::vector<double>*spool = nullptr, *piston = nullptr, *pressure_a = nullptr, *pressure_b = nullptr;
  bool quiet = false;  // spool and piston are without noise already
};
// Spool and piston as `balance` takes them: noise out, NaN where missing. time [s] of the samples.
std::vector<double> quiet(const std::vector<double>& time, const std::vector<double>& measured);
struct Balance {
  std::vector<double> time;            // [s] middle of each window
  std::vector<double> flow_a, flow_b;  // [m3/s] missing into the chamber; empty: not shown by the log
  std::vector<double> force;           // [N] missing on the piston, positive extends
  // [Pa] what the supply pressure lies above its mean and the droop (effect supply_droop) by the flow that the rod's
  // way draws; empty: not measured
  std::vector<double> supply;
  // Middle of each window: what the missing may depend on.
  std::vector<double> spool, piston, velocity, load_pressure;  // [m], [m], [m/s], [Pa]
  // The rod slides all through, one way, by more than its seals give before they slip, and clear of the stops'
  // cushions, which the model does not have: the last twentieth of the stroke at either end.
  std::vector<char> slides;
};

Balance balance(const Scenario& scenario, const Measured& measured, const ParameterVector& candidate, double window);

}  // namespace servodx
