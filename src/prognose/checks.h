// The three prognostic checks of Borello et al. 2009, sec. 6, from a log and the monitor's run beside it.
//
//   mean error   |e| = (1/T) integral |x_T - x_M| dt                      in service, running
//   fidelity     r = integral x_T x_M / integral x_T^2                    over the model's 95 % response to a step
//   correlation  E(tau) = (1/T) integral x_T(t) y(t + tau) dt, tau = 1/(4 f)   whole cycles of a small sine
//
// x_T measured, x_M monitor's spool, y measured piston. r as printed is garbled; a smaller or slower spool must raise
// it (figs. 8, 9), which this form does: a gain loss to g gives 1/g whatever T is. Standard errors come from the
// sensors' noise (r, E) and from batch means (|e|). Without a spool sensor only E is left, with x_M in place of x_T.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "prognose/monitor.h"
#include "prognose/preflight.h"

namespace servodx {

struct Figure {
  double value = 0, std_error = 0;
};

struct MeanError {
  Figure figure;                // [m]
  std::vector<double> running;  // [m] one a sample
  double settled_at = 0;        // [s] from here on the running mean stays within 10 % of its end
  bool settled = false;         // that is in the first half, and the standard error is below 10 %
};
MeanError mean_error(const std::vector<double>& time, const std::vector<double>& measured,
                     const std::vector<double>& monitor);

struct Fidelity {
  Figure figure;             // [1]
  double duration = 0;       // [s] T
  bool no_response = false;  // the spool hardly moved: r has no value
};
// `measured` and `monitor` are both from their rest. `noise` [m] of a sample of the spool.
std::optional<Fidelity> fidelity(const std::vector<double>& time, const std::vector<double>& measured,
                                 const std::vector<double>& monitor, const Preflight::Step& step, double noise);

// [m2]; noises [m] of samples of spool and piston. Empty where fewer than two cycles are in the record.
std::optional<Figure> correlation(const std::vector<double>& time, const std::vector<double>& spool,
                                  const std::vector<double>& piston, const Preflight::Sine& sine, double spool_noise,
                                  double piston_noise);

}  // namespace servodx
