// Figures of the records of a log, without the model: is the supply what it was, does the driver pass on what the
// command asks, does each sensor scatter as it did.
//
// A figure is positive and 1 or so in health; healthy logs' logarithms of it scatter. It is compared with theirs and
// with nothing of the model's, so that a fault of an input or of a sensor is not taken for one of the valve.
#pragma once
#include <optional>
#include <vector>

#include "faults/record.h"
#include "fit/log_data.h"
#include "parameters/table.h"
#include "signals/log.h"
#include "signals/signal.h"
#include "simulate/scenario.h"

namespace servodx {

enum class FigureKind {
  supply_level,   // [Pa] supply pressure at no flow, of the first part of the log
  supply_step,    // of that level: the level at the end, from the time on at which it parts most
  supply_left,    // of that level: what is left of it at the flow of the widest opening
  driver_gain,    // current over command
  driver_offset,  // 1 + mean current at no command, of rated current
  driver_left,    // current that the command does not account for, over the command, in the worst eighth of the log
  sensor_noise,   // [SI] of the signal, in the noisier half of the log
};
inline constexpr int n_figure_kinds = 7;

struct RecordFigure {
  FigureKind kind = FigureKind::supply_level;
  Signal signal = Signal::supply_pressure;
  double value = 1;
  std::optional<double> since = {};   // [s] of a step: when
  double error = 0;                   // of its logarithm, one standard deviation: what the log itself leaves open
  std::optional<double> before = {};  // the best that a part of the log has: what it was ahead of `since`
};

// Of what the log records, in the order of the kinds; what it cannot tell is left out.
std::vector<RecordFigure> record_figures(const Log& log, const LogData& data, const ParameterVector& base);
// Of the driver alone: they need nothing of the valve.
std::vector<RecordFigure> driver_figures(const Log& log, const LogData& data);

Record record_of(FigureKind kind);

}  // namespace servodx
