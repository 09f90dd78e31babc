// The front door of `monitor`.
#include <cmath>
#include <memory>

#include "base/require_setting.h"
#include "fit/log_data.h"
#include "prognose/checks.h"
#include "prognose/monitor.h"
#include "servodx/log.h"
#include "servodx/monitor.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {

struct LogMonitor::Inside {
  Log log;
  LogData data;
  MonitorParameters parameters;
  PressureLaw law;
  bool closed = false;
};

void MonitorOptions::validate() const {
  require_pressure_law(model);
  require_setting(!loop_gain || (std::isfinite(*loop_gain) && *loop_gain > 0), "--loop-gain",
                  "a loop's gain lies above nought",
                  "give it such as \"1.8 mA/mm\", or leave it away: the measured current drives the monitor");
}

LogMonitor::LogMonitor(const Log& log, const Table& table, const Rig& rig, const MonitorOptions& options) {
  options.validate();
  Inside in{log, prepare(log, rig), {}, {}, options.loop_gain.has_value()};
  const Supply at = supply_of(in.data, table);
  in.parameters = monitor_parameters(table, at);
  in.law = pressure_law(options.model, table, at);
  require_setting(!in.closed || log.has(Signal::setpoint), "--loop-gain",
                  "the log has no 'setpoint' to close the loop on",
                  "leave it away: the measured current drives the monitor");
  if (in.closed) in.parameters.control_gain = *options.loop_gain;
  inside_ = std::make_shared<Inside>(std::move(in));
}

const MonitorParameters& LogMonitor::parameters() const { return inside_->parameters; }
const std::vector<Note>& LogMonitor::notes() const { return inside_->data.notes; }

MonitorRun LogMonitor::run() const {
  const Inside& in = *inside_;
  return in.closed ? run_monitor_loop(in.parameters, in.law, in.data, in.log[Signal::setpoint])
                   : run_monitor(in.parameters, in.law, in.data);
}

std::optional<MonitorError> LogMonitor::error_of(const MonitorRun& run) const {
  const Log& log = inside_->log;
  if (!log.has(Signal::spool_position)) return {};
  const MeanError e = mean_error(log.time, log[Signal::spool_position], run.spool);
  return MonitorError{e.figure.value, e.figure.std_error, e.settled_at, e.settled};
}

}  // namespace servodx
