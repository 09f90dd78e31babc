// Monitor: the light model of Borello, Dalla Vedova, Jacazio & Sorli, "A Prognostic Model for Electrohydraulic
// Servovalves" (PHM Society 2009), Fig. 5, beside a log: a linear servovalve and actuator with limits.
// docs/prognosis.md.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {

// In the paper's names. Forces stand for its torques, at the nozzle axis.
struct MonitorParameters {
  double motor_gain = 0;         // GM [N/A]
  double wire_stiffness = 0;     // KSF [N/m] feedback wire, with the flow force that the nozzles must balance
  double spool_force_gain = 0;   // [N/N] force on the flapper that holds a force on the spool
  double flapper_stiffness = 0;  // KFt [N/m] flexure and wire
  double flapper_limit = 0;      // XFM [m]
  double first_stage_gain = 0;   // GQF / ASV [1/s] spool speed over flapper travel
  double spool_limit = 0;        // XSM [m]
  double pressure_gain = 0;      // GP [Pa/m]
  double flow_gain = 0;          // GQ [m2/s]
  double pressure_limit = 0;     // PSR [Pa] supply less return
  double piston_area = 0;        // AJ [m2]
  double viscous = 0;            // CJ [N s/m]
  double mass = 0;               // MJ [kg]
  double piston_limit = 0;       // XJM [m]
  double null_current = 0;       // [A] added to the command
  double control_gain = 0;       // GAP [A/m]; 0: open loop, driven by the measured current
};

struct MonitorRun {
  std::vector<double> spool, piston, pressure;  // [m], [m], [Pa] at the log's samples
};

// Mean size of the measured spool less the monitor's: the paper's |e|.
struct MonitorError {
  double value = 0, std_error = 0;  // [m]
  double settled_at = 0;            // [s] from here on the running mean stays within 10 % of its end
  bool settled = false;             // that is in the first half, and the standard error is below 10 %
};

struct MonitorOptions {
  std::string model = "linear";  // pressure model in place of GP: `servodx list models`
  // [A/m] closes the position loop on the log's setpoint; empty: the measured current drives it.
  std::optional<double> loop_gain = {};

  // Throws InputError that names the option, as the program calls it.
  void validate() const;
};

// The monitor of a table at a log's supply, return and oil. Copies are the same one.
class LogMonitor {
 public:
  // `table`: facts of `rig` are in it (servodx/data_sheet.h). Throws InputError for a model that is not there, and
  // where a loop is to be closed on a log without a setpoint.
  LogMonitor(const Log& log, const Table& table, const Rig& rig, const MonitorOptions& options = {});

  const MonitorParameters& parameters() const;
  MonitorRun run() const;
  // None where the log does not measure the spool.
  std::optional<MonitorError> error_of(const MonitorRun& run) const;
  const std::vector<Note>& notes() const;  // of the log, made ready

 private:
  struct Inside;
  std::shared_ptr<const Inside> inside_;
};

}  // namespace servodx
