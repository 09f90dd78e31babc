// Stability of the closed position loop: how much gain and phase it has to spare, and where backlash makes it cycle.
//
// The loop is a proportional controller on the piston's position, u = K (x_set - x). The valve and actuator are the
// model linearised at rest: spool at its null and edges without laps, piston at mid-stroke, no load. What dry friction
// and backlash do depends on how far the spool moves; they enter by their describing functions at an amplitude A (Gelb
// & Vander Velde 1968, Multiple-Input Describing Functions, sec. 2.3):
//   backlash  dead zone of half width d in the wire's pull: the wire's stiffness times
//             N = 1 - 2/pi (asin(d/A) + d/A sqrt(1 - (d/A)^2)), 0 where A <= d
//   friction  F sign(v) of the spool: the force j 4 F / (pi A) per travel, 90 degrees ahead of it
//   flow      of the edges with their laps, a part of the straight line's near null: N of HF's no-load flow
// A limit cycle is where the loop has nothing to spare: smaller ones grow and larger ones die away.
//
// Limits: first harmonic only; friction of the piston is left out, which damps; one working point.
#pragma once
#include <complex>
#include <optional>
#include <vector>

#include "faults/fault.h"
#include "parameters/table.h"
#include "prognose/monitor.h"
#include "simulate/scenario.h"

namespace servodx {

struct Margins {
  double gain = 0;             // [dB] by which the loop's gain may rise; negative where it is too high
  double gain_frequency = 0;   // [Hz] at which it then cycles
  double phase = 0;            // [deg] by which the loop may lag more
  double phase_frequency = 0;  // [Hz] of the loop's gain one
};

struct LimitCycle {
  double frequency = 0;          // [Hz]
  double spool = 0, piston = 0;  // [m] amplitudes
};

class PositionLoop {
 public:
  // `velocity_gain` [1/s]: piston speed per error of the healthy loop beyond null, which sets K by the tuned table.
  // `delay` [s] of the controller: half a sample of hold, and what it takes to compute. Throws InputError where the
  // model has no rest.
  PositionLoop(const Table& tuned, const Supply& at, double velocity_gain, double delay = 0);

  // Of a valve with the rows of `candidate` and the same controller, its spool moving by `amplitude` [m].
  Margins margins(const ParameterVector& candidate, double amplitude) const;
  // The largest one between half the backlash and `largest` [m]; none where the loop is stable at all amplitudes, or
  // grows beyond.
  std::optional<LimitCycle> limit_cycle(const ParameterVector& candidate, double largest) const;

  const ParameterVector& healthy() const { return healthy_; }
  double gain() const { return gain_; }  // [A/m] K

 private:
  struct Response {
    std::complex<double> spool_per_current, piston_per_current;  // [m/A]
    std::complex<double> spool_per_force, piston_per_force;      // [m/N] on the spool
  };
  // At a grid of frequencies, of the valve whose wire pulls with `wire` of its stiffness.
  std::vector<Response> responses(const ParameterVector& candidate, double wire) const;
  std::vector<Response> moving(const ParameterVector& candidate, double amplitude) const;
  Margins margins_of(const std::vector<Response>& responses) const;
  // Flow per travel of a spool that moves by `amplitude` [m], over the slope at null without laps; none: of the
  // straight part.
  double over_null_slope(const ParameterVector& candidate, std::optional<double> amplitude) const;

  Supply at_;
  double delay_ = 0, gain_ = 0;
  ParameterVector healthy_;
};

// [m] of the spool, by which `--limit margin` judges: as in the paper's preflight sine, 4 % of rated current.
double judged_amplitude(const Table& tuned, const Supply& at);

enum class MarginKind { gain, phase };
// Severity at which the margin [dB], [deg] has come down to `wanted`; none where it does not before the fault's worst.
std::optional<double> severity_at_margin(const PositionLoop& loop, const Fault& fault, MarginKind kind, double wanted,
                                         double amplitude);

}  // namespace servodx
