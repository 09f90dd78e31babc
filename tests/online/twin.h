// A valve whose equations are the model's own, with sensors that have noise, and a failure that steps in.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "base/random.h"
#include "effects/registry.h"
#include "effects/transport_delay.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "model/state.h"
#include "online/watched_model.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "signals/sample.h"
#include "simulate/run_in_parts.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx::twin {

struct Sensor {
  Signal signal;
  double noise;  // [SI] rms, and what the error model says beside it
};
inline constexpr Sensor sensors[] = {{Signal::spool_position, 1e-6},
                                     {Signal::piston_position, 1e-5},
                                     {Signal::pressure_a, 2e4},
                                     {Signal::pressure_b, 2e4}};

inline WatchedModel model() {
  WatchedModel out = watched_model(shipped_table(), shipped_rig());
  for (const Sensor& s : sensors) {
    out.error.channels.push_back({s.signal, s.noise, 0.1, 50});
    out.noise[s.signal] = s.noise;
  }
  return out;
}

struct Failure {
  std::string fault;               // label; empty: none. "open_coil": the current stops
  double severity = 0, onset = 0;  // [s]
};

// Two sines of the command, so that the valve never rests for long.
inline std::vector<Sample> samples(double seconds, const Failure& failure = {}, bool current = false,
                                   std::uint64_t seed = 1) {
  ParameterVector healthy = candidate_of(shipped_table());
  healthy[effect_row<TransportDelay>(0)] = 1e-9;  // the kernel with all effects, before and after
  ParameterVector failed = healthy;
  if (const Fault* fault = find_fault(failure.fault)) fault->apply(failed.data(), failure.severity);
  const auto n = static_cast<std::size_t>(seconds * 1e3) + 1;
  const bool open = failure.fault == "open_coil";
  const auto command = [](double t) {
    return 0.008 * std::sin(2 * std::numbers::pi * 3.1 * t) + 0.003 * std::sin(2 * std::numbers::pi * 11.7 * t);
  };
  const auto passed = [&](double t) { return open && t >= failure.onset ? 0.0 : command(t); };
  Scenario s;
  s.oil = oil_at(860, 14e-6, 313.15);
  s.spool_start = s.piston_start = 0.0;
  s.pressure_a_start = s.pressure_b_start = 105e5;
  Trajectory shown;
  SimulateOptions how;
  how.threads = 1;
  std::unique_ptr<RunInParts> run;
  std::vector<Sample> out;
  Random random(seed);
  for (std::size_t k = 0; k < n; ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    if (k == 0) {
      s.time = {t}, s.command = {passed(t)};
      run = run_in_parts(s, healthy, shown, how);
    } else {
      s.time = {t - 1e-3, t}, s.command = {passed(t - 1e-3), passed(t)};
      if (!failure.fault.empty() && !open && t - 1e-3 < failure.onset && t >= failure.onset) {
        const std::string memory = run->memory();
        run = run_in_parts(s, failed, shown, how);
        run->recall(memory);
      }
      for (auto& signal : shown.signals)
        if (!signal.empty()) signal.resize(2);
      run->go_on();
    }
    Sample sample;
    sample.time = t;
    sample[Signal::command] = command(t);
    if (current) sample[Signal::coil_current] = passed(t);
    for (const Sensor& sensor : sensors)
      sample[sensor.signal] = shown.signals[static_cast<std::size_t>(simulated_index(sensor.signal))].back() +
                              sensor.noise * random.normal();
    out.push_back(sample);
  }
  return out;
}

inline std::vector<Signal> recorded(bool current = false) {
  std::vector<Signal> out = {Signal::command};
  if (current) out.push_back(Signal::coil_current);
  for (const Sensor& s : sensors) out.push_back(s.signal);
  return out;
}

}  // namespace servodx::twin
