// The parts of a preflight test, found in the command alone: rest, a small step out and back, sines one after another.
//
// A step is a jump of at least 2 % of rated current from rest, held, and taken back. A sine is a run of equal half
// periods of at least two cycles, whose least-squares sinusoid (with a linear drift: open-loop tests carry a slow
// centring term) leaves less than a tenth of its rms. Leaves out sweeps, and sines above a quarter of the sample rate.
#pragma once
#include <optional>
#include <vector>

#include "fit/log_data.h"

namespace servodx {

struct Preflight {
  std::size_t rest = 0;     // samples at rest at the beginning
  double rest_current = 0;  // [A] mean over them: what holds the spool where it is
  struct Step {
    std::size_t from = 0, back = 0;  // first samples of the step and of the return
    double size = 0;                 // [A]
  };
  std::optional<Step> step;
  struct Sine {
    double frequency = 0, amplitude = 0;  // [Hz], [A]
    double start = 0;                     // [s] its first rising zero
    int cycles = 0;                       // whole ones
  };
  std::vector<Sine> sines;
};

Preflight find_preflight(const LogData& log);

// y ~ a + b (t - t0) + s sin(w (t - t0)) + c cos(w (t - t0)) over the samples [from, to), missing ones left out.
struct SineFit {
  double constant = 0, drift = 0, sine = 0, cosine = 0;
  double residual = 0;  // rms
  bool ok = false;
};
SineFit fit_sine(const std::vector<double>& time, const std::vector<double>& y, std::size_t from, std::size_t to,
                 double frequency, double t0);

}  // namespace servodx
