#include "prognose/preflight_figures.h"

#include <cmath>

#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {

const FitChannel* channel_of(const LogData& log, Signal signal) {
  for (const FitChannel& c : log.channels)
    if (c.signal == signal) return &c;
  return nullptr;
}

double mean_of_first(const std::vector<double>& x, std::size_t n) {
  double sum = 0;
  long present = 0;
  for (std::size_t k = 0; k < n; ++k)
    if (!std::isnan(x[k])) sum += x[k], ++present;
  return present ? sum / static_cast<double>(present) : 0.0;
}

Traces measured_traces(const LogData& log) {
  Traces traces;
  if (const FitChannel* c = channel_of(log, Signal::spool_position))
    traces.spool = &c->measured, traces.spool_noise = c->noise;
  if (const FitChannel* c = channel_of(log, Signal::piston_position))
    traces.piston = &c->measured, traces.piston_noise = c->noise;
  return traces;
}

Traces traces_of(const Trajectory& run, const LogData& log) {
  Traces traces;
  if (const FitChannel* c = channel_of(log, Signal::spool_position)) traces.spool = &run.signals[c->simulated];
  if (const FitChannel* c = channel_of(log, Signal::piston_position)) traces.piston = &run.signals[c->simulated];
  return traces;
}

PreflightFigures figures_of(const std::vector<double>& time, const Preflight& test, const Traces& traces,
                            const std::vector<double>& monitor_spool) {
  PreflightFigures out;
  std::vector<double> spool;
  if (traces.spool) {
    spool = *traces.spool;
    const double rest = mean_of_first(spool, test.rest);
    for (double& x : spool) x -= rest;
    if (test.step) out.fidelity = fidelity(time, spool, monitor_spool, *test.step, traces.spool_noise);
  }
  for (const Preflight::Sine& sine : test.sines)
    out.correlation.push_back(traces.piston
                                  ? correlation(time, traces.spool ? spool : monitor_spool, *traces.piston, sine,
                                                traces.spool ? traces.spool_noise : 0.0, traces.piston_noise)
                                  : std::nullopt);
  return out;
}

}  // namespace servodx
