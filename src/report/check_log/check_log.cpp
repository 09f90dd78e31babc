#include "report/check_log/check_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "base/celsius.h"
#include "base/units.h"
#include "fit/identifiability.h"
#include "report/shared/columns.h"
#include "report/shared/conditions.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "report/shared/row_verdict_word.h"
#include "servodx/table.h"
#include "signals/signal.h"

namespace servodx::report {
namespace {

constexpr double seen = 3.0, plain = 8.0;  // deviates from which a fault may show, and shows

// In the unit of the file; of a part of a fact ("% of rated") too.
struct InUnit {
  explicit InUnit(const ChannelSurvey& c) : unit(find_unit(c.unit)) {
    const SignalInfo& signal = info(c.signal);
    if (unit && unit->dimension != signal.dimension && c.full_scale > 0)
      full = c.full_scale;
    else if (!unit || unit->dimension != signal.dimension)
      unit = find_unit(signal.si_unit);
  }
  std::string value(double si) const { return digits(unit->from_si(si / full), 4); }
  std::string difference(double si) const { return digits(si / full / unit->scale(), 2); }
  const Unit* unit;
  double full = 1;  // [SI] what the unit is a part of
};

std::string first_line(const LogSurvey& s) {
  std::string line = fmt::format("{} samples, {} at {} Hz", s.samples, duration(s.duration), digits(s.rate, 4));
  if (s.temperature)
    line += fmt::format(", oil {} degC", digits(0.1 * std::round(10 * (*s.temperature - zero_celsius)), 3));
  line += s.closed_loop ? ", closed loop" : "";
  return line;
}

std::string drive_words(const LogSurvey& s) {
  return fmt::format("spans {}, about {} Hz", handy(s.drive_span, "A"), digits(s.drive_band, 2));
}

std::string word_of(FindingKind kind) {
  switch (kind) {
    case FindingKind::jitter:
      return "jitter";
    case FindingKind::gaps:
      return "gaps";
    case FindingKind::rate:
      return "rate";
    case FindingKind::temperature:
      return "temperature";
    case FindingKind::repeats:
      return "repeats";
    case FindingKind::missing:
      return "missing";
    case FindingKind::saturation:
      return "saturation";
    case FindingKind::quantisation:
      return "quantisation";
    case FindingKind::sign:
      return "sign";
    case FindingKind::swapped:
      return "swapped";
    case FindingKind::response:
      return "response";
    case FindingKind::values:
      return "values";
    case FindingKind::columns:
      return "columns";
    case FindingKind::beyond:
      return "beyond";
    case FindingKind::return_line:
      return "return";
  }
  return "";
}

std::vector<Finding> found_in(const LogSurvey& s, bool notice) {
  std::vector<Finding> out;
  std::copy_if(s.findings.begin(), s.findings.end(), std::back_inserter(out),
               [&](const Finding& f) { return f.notice == notice; });
  return out;
}

std::vector<Finding> notices_in(const LogSurvey& s) { return found_in(s, true); }

// An operating point beyond what is known is one of them.
std::vector<Finding> suspicious_in(const LogSurvey& s) {
  std::vector<Finding> all = found_in(s, false);
  if (const std::string far = beyond_in_words(s.conditions); !far.empty())
    all.push_back({FindingKind::beyond, "recorded beyond what is known: " + far});
  return all;
}

// Each kind once.
std::string kinds_of(const LogSurvey& s) {
  std::vector<std::string> kinds;
  for (const Finding& f : suspicious_in(s))
    if (const std::string kind = word_of(f.kind); std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
      kinds.push_back(kind);
  return join(kinds);
}

// Of many logs, what is easily scrolled past: how many are suspicious, and of what.
std::string summary_of(const std::vector<LogCheck>& checks) {
  std::vector<std::pair<std::string, int>> kinds;
  std::size_t suspicious = 0;
  for (const LogCheck& check : checks) {
    const std::vector<Finding> found = suspicious_in(check.survey);
    suspicious += !found.empty();
    std::set<FindingKind> once;
    for (const Finding& f : found) {
      if (!once.insert(f.kind).second) continue;
      const std::string kind = word_of(f.kind);
      const auto known = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == kind; });
      if (known == kinds.end())
        kinds.emplace_back(kind, 1);
      else
        ++known->second;
    }
  }
  if (suspicious == 0) return fmt::format("nothing suspicious in {} logs", checks.size());
  std::vector<std::string> parts;
  for (const auto& [kind, logs] : kinds) parts.push_back(fmt::format("{} in {}", kind, logs));
  const auto impossible = std::count_if(checks.begin(), checks.end(), [](const LogCheck& check) {
    return std::any_of(check.survey.findings.begin(), check.survey.findings.end(),
                       [](const Finding& f) { return f.impossible; });
  });
  return fmt::format("{} of {} logs have something suspicious: {}", suspicious, checks.size(), join(parts)) +
         (impossible > 0 ? fmt::format("; IMPOSSIBLE in {}", impossible) : "");
}

std::string visibility(double deviate) {
  if (!std::isfinite(deviate)) return "the simulation fails";
  return deviate < seen ? "hidden" : deviate < plain ? "may show" : "shows";
}

std::string verdict_words(const Identifiable& row) {
  if (row.verdict == RowVerdict::flat) return "this log does not show it";
  if (row.verdict == RowVerdict::confounded) return "only together with " + join(row.confounded_with);
  return "";
}

std::pair<long, long> counts(const Promise& p) {
  long known = 0;
  for (const Identifiable& row : p.rows) known += row.verdict == RowVerdict::bounded;
  return {known, static_cast<long>(p.rows.size())};
}

std::string promise_lead(const Promise& p) {
  const auto [known, all] = counts(p);
  return fmt::format(
      "{} of {} free parameters{}", known, all,
      p.error_known ? "" : "; an upper bound: the table is not tuned, so the model's own error is not known");
}

}  // namespace

std::string text_of(const std::vector<LogCheck>& checks) {
  std::string text;
  for (const LogCheck& check : checks) {
    const LogSurvey& s = check.survey;
    if (!text.empty()) text += "\n";
    text += fmt::format("{}: {}\n", s.path, first_line(s));
    Columns channels("lrrrrl", 2);
    channels.row({"signal", "lowest", "highest", "noise", "step", "unit"});
    for (const ChannelSurvey& c : s.channels) {
      const InUnit in(c);
      channels.row({std::string(info(c.signal).name), in.value(c.lowest), in.value(c.highest), in.difference(c.noise),
                    in.difference(c.resolution), std::string(in.unit->name)});
    }
    text += channels.text();
    text += "  drive " + drive_words(s) + "\n";
    if (const std::string at = conditions_in_words(s.conditions); !at.empty()) text += "  at " + at + "\n";
    if (const std::string tuned = tuned_in_words(s.conditions); !tuned.empty()) text += "  tuned at " + tuned + "\n";
    const std::string far = beyond_in_words(s.conditions);
    if (!far.empty()) text += "  BEYOND: " + far + "\n";
    const std::vector<Finding> suspicious = found_in(s, false);
    for (const Finding& f : suspicious)
      text += fmt::format("  {}: {}: {}\n", f.impossible ? "IMPOSSIBLE" : "suspicious", word_of(f.kind), f.text);
    for (const Finding& f : notices_in(s)) text += fmt::format("  note: {}\n", f.text);
    if (suspicious.empty()) text += far.empty() ? "  nothing suspicious\n" : "  nothing else suspicious\n";
    if (!check.promise) continue;
    text += "  can identify " + promise_lead(*check.promise) + "\n";
    Columns rows("lrrll", 4);
    for (const Identifiable& r : check.promise->rows) {
      const HandyUnit unit = handy_unit(r.unit, r.nominal);
      rows.row({r.name, digits(r.nominal * unit.factor),
                std::isfinite(r.std_error) ? "+- " + digits(r.std_error * unit.factor, 2) : "", unit.name,
                verdict_words(r)});
    }
    text += rows.text() + "  can show (deviates; below 3 stays hidden)\n";
    Columns faults("lrrrr", 4);
    faults.row({"fault", "at", "", "at", ""});
    for (const Visible& v : check.promise->faults)
      faults.row({v.fault, handy(v.least, v.unit), digits(v.deviates_at_least, 2), handy(v.typical, v.unit),
                  digits(v.deviates_at_typical, 2)});
    text += faults.text();
  }
  if (checks.size() > 1) text += "\n" + summary_of(checks) + "\n";
  return text;
}

Json check_log_json(const std::vector<LogCheck>& checks) {
  Json logs = Json::array();
  for (const LogCheck& check : checks) {
    const LogSurvey& s = check.survey;
    Json channels = Json::array(), findings = Json::array(), notices = Json::array();
    for (const ChannelSurvey& c : s.channels)
      channels.push_back({{"signal", info(c.signal).name},
                          {"column", c.column},
                          {"unit", info(c.signal).si_unit},
                          {"unit_in_file", c.unit},
                          {"missing", c.missing},
                          {"lowest", number(c.lowest)},
                          {"highest", number(c.highest)},
                          {"noise_rms", number(c.noise)},
                          {"resolution", number(c.resolution)},
                          {"clipped", number(c.clipped)}});
    for (const Finding& f : suspicious_in(s)) findings.push_back({{"kind", word_of(f.kind)}, {"text", f.text}});
    for (const Finding& f : notices_in(s)) notices.push_back(f.text);
    Json one = {{"log", s.path},
                {"samples", s.samples},
                {"duration", number(s.duration)},
                {"rate", number(s.rate)},
                {"jitter", number(s.jitter)},
                {"gaps", s.gaps},
                {"lost_samples", s.lost},
                {"longest_gap", number(s.longest_gap)},
                {"temperature", s.temperature ? number(*s.temperature) : Json(nullptr)},
                {"drive_span", number(s.drive_span)},
                {"drive_band", number(s.drive_band)},
                {"operating_point", conditions_json(s.conditions)},
                {"closed_loop", s.closed_loop},
                {"channels", channels},
                {"suspicious", findings},
                {"notices", notices}};
    if (check.promise) {
      Json rows = Json::array(), faults = Json::array();
      for (const Identifiable& r : check.promise->rows)
        rows.push_back({{"name", r.name},
                        {"unit", r.unit},
                        {"verdict", word_of(r.verdict)},
                        {"nominal", number(r.nominal)},
                        {"std_error", number(r.std_error)},
                        {"confounded_with", r.confounded_with}});
      for (const Visible& v : check.promise->faults)
        faults.push_back({{"fault", v.fault},
                          {"unit", v.unit},
                          {"least", number(v.least)},
                          {"deviate_at_least", number(v.deviates_at_least)},
                          {"typical", number(v.typical)},
                          {"deviate_at_typical", number(v.deviates_at_typical)}});
      one["identifiable"] = rows;
      one["visible_faults"] = faults;
      one["model_error_known"] = check.promise->error_known;
    }
    logs.push_back(one);
  }
  return {{"logs", logs}};
}

void add_visible(Page& page, const std::vector<Visible>& faults) {
  Bars bars{"Faults, each at the mildest that is called one and at typical size",
            "fault",
            "sigmas",
            {},
            Mark{seen, "may show"},
            20.0};
  for (const Visible& f : faults)
    for (const auto& [size, deviate] :
         {std::pair(f.least, f.deviates_at_least), std::pair(f.typical, f.deviates_at_typical)})
      bars.rows.push_back({words(f.fault) + ", " + handy(size, f.unit), deviate, digits(deviate, 2),
                           visibility(deviate),
                           deviate >= plain  ? Tone::good
                           : deviate >= seen ? Tone::doubt
                                             : Tone::plain,
                           ""});
  page.add(bars);
}

Page check_log_page(const Header& header, const std::vector<LogCheck>& checks) {
  std::size_t suspicious = 0;
  for (const LogCheck& c : checks) suspicious += !suspicious_in(c.survey).empty();
  const bool one = checks.size() == 1;
  Page page(header,
            one ? "Check of " + file_name(checks.front().survey.path) : fmt::format("Check of {} logs", checks.size()));
  Verdict v;
  v.tone = suspicious > 0 ? Tone::doubt : Tone::good;
  if (one) {
    const LogSurvey& s = checks.front().survey;
    v.headline = suspicious == 0 ? "Nothing suspicious in " + file_name(s.path)
                                 : "Suspicious in " + file_name(s.path) + ": " + kinds_of(s);
    v.detail = first_line(s);
    for (const Finding& f : suspicious_in(s)) v.reasons.push_back(word_of(f.kind) + ": " + f.text);
  } else {
    v.headline = suspicious == 0 ? fmt::format("Nothing suspicious in {} logs", checks.size())
                                 : fmt::format("{} of {} logs have something suspicious", suspicious, checks.size());
  }
  page.verdict(v);
  if (!one) {
    page.section("All logs");
    TablePart table{"Logs", "lrrrl", {"log", "lasts [s]", "rate [Hz]", "oil [degC]", "suspicious"}, {}, 0};
    for (const LogCheck& c : checks) {
      const LogSurvey& s = c.survey;
      table.rows.push_back(
          {s.path, Cell(digits(s.duration), s.duration), Cell(digits(s.rate, 4), s.rate),
           s.temperature ? Cell(digits(*s.temperature - zero_celsius), *s.temperature - zero_celsius) : Cell(""),
           suspicious_in(s).empty() ? "nothing" : kinds_of(s)});
    }
    page.add(table);
  }
  for (const LogCheck& check : checks) {
    const LogSurvey& s = check.survey;
    page.section(one ? "What is in it" : s.path, one ? "" : first_line(s), !one && suspicious_in(s).empty());
    if (!one)
      for (const Finding& f : suspicious_in(s)) page.text(word_of(f.kind) + ": " + f.text);
    for (const Finding& f : notices_in(s)) page.text(f.text);
    Plot drive{.title = "drive [mA], " + drive_words(s),
               .x_label = "time [s]",
               .x = check.time,
               .group = s.path,
               .low = true,
               .most_rows = 4000};
    drive.series.push_back({"drive", check.drive, Role::input});
    for (double& value : drive.series.front().y) value *= 1e3;
    page.add(drive);
    add_conditions(page, s.conditions);
    TablePart table{
        "Signals", "llrrrrrl", {"signal", "column", "lowest", "highest", "noise", "step", "missing", "unit"}, {}, 0};
    for (const ChannelSurvey& c : s.channels) {
      const InUnit in(c);
      table.rows.push_back({words(std::string(info(c.signal).name)), c.column, in.value(c.lowest), in.value(c.highest),
                            in.difference(c.noise), in.difference(c.resolution), std::to_string(c.missing),
                            std::string(in.unit->name)});
    }
    page.add(table);
    if (!check.promise) {
      page.text("With --params TABLE it also says which parameters and faults this log can show.");
      continue;
    }
    add_visible(page, check.promise->faults);
    TablePart rows{"Which parameters it can show: " + promise_lead(*check.promise),
                   "lrrll",
                   {"parameter", "value", "std. error", "unit", ""},
                   {},
                   0};
    for (const Identifiable& r : check.promise->rows) {
      const HandyUnit unit = handy_unit(r.unit, r.nominal);
      rows.rows.push_back(
          {words(r.name), Cell(digits(r.nominal * unit.factor), r.nominal),
           std::isfinite(r.std_error) ? Cell(digits(r.std_error * unit.factor, 2), r.std_error) : Cell(""), unit.name,
           words(verdict_words(r))});
    }
    page.add(rows);
  }
  return page;
}

}  // namespace servodx::report
