// What every row of the table runs on: the flight actuator of the shipped table under a lively command from rest.
#pragma once
#include <cmath>
#include <numbers>

#include "fit/log_data.h"
#include "parameters/table.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx::bench {

inline const Table& table() {
  static const Table t = apply_rig_facts(read_table(std::string(SERVODX_SOURCE_DIR) + "/params/borello2009.csv"),
                                         read_rig_file(std::string(SERVODX_SOURCE_DIR) + "/data/rig.toml"));
  return t;
}

// Eight tones of 0.4 to 20 Hz at 1 kHz, up to half of rated current, and a load of 1.5 kN; both grow from rest.
inline Scenario trace(double seconds) {
  Scenario s;
  constexpr double pi = std::numbers::pi;
  for (int k = 0; k <= static_cast<int>(seconds * 1000 + 0.5); ++k) {
    const double t = 1e-3 * k, grown = 1 - std::exp(-t * t / 0.02);
    double u = 0;
    for (int m = 0; m < 8; ++m) u += std::sin(2 * pi * 0.4 * std::pow(50.0, m / 7.0) * t + 1.3 * m * m);
    s.time.push_back(t);
    s.command.push_back(0.02 * grown * u / 8);
    s.load_force.push_back(1500 * grown * std::sin(2 * pi * 1.1 * t));
  }
  s.command_slope = 1.0;
  return s;
}

inline SimulateOptions one_thread() {
  SimulateOptions o;
  o.threads = 1;
  return o;
}

// Largest difference on the chamber pressures, over their range. [-]
inline double pressure_error(const Trajectory& t, const Trajectory& truth) {
  double worst = 0;
  for (int c : {simulated_index(Signal::pressure_a), simulated_index(Signal::pressure_b)}) {
    const auto [low, high] = std::minmax_element(truth.signals[c].begin(), truth.signals[c].end());
    for (std::size_t k = 0; k < truth.signals[c].size(); ++k)
      worst = std::max(worst, std::abs(t.signals[c][k] - truth.signals[c][k]) / (*high - *low));
  }
  return worst;
}

}  // namespace servodx::bench
