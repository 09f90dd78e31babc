// The monitor of Borello et al. 2009, Fig. 5: a linear servovalve and actuator with limits on flapper, spool, pressure
// and piston, light enough to run in a controller. Its spool position, driven by the measured current, is what a
// healthy valve would do; the prognostic checks compare the measured one with it.
//
// Stepping: the spool under a held current is solved exactly (slewing at the flapper's limit, then an exponential). The
// pressure against the flow has a pole of a few microseconds, so the piston's speed and P12 are solved together,
// implicitly (backward Euler), whatever the pressure law. Any step is stable; the piston's error is first order.
// Leaves out, as the figure does: friction, lap, backlash, hysteresis, the first stage's mass, oil compressibility.
//
// Its parameters follow from a tuned 41-row table at a log's supply, return and oil (docs/prognosis.md). Forces stand
// for the paper's torques, both at the nozzle axis.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fit/log_data.h"
#include "model/state.h"
#include "servodx/monitor.h"
#include "servodx/table.h"

namespace servodx {

struct Supply {
  double supply = 0, return_ = 0;  // [Pa]
  Oil oil;
  double rated_current = 0.02;  // [A]
};
// Means over the log; what it lacks is the table's.
Supply supply_of(const LogData& log, const Table& table);

MonitorParameters monitor_parameters(const Table& table, const Supply& at);

// P12 [Pa] from spool position [m] and actuator flow [m3/s]; must not rise with the flow.
using PressureLaw = std::function<double(double spool, double flow)>;
PressureLaw linear_pressure(const MonitorParameters& p);  // GP XS - GP/GQ QJ within +-PSR
void require_pressure_law(const std::string& name);       // throws InputError for one that is not there
// A valve map (`servodx list models`) in place of GP; the figure's limit +-PSR stays on those that have none. Throws
// InputError for an unknown name.
PressureLaw pressure_law(const std::string& name, const Table& table, const Supply& at);

class Monitor {
 public:
  Monitor(const MonitorParameters& parameters, PressureLaw law);

  void start(double spool, double piston);
  // Holds the current [A] and the load [N] (positive opposes extension) over h [s].
  void step(double current, double load, double h);
  double demand(double setpoint) const { return p_.control_gain * (setpoint - piston_); }  // Cor = GAP Err [A]

  double spool() const { return spool_; }        // XS [m]
  double piston() const { return piston_; }      // XJ [m]
  double speed() const { return speed_; }        // DXJ [m/s]
  double pressure() const { return pressure_; }  // P12 [Pa]

 private:
  MonitorParameters p_;
  PressureLaw law_;
  double spool_ = 0, piston_ = 0, speed_ = 0, pressure_ = 0;
};

// Driven by the log's current. With `rest` [A], the current that held the spool at its null before a preflight check,
// that current is taken off, and with it every offset: the run then starts from zero.
MonitorRun run_monitor(const MonitorParameters& parameters, const PressureLaw& law, const LogData& log,
                       std::optional<double> rest = {});
// The loop closed by `control_gain` on a position demand [m], one a sample.
MonitorRun run_monitor_loop(const MonitorParameters& parameters, const PressureLaw& law, const LogData& log,
                            const std::vector<double>& setpoint);

}  // namespace servodx
