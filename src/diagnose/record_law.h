// Which figures of a log's records are beyond what healthy logs show.
//
// A figure's logarithm is taken as normal among healthy logs, with a prior spread that counts as so many logs
// (evidence/log_scatter.h); the rate is an assumption, shared by all figures of the log (Bonferroni). Fewer than three
// healthy logs with the figure say nothing.
#pragma once
#include <optional>
#include <vector>

#include "diagnose/broken_sensors.h"
#include "diagnose/record_figures.h"
#include "faults/fault.h"
#include "servodx/log.h"

namespace servodx {

struct RecordFinding {
  const Fault* fault = nullptr;
  std::optional<FigureKind> figure;     // else
  std::optional<SensorFinding> broken;  // one of the two
  Signal signal = Signal::supply_pressure;
  double value = 0, usual = 0;                // [as the figure]; usual: the healthy logs' mean
  double severity = 0, lower = 0, upper = 0;  // value over usual, 95 %; NaN: the figure is no size of the fault
  double chance = 0;                          // that a healthy log's figure is as far off
  std::optional<double> since = {};           // [s]
};

// `healthy`: figures of each healthy log. `rate`: of false alarms, for all figures together. The least chance first;
// broken sensors before all.
std::vector<RecordFinding> record_findings(const std::vector<RecordFigure>& figures,
                                           const std::vector<BrokenSensor>& broken,
                                           const std::vector<std::vector<RecordFigure>>& healthy, double rate);

}  // namespace servodx
