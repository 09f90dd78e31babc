// What is known of each valve of a watched folder, as the text that Prometheus' node exporter collects from files.
//
// Metrics are gauges. Of a folder: servodx_valve_verdict (1 for the valve's verdict, 0 for the others),
// servodx_valve_error_ratio (error over threshold: above 1 the log is not healthy), both of the valve's latest log,
// servodx_valve_last_seen_timestamp_seconds, and servodx_logs_set_aside. Source: Prometheus text format 0.0.4.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "fleet/fleet_verdict.h"

namespace servodx {

// "V7_20261125T1200.csv", "in/V7_0031.csv": V7. The file's name without ending, up to an underscore behind which only a
// date, a time or a number stands.
std::string valve_of_log(const std::string& log);

class ValveGauges {
 public:
  struct Reading {
    FleetVerdict verdict = FleetVerdict::none;
    std::string fault;       // label; empty: none is named
    double error_ratio = 0;  // NaN where none is known
    double seen = 0;         // [s] since 1970: when the log was written
  };
  // Of a log; one that is older than what is known of its valve changes nothing.
  void take(const std::string& log, const Reading& reading);
  // What a folder of results holds; no folder is no valve. A log that is gone was seen when its result was written.
  void take_results(const std::string& folder);
  void set_aside(std::size_t logs) { set_aside_ = logs; }
  std::string text() const;

 private:
  std::map<std::string, Reading> valves_;
  std::size_t set_aside_ = 0;
};

// [s] since 1970 of a file's last change; 0 where it is not there.
double time_of_file(const std::string& path);

}  // namespace servodx
