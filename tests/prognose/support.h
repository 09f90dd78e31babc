// A preflight log of the shipped table's own making: rest, step, sines. Only where a test needs no plant of its own.
#pragma once
#include <cmath>
#include <numbers>

#include "fit/log_data.h"
#include "parameters/table.h"
#include "simulate/scenario.h"

namespace servodx {

inline Table shipped_table() { return read_table(SERVODX_SOURCE_DIR "/params/borello2009.csv"); }

// 1 kHz: rest to 0.1 s, a step of 10 % to 0.25 s, rest to 0.4 s, then four cycles at each frequency.
inline LogData preflight_log(const std::vector<double>& frequencies = {5.0}, double offset = 0.0) {
  LogData log;
  Scenario& s = log.scenario;
  double end = 0.4;
  std::vector<double> starts;
  for (double f : frequencies) starts.push_back(end), end += 4 / f;
  for (int k = 0; k <= static_cast<int>(end * 1000); ++k) {
    const double t = k * 1e-3;
    double u = t >= 0.1 && t < 0.25 ? 0.1 : 0.0;
    for (std::size_t i = 0; i < starts.size(); ++i)
      if (t >= starts[i] && t < starts[i] + 4 / frequencies[i])
        u = 0.04 * std::sin(2 * std::numbers::pi * frequencies[i] * (t - starts[i]));
    s.time.push_back(t);
    s.command.push_back(s.rated_current * (u + offset));
  }
  return log;
}

}  // namespace servodx
