// How much faster than real time the monitor runs beside a flight, with each pressure law, on one core.
#include <cmath>
#include <cstdio>
#include <ctime>

#include "fit/log_data.h"
#include "prognose/monitor.h"
#include "prognosis/study.h"
#include "rig/rig_run.h"
#include "servodx/monitor.h"
#include "valve_maps/registry.h"

namespace servodx::study {

void speed(const Bench& b) {
  rig::RigRun run;
  run.excitation = "flight", run.duration = 20;
  const LogData log = prepare(test_log(b.model, "", 0, {}, run), b.rig);
  const Supply at = supply_of(log, b.tuned);
  const MonitorParameters parameters = monitor_parameters(b.tuned, at);
  std::printf("monitor beside %g s of flight at %zu Hz, one core:\n", run.duration, static_cast<std::size_t>(run.rate));
  for (const valve_maps::MapInfo& map : valve_maps::map_list()) {
    const PressureLaw law = pressure_law(map.name, b.tuned, at);
    long runs = 0;
    double check_sum = 0;
    const std::clock_t from = std::clock();
    const auto spent = [&] { return static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC; };
    for (; runs < 3 || spent() < 0.5; ++runs) check_sum += run_monitor(parameters, law, log).spool.back();
    std::printf("  %-8s %8.0f times real time%s\n", map.name.c_str(),
                static_cast<double>(runs) * run.duration / spent(), std::isfinite(check_sum) ? "" : " (not finite)");
  }
}

}  // namespace servodx::study
