#include "report/watch/watch_events.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "faults/gross_finding.h"
#include "online/constants.h"
#include "servodx/log.h"

namespace servodx::report {
namespace {

std::string word_of(WatchEventKind kind) {
  switch (kind) {
    case WatchEventKind::alarm:
      return "alarm";
    case WatchEventKind::named:
      return "named";
    case WatchEventKind::window:
      return "window";
    case WatchEventKind::cleared:
      return "cleared";
    case WatchEventKind::restart:
      return "restart";
  }
  return "";
}

std::string word_of(GrossFinding gross) {
  switch (gross) {
    case GrossFinding::spool_on_both_stops:
      return "spool_on_both_stops";
    case GrossFinding::spool_on_one_stop:
      return "spool_on_one_stop";
    case GrossFinding::no_response:
      return "no_response";
    case GrossFinding::none:
      break;
  }
  return "";
}

// The coil current beside its command is the driver's.
std::string source_of(Signal signal) {
  return signal == Signal::coil_current ? "driver" : std::string(name_of(signal));
}

std::string what_alarmed(const WatchEvent& e) {
  if (e.gross != GrossFinding::none) return word_of(e.gross);
  if (e.supply) return fmt::format("supply_pressure {:.3g} bar from its healthy level", e.level * 1e-5);
  return fmt::format("{} {:.3g} times its limit", e.signal ? source_of(*e.signal) : "", e.level / e.limit);
}

}  // namespace

std::string text_of(const WatchEvent& e) {
  const std::string name = e.name.empty() ? "no fault of the list" : e.name;
  switch (e.kind) {
    case WatchEventKind::alarm:
      return fmt::format("{:.3f} s: ALARM, {}: looks like {}, since {:.3f} s", e.time, what_alarmed(e), name, e.onset);
    case WatchEventKind::named:
      return fmt::format("{:.3f} s: now looks like {}", e.time, name);
    case WatchEventKind::cleared:
      return fmt::format("{:.3f} s: as healthy again", e.time);
    case WatchEventKind::restart:
      return fmt::format("{:.3f} s: the simulation begins anew", e.time);
    case WatchEventKind::window:
      break;
  }
  return "";
}

Json to_json(const WatchEvent& e) {
  Json out{{"number", e.number}, {"event", word_of(e.kind)}, {"time", e.time}, {"told_at", e.told_at}};
  if (e.kind == WatchEventKind::cleared || e.kind == WatchEventKind::restart) return out;
  out["onset_time"] = e.onset;
  out["fault"] = e.name.empty() ? Json() : Json(e.name);
  if (e.signal) {
    out["signal"] = source_of(*e.signal);
    out["window"] = e.window, out["level"] = e.level, out["limit"] = e.limit;
  }
  if (e.gross != GrossFinding::none) out["seen"] = word_of(e.gross);
  if (e.supply) out["seen"] = "supply_out_of_band";
  return out;
}

Json to_json(const WatchLimits& limits) {
  Json out{{"alarms_per_hour", limits.alarms_per_hour},
           {"healthy_logs", limits.logs},
           {"healthy_seconds", limits.healthy_seconds},
           {"windows", online_constants::windows},
           {"limits", Json::array()}};
  for (const auto& [signal, c] : limits.channels)
    out["limits"].push_back({{"signal", name_of(signal)}, {"limit", c.limit}, {"healthy", c.healthy}});
  if (const auto& s = limits.supply)
    out["supply"] = {{"level", s->level}, {"limit", s->limit}, {"healthy", s->healthy}, {"unit", "Pa"}};
  return out;
}

}  // namespace servodx::report
