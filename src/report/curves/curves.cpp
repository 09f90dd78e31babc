#include "report/curves/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/units.h"
#include "curves/constants.h"
#include "curves/frequency_response.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/line_chart.h"
#include "servodx/curves.h"

namespace servodx::report {
namespace {

using curves::Figure;
using curves::Judgement;
using curves::Remark;
using curves::Sheet;

Json numbers(const std::vector<double>& values) {
  Json array = Json::array();
  for (double v : values) array.push_back(number(v));
  return array;
}
const char* key_of(Judgement judgement) {
  constexpr const char* keys[] = {"not_judged", "pass", "too_near", "fail"};
  return keys[static_cast<std::size_t>(judgement)];
}
const char* key_of(AcceptanceSheet::Kind verdict) {
  switch (verdict) {
    case AcceptanceSheet::Kind::pass:
      return "pass";
    case AcceptanceSheet::Kind::fail:
      return "fail";
    case AcceptanceSheet::Kind::not_judged:
      return "not_judged";
    case AcceptanceSheet::Kind::incomplete:
      return "incomplete";
  }
  return "";
}
Json bound(const std::optional<double>& b) { return b ? Json(*b) : Json(nullptr); }

}  // namespace

std::string readable(const Figure& f, double value, int significant) {
  if (f.unit == "-")
    return digits(100 * value, std::min(significant, 3)) + (f.name == "symmetry" ? " %" : " % of rated");
  if (f.unit == "1/%") return digits(100 * value, std::min(significant, 3)) + " % of supply per 1 %";
  if (f.unit == "m3/s") return digits(find_unit("l/min")->from_si(value), significant) + " l/min";
  if (f.unit == "m3/s/A") return digits(value * 6e4 * 1e-3, significant) + " l/min/mA";
  if (f.unit == "m") return digits(value * 1e3, significant) + " mm";
  return digits(value, significant) + " " + f.unit;
}

std::string limit_text(const Figure& f) {
  if (!f.limit) return "";
  const auto side = [&](const char* word, const std::optional<double>& bound) {
    return bound ? word + readable(f, *bound) : std::string();
  };
  const std::string low = side("at least ", f.limit->min), high = side("at most ", f.limit->max);
  return low + (low.empty() || high.empty() ? "" : ", ") + high;
}

std::string value_text(const Figure& f) {
  if (!std::isfinite(f.value)) return "-";
  constexpr double rounding = 1e-3;  // of the uncertainty: less is what arithmetic leaves of zero
  return readable(f, std::fabs(f.value) < rounding * f.uncertainty ? 0.0 : f.value);
}

std::string uncertainty_text(const Figure& f) {
  return std::isfinite(f.uncertainty) ? readable(f, f.uncertainty, 2) : "";
}

std::string word_of(Judgement judgement) {
  switch (judgement) {
    case Judgement::not_judged:
      return "";
    case Judgement::pass:
      return "pass";
    case Judgement::too_near:
      return "NO PASS, too near";
    case Judgement::fail:
      return "FAIL";
  }
  return "";
}

std::string judgement_of(const Figure& f) {
  return f.limit && f.judgement == Judgement::not_judged ? "not judged" : word_of(f.judgement);
}

std::string word_of(AcceptanceSheet::Kind verdict) {
  switch (verdict) {
    case AcceptanceSheet::Kind::pass:
      return "PASS";
    case AcceptanceSheet::Kind::fail:
      return "FAIL";
    case AcceptanceSheet::Kind::not_judged:
      return "NOT JUDGED";
    case AcceptanceSheet::Kind::incomplete:
      return "INCOMPLETE";
  }
  return "";
}

std::string limits_in_words(const Sheet& sheet) {
  const auto count = [&](Judgement judgement) {
    return static_cast<std::size_t>(std::count_if(sheet.figures.begin(), sheet.figures.end(),
                                                  [&](const Figure& f) { return f.judgement == judgement; }));
  };
  const std::size_t failed = count(Judgement::fail), near = count(Judgement::too_near), kept = count(Judgement::pass);
  const std::size_t hidden = curves::unjudged_limits(sheet.figures).size(), limits = failed + near + kept + hidden;
  const std::string rest = hidden > 0 ? fmt::format("; {} not shown by this log", hidden) : "";
  if (limits == 0) return "the rig file gives no limit for its figures";
  if (failed > 0) return fmt::format("{} of {} limits {} broken", failed, limits, failed == 1 ? "is" : "are") + rest;
  if (near > 0)
    return fmt::format("{} of {} figures {} nearer to the limit than the guard band", near, limits,
                       near == 1 ? "is" : "are") +
           rest;
  if (hidden > 0) return fmt::format("{} of {} limits kept", kept, limits) + rest;
  return fmt::format("All {} limits are kept", limits);
}

std::string words_of(const Remark& remark) {
  switch (remark.kind) {
    case Remark::Kind::none:
      return "";
    case Remark::Kind::too_fast:
      return fmt::format(
          "cannot be determined: the command sweeps {:.2g} times rated current a second, at most {:.2g} is slow enough",
          remark.first, curves_constants::fastest);
    case Remark::Kind::one_way:
      return "cannot be determined: the command sweeps one way only";
    case Remark::Kind::coarse_readings:
      return fmt::format("cannot be determined: the readings resolve {:.2g} % of rated current", 100 * remark.first);
    case Remark::Kind::short_command:
      return fmt::format("the command reaches {:.3g} to {:.3g} % of rated", remark.first, remark.second);
    case Remark::Kind::coarse_command:
      return fmt::format(
          "cannot be determined: the command's steps are {:.2g} % of rated, and the gain is at least {:.3g} % of "
          "supply per 1 %",
          remark.first, 100 * remark.second);
    case Remark::Kind::not_reached:
      return fmt::format("not reached: the log shows up to {:.3g} Hz", remark.first);
    case Remark::Kind::not_shown:
      return "not shown by this log";
    case Remark::Kind::mean_of_reversals:
      return fmt::format("mean of {:.0f} reversals, resolved to {:.2g} % of rated", remark.first, 100 * remark.second);
    case Remark::Kind::brought_to_rated_drop:
      return fmt::format("from a drop of {:.4g} bar to the rated {:.4g} bar", remark.first * 1e-5,
                         remark.second * 1e-5);
    case Remark::Kind::of_largest_pressure:
      return "supply unknown: of the largest load pressure";
    case Remark::Kind::positive_is_overlap:
      return "positive is overlap";
    case Remark::Kind::pilot_stage_included:
      return "pilot stage included";
    case Remark::Kind::least_of_sweep:
      return "least of the sweep; with the edges' leakage at its end";
    case Remark::Kind::at_half_height:
      return "at half height of the peak";
    case Remark::Kind::at_rated_current:
      return "at rated current";
  }
  return "";
}

std::string guard_words(double guard) {
  if (!(guard > 0)) return "a figure passes where it is inside its limit; on the limit it does not (simple acceptance)";
  return fmt::format(
      "a figure passes where it is inside its limit by more than {}its expanded uncertainty (k = 2), the guard band; "
      "on "
      "the limit it does not",
      guard == 1 ? "" : digits(guard) + " times ");
}

std::string text_of(const Sheet& sheet, const std::string& log, bool colour) {
  using Kind = AcceptanceSheet::Kind;
  const bool pass = sheet.verdict == Kind::pass, judged = sheet.verdict != Kind::not_judged;
  const bool hidden = !curves::unjudged_limits(sheet.figures).empty();
  std::string verdict = judged || hidden ? word_of(sheet.verdict) : "no limits given";
  if (colour && judged)
    verdict = fmt::format("\033[1;{}m{}\033[0m", pass ? "32" : sheet.verdict == Kind::fail ? "31" : "33", verdict);
  if (hidden) verdict += ", " + limits_in_words(sheet);
  Columns table("lllllll", 2);
  table.row({"figure", "value", "+- (k = 2)", "limit", "", "from", ""});
  for (const Figure& f : sheet.figures)
    table.row(
        {f.name, value_text(f), uncertainty_text(f), limit_text(f), judgement_of(f), f.signal, words_of(f.remark)});
  return log + ": " + verdict + "\n" + table.text();
}

Json curves_json(const Sheet& sheet) {
  Json figures = Json::array(), sweeps = Json::array(), response = Json::array();
  for (const Figure& f : sheet.figures)
    figures.push_back(
        {{"name", f.name},
         {"signal", f.signal},
         {"value", number(f.value)},
         {"unit", f.unit},
         {"limit", f.limit ? Json{{"min", bound(f.limit->min)}, {"max", bound(f.limit->max)}} : Json(nullptr)},
         {"pass", f.pass() ? Json(*f.pass()) : Json(nullptr)},
         {"uncertainty", number(f.uncertainty)},
         {"judgement", key_of(f.judgement)},
         {"note", words_of(f.remark)}});
  for (const curves::SweepCurve& c : sheet.curves)
    sweeps.push_back({{"signal", info(c.signal).name},
                      {"unit", info(c.signal).si_unit},
                      {"current", numbers(c.current)},
                      {"up", numbers(c.up)},
                      {"down", numbers(c.down)}});
  for (const curves::ResponsePoint& p : sheet.response)
    response.push_back(
        {{"frequency", p.frequency}, {"amplitude", p.gain}, {"phase", p.phase}, {"coherence", p.coherence}});
  return {{"verdict", key_of(sheet.verdict)},
          {"figures", figures},
          {"curves", sweeps},
          {"bode", {{"signal", sheet.response_signal}, {"points", response}}}};
}

std::string curves_svg(const Sheet& sheet, double rated_current) {
  std::vector<ChartPanel> panels;
  for (const curves::SweepCurve& c : sheet.curves) {
    const std::string si(info(c.signal).si_unit);
    const std::string unit = si == "m3/s" ? "l/min" : si == "Pa" ? "bar" : si == "m" ? "mm" : si;
    ChartPanel panel{std::string(info(c.signal).name),
                     "current [% of rated]",
                     fmt::format("{} [{}]", info(c.signal).name, unit),
                     {},
                     {0, 0},
                     {0, 0},
                     false};
    ChartLine up{"rising", {}, {}, "#2860c0", false}, down{"falling", {}, {}, "#c03828", false};
    for (std::size_t k = 0; k < c.current.size(); ++k) {
      const double x = 100 * c.current[k] / rated_current;
      for (auto [line, y] : {std::pair{&up, c.up[k]}, std::pair{&down, c.down[k]}})
        if (std::isfinite(y)) line->x.push_back(x), line->y.push_back(find_unit(unit)->from_si(y));
    }
    panel.lines = {up, down};
    panels.push_back(std::move(panel));
  }
  if (!sheet.response.empty()) {
    ChartPanel gain{"amplitude ratio, " + sheet.response_signal, "frequency [Hz]", "amplitude [dB]", {}, {}, {}, true};
    ChartPanel phase{"phase, " + sheet.response_signal, "frequency [Hz]", "phase [deg]", {}, {}, {}, true};
    ChartLine a{"", {}, {}, "#2860c0", false}, b{"", {}, {}, "#2860c0", false};
    for (const curves::ResponsePoint& p : sheet.response) {
      a.x.push_back(p.frequency), b.x.push_back(p.frequency);
      a.y.push_back(20 * std::log10(p.gain / sheet.response.front().gain));
      b.y.push_back(p.phase * 180 / std::numbers::pi);
    }
    gain.lines = {a}, phase.lines = {b};
    panels.push_back(std::move(gain));
    panels.push_back(std::move(phase));
  }
  return svg_of(panels, 2);
}

}  // namespace servodx::report
