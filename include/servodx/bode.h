// Frequency response of valves beside each other, at one amplitude. `servodx/pages.h` makes them.
#pragma once
#include <string>
#include <vector>

namespace servodx {

struct BodeLine {
  std::string name;
  std::vector<double> gain;   // [dB] over the first valve's at the lowest frequency; NaN: the simulation failed
  std::vector<double> phase;  // [rad] negative where it lags
};

struct Bode {
  double amplitude = 0;           // [fraction of rated current] peak
  std::vector<double> frequency;  // [Hz]
  std::vector<BodeLine> lines;    // one a valve
};

}  // namespace servodx
