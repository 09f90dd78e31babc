// One log of a foreign rig: settles the machine, drives it tick by tick, and reads its sensors at the log's rate.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "condition.h"
#include "design.h"
#include "excite.h"
#include "machine.h"

namespace servodx::foreign {

struct Recording {
  std::vector<double> time;                             // [s]
  std::vector<double> command;                          // [A] demanded
  std::array<std::vector<double>, n_channels> channel;  // SI; coil current and temperature [degC] among them
};

struct Job {
  Excitation excitation;
  Condition condition;
  std::optional<Condition> later = std::nullopt;  // from `onset` on
  double onset = 0.0;                             // [s]
  std::uint32_t noise = 0;                        // stream of the sensors' noise
  bool quiet = false;                             // without noise and steps of the converters
  double finer = 1.0;                             // integration steps per usual step
  double settling = 0.4;                          // [s] of position control ahead of the log
  // Called after each tick with what is true, where given.
  std::function<void(double time, const State&, const Flows&)> watch = {};
};

// Throws std::runtime_error where the integration leaves the finite.
Recording run(const Design& design, const Job& job);

}  // namespace servodx::foreign
