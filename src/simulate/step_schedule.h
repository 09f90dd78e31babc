// Into how many steps the way from one sample to the next is cut.
//
// A linearly implicit step does not see a stop that it has not reached. After a jump the flapper crosses its gap in a
// tenth of a millisecond, so the steps are short until the spool has answered. This schedule comes from the log alone:
// every candidate takes the same steps. What a candidate asks for beyond it: simulate/shorter_steps.h.
// On a test stand, slower than full stroke in a second, the valve's own dynamics stay settled, and an L-stable step
// passes over them.
// Limits: what these steps cost in accuracy stands in docs/model.md, "Integration". Source: the same page.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {

inline int steps_of(double dt, double largest) { return std::max(1, static_cast<int>(std::ceil(dt / largest - 1e-6))); }

// Plain numbers: a run in parts saves it and takes it up again.
class StepSchedule {
 public:
  explicit StepSchedule(double begin) : lively_until_(begin), impact_until_(begin - 1.0) {}

  // From sample k to the next, `dt` [s] later.
  int steps(const Scenario& in, const SimulateOptions& options, std::size_t k, double dt) {
    const double moved = std::abs(in.command[k + 1] - in.command[k]);
    const double jumped = in.fast ? in.fast.move[k] : moved;
    if (jumped > jump * in.rated_current) impact_until_ = in.time[k + 1] + impact_time;
    if (std::max(moved, jumped) > creep * in.rated_current * dt) lively_until_ = in.time[k + 1] + settle_time;
    const bool creeps = in.ports != Ports::actuator && in.time[k] >= lively_until_;
    const double usual = creeps ? options.creep_step : options.step;
    return steps_of(dt, in.time[k] < impact_until_ ? std::min(options.step, options.impact_step) : usual);
  }

 private:
  // A command that is held from sample to sample is made of jumps; a smooth one at 2 kHz has 3 % a sample. Usual steps
  // follow those: errors grow by a tenth of a sensor's noise at most (docs/lab/performance.md, "Steps after a jump").
  static constexpr double jump = 0.1;          // of rated current
  static constexpr double impact_time = 4e-3;  // [s]
  static constexpr double creep = 1.0;         // [1/s] rated current per time
  static constexpr double settle_time = 0.05;  // [s]

  double lively_until_, impact_until_;  // [s] of the log
};

}  // namespace servodx
