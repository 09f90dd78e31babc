#include "report/watch/watch_events.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "faults/gross_finding.h"
#include "online/constants.h"
#include "report/diagnose/diagnosis_json.h"
#include "report/diagnose/diagnosis_text.h"
#include "report/diagnose/verdict_words.h"
#include "report/shared/text_options.h"
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

// The coil current beside its command is the driver's.
std::string source_of(Signal signal) {
  return signal == Signal::coil_current ? "driver" : std::string(name_of(signal));
}

// What needs no model is seen over a window of its own, whose start says nothing of when it began.
std::string alarm_in_words(const WatchEvent& e, const std::string& name) {
  if (e.gross != GrossFinding::none) return fmt::format("{}: looks like {}", report::word_of(e.gross), name);
  if (e.supply)
    return fmt::format("supply_pressure {:.3g} bar from its healthy level: looks like {}", e.level * 1e-5, name);
  return fmt::format("{} {:.3g} times its limit: looks like {}, since {:.3f} s", e.signal ? source_of(*e.signal) : "",
                     e.level / e.limit, name, e.onset);
}

}  // namespace

std::string text_of(const WatchEvent& e) {
  const std::string name = e.name.empty() ? "no fault of the list" : e.name;
  switch (e.kind) {
    case WatchEventKind::alarm:
      return fmt::format("{:.3f} s: ALARM, {}", e.time, alarm_in_words(e, name));
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
  if (e.gross != GrossFinding::none) out["seen"] = report::word_of(e.gross);
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

std::string text_of(const WindowDiagnosis& d) {
  if (!d.verdict) return "no diagnosis: " + d.refused;
  const std::string words = text_of(*d.verdict, {.colour = false, .written_to = ""});
  return words.substr(0, words.find('\n'));
}

Json to_json(const WindowDiagnosis& d) {
  Json out{{"number", d.number}, {"event", "diagnosis"}};
  if (d.verdict)
    out["result"] = to_json(*d.verdict);
  else
    out["refused"] = d.refused;
  return out;
}

std::string text_of(const WatchSummary& s) {
  return fmt::format("watched {:.1f} s of {}: {} alarm{}; {} samples, {} late, {} repeated, {} lines passed over\n",
                     s.seconds, s.source, s.alarms, s.alarms == 1 ? "" : "s", s.samples.taken, s.samples.late,
                     s.samples.repeated, s.bad_lines);
}

Json to_json(const WatchSummary& s) {
  return {{"source", s.source},
          {"alarms", s.alarms},
          {"seconds_of_log", s.seconds},
          {"samples",
           {{"taken", s.samples.taken},
            {"late", s.samples.late},
            {"repeated", s.samples.repeated},
            {"bad_lines", s.bad_lines}}}};
}

}  // namespace servodx::report
