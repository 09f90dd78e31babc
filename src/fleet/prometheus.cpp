#include "fleet/prometheus.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <regex>
#include <system_error>

#include "fleet/fleet_verdict.h"
#include "fleet/gather.h"
#include "fleet/prometheus_text.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;
using prometheus::head, prometheus::label;

}  // namespace

std::string valve_of_log(const std::string& log) {
  static const std::regex counted(R"((.+?)(?:_[0-9][0-9TZ:. -]*)+)");
  const std::string name = fs::path(log).stem().string();
  std::smatch found;
  return std::regex_match(name, found, counted) ? found[1].str() : name;
}

double time_of_file(const std::string& path) {
  std::error_code failed;
  const fs::file_time_type at = fs::last_write_time(path, failed);
  if (failed) return 0;
  return std::chrono::duration<double>(std::chrono::file_clock::to_sys(at).time_since_epoch()).count();
}

void ValveGauges::take(const std::string& log, const Reading& reading) {
  Reading& known = valves_[valve_of_log(log)];
  if (known.verdict == FleetVerdict::none || reading.seen >= known.seen) known = reading;
}

void ValveGauges::take_results(const std::string& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored) || fs::is_empty(folder, ignored)) return;
  const std::atomic<bool> never = false;
  const FleetTable table = gather(folder, never);
  for (const FleetRow& row : table.rows) {
    const double of_log = time_of_file(row.log);
    take(row.log, {row.verdict, row.fault, row.excess(), of_log > 0 ? of_log : time_of_file(folder + "/" + row.file)});
  }
  set_aside(table.refused.size());
}

std::string ValveGauges::text() const {
  std::string out;
  head(out, "servodx_valve_verdict", "1 for the verdict on the valve's latest log, 0 for the others.");
  for (const auto& [valve, r] : valves_)
    for (const FleetVerdict verdict : {FleetVerdict::healthy, FleetVerdict::fault, FleetVerdict::unknown})
      out += fmt::format("servodx_valve_verdict{{valve={},verdict={},fault={}}} {}\n", label(valve),
                         label(word_of(verdict)), label(verdict == FleetVerdict::fault ? r.fault : ""),
                         r.verdict == verdict ? 1 : 0);
  head(out, "servodx_valve_error_ratio", "Error over threshold of the valve's latest log; above 1 it is not healthy.");
  for (const auto& [valve, r] : valves_)
    if (std::isfinite(r.error_ratio))
      out += fmt::format("servodx_valve_error_ratio{{valve={}}} {}\n", label(valve), r.error_ratio);
  head(out, "servodx_valve_last_seen_timestamp_seconds", "When the valve's latest log was written.");
  for (const auto& [valve, r] : valves_)
    out += fmt::format("servodx_valve_last_seen_timestamp_seconds{{valve={}}} {:.3f}\n", label(valve), r.seen);
  head(out, "servodx_logs_set_aside", "Logs that were refused, with their reasons in the folder of the results.");
  out += fmt::format("servodx_logs_set_aside {}\n", set_aside_);
  return out;
}

}  // namespace servodx
