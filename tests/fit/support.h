// Logs that the model itself wrote: a shipped log's inputs, simulated at known values, with white noise on top.
#pragma once
#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "fit/chart.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "parameters/table.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {

// Noise `times` that of the log's own channel.
inline LogData written_by_model(LogData log, const ParameterVector& truth, unsigned seed, double times = 1.0) {
  SimulateOptions o;
  o.wanted.fill(true);
  const Trajectory t = simulate(log.scenario, truth, o);
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    FitChannel& channel = log.channels[c];
    Random random(seed, static_cast<std::uint32_t>(c));
    channel.noise *= times;
    channel.measured = t.signals[channel.simulated];
    for (double& x : channel.measured) x += random.normal(0.0, channel.noise);
  }
  return log;
}

// A row as a free number within the table's bounds, without a prior.
inline FreeValue free_row(const Table& table, int row) { return {coordinate(table[row]), row}; }

}  // namespace servodx
