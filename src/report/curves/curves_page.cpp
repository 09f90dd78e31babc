#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/units.h"
#include "curves/curves.h"
#include "curves/frequency_response.h"
#include "report/curves/curves.h"
#include "report/curves/data_sheet.h"
#include "report/shared/certificate_part.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/curves.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"

namespace servodx::report {
namespace {

using curves::Figure;
using curves::Judgement;
using curves::Sheet;

std::string display_unit(Signal signal) {
  const std::string si(info(signal).si_unit);
  return si == "m3/s" ? "l/min" : si == "Pa" ? "bar" : si == "m" ? "mm" : si;
}

constexpr double passed_over = 0.02;  // of rated current: a sweep this fast between two samples is drawn through

// Places that a branch passed over between two samples, in a line.
std::vector<double> drawn_through(std::vector<double> y, const std::vector<double>& x, double most) {
  std::size_t last = y.size();
  for (std::size_t k = 0; k < y.size(); ++k) {
    if (!std::isfinite(y[k])) continue;
    if (last < k && std::abs(x[k] - x[last]) <= most)
      for (std::size_t j = last + 1; j < k; ++j)
        y[j] = y[last] + (y[k] - y[last]) * (x[j] - x[last]) / (x[k] - x[last]);
    last = k;
  }
  return y;
}

Tone tone_of(const Figure& f) {
  switch (f.judgement) {
    case Judgement::not_judged:
      return f.limit ? Tone::doubt : Tone::plain;
    case Judgement::pass:
      return Tone::good;
    case Judgement::too_near:
      return Tone::doubt;
    case Judgement::fail:
      return Tone::bad;
  }
  return Tone::plain;
}

Tone tone_of(AcceptanceSheet::Kind verdict) {
  switch (verdict) {
    case AcceptanceSheet::Kind::pass:
      return Tone::good;
    case AcceptanceSheet::Kind::fail:
      return Tone::bad;
    case AcceptanceSheet::Kind::not_judged:
      return Tone::plain;
    case AcceptanceSheet::Kind::incomplete:
      return Tone::doubt;
  }
  return Tone::plain;
}

std::string with_uncertainty(const Figure& f) {
  const std::string value = value_text(f), more = uncertainty_text(f);
  return more.empty() ? value : value + " \u00b1 " + more;
}

// What a first look asks for.
std::vector<std::pair<std::string, std::string>> first_facts(const Sheet& sheet) {
  std::vector<std::pair<std::string, std::string>> facts;
  for (const char* name :
       {"rated_flow", "null_bias", "hysteresis", "pressure_gain", "null_leakage", "phase_lag_90_frequency", "lap"})
    for (const Figure& f : sheet.figures)
      if (f.name == name && std::isfinite(f.value) && facts.size() < 4)
        facts.push_back({words(f.name), with_uncertainty(f)});
  return facts;
}

Plot branches(const curves::SweepCurve& c, double rated_current) {
  const std::string unit = display_unit(c.signal), name = words(std::string(info(c.signal).name));
  const auto scaled = [&](const std::vector<double>& branch) {
    std::vector<double> y = drawn_through(branch, c.current, passed_over * rated_current);
    for (double& v : y) v = find_unit(unit)->from_si(v);
    return y;
  };
  Plot plot{.title = name + " [" + unit + "]", .x_label = "current [% of rated]", .x = c.current, .group = "sweep"};
  for (double& x : plot.x) x *= 100 / rated_current;
  plot.series = {{"rising", scaled(c.up), Role::measured}, {"falling", scaled(c.down), Role::named}};
  return plot;
}

// What lies between the branches: on the sweep's own scale it is too thin to be seen.
std::optional<Plot> between(const Plot& sweep, const std::string& name, const std::string& unit) {
  Plot plot{.title = name + ", falling less rising [" + unit + "]",
            .x_label = sweep.x_label,
            .x = sweep.x,
            .group = sweep.group,
            .low = true};
  Series s{"falling less rising", {}, Role::measured};
  for (std::size_t k = 0; k < sweep.x.size(); ++k) s.y.push_back(sweep.series[1].y[k] - sweep.series[0].y[k]);
  if (std::count_if(s.y.begin(), s.y.end(), [](double y) { return std::isfinite(y); }) < 2) return {};
  plot.series = {s};
  return plot;
}

void add_response(Page& page, const Sheet& sheet) {
  Plot gain{.title = "amplitude ratio [dB]", .x_label = "frequency [Hz]", .group = "bode", .log_x = true};
  Plot phase{.title = "phase [deg]", .x_label = "frequency [Hz]", .group = "bode", .log_x = true};
  Series a{"amplitude", {}, Role::measured}, p{"phase", {}, Role::measured};
  for (const curves::ResponsePoint& r : sheet.response) {
    gain.x.push_back(r.frequency), phase.x.push_back(r.frequency);
    a.y.push_back(20 * std::log10(r.gain / sheet.response.front().gain));
    p.y.push_back(r.phase * 180 / std::numbers::pi);
  }
  gain.series = {a}, phase.series = {p};
  gain.y_marks = {{-3, "-3 dB"}};
  phase.y_marks = {{-90, "-90 deg"}};
  page.section("Frequency response", "Of " + words(sheet.response_signal) + " to current, over its lowest point.");
  page.add(gain);
  page.add(phase);
}

}  // namespace

Page curves_page(const Header& header, const Sheet& sheet, const std::string& log, double rated_current, double guard,
                 const CertificateOf& certificate, const SheetFit* stated) {
  Page page(header, "Acceptance sheet of " + file_name(log));
  Verdict v;
  v.tone = tone_of(sheet.verdict);
  v.word = word_of(sheet.verdict);
  const bool judged = sheet.verdict != AcceptanceSheet::Kind::not_judged;
  const std::vector<std::string> hidden = curves::unjudged_limits(sheet.figures);
  v.headline = (judged ? "" : file_name(log) + ": ") + limits_in_words(sheet);
  if (!judged && hidden.empty()) v.detail = "Limits go under [limits] of the rig file; the figures stand below.";
  v.facts = first_facts(sheet);
  for (const Figure& f : sheet.figures)
    if (f.judgement == Judgement::fail || f.judgement == Judgement::too_near)
      v.reasons.push_back(words(f.name) + ": " + with_uncertainty(f) + ", " + limit_text(f) +
                          (f.judgement == Judgement::too_near ? "; too near to pass" : ""));
  for (const std::string& name : hidden) v.reasons.push_back(words(name) + ": not judged, this log does not show it");
  if (judged) v.detail = sentence(guard_words(guard));
  page.verdict(v);
  if (certificate.sheet) {
    std::vector<CertifiedFigure> certified;
    for (const Figure& f : sheet.figures)
      if (std::isfinite(f.value) || f.limit)
        certified.push_back(
            {words(f.name), value_text(f), uncertainty_text(f), limit_text(f), judgement_of(f), tone_of(f)});
    add_certificate(page, certificate, header, certified, guard_words(guard) + ".");
  }

  page.section("Figures", "As SAE ARP490 defines them. Percentages are of rated current.");
  TablePart table{"Figures", "lrrllll", {"figure", "value", "+- (k = 2)", "limit", "", "from", "note"}, {}, 0};
  for (const Figure& f : sheet.figures) {
    Cell judgement = judgement_of(f);
    judgement.tone = tone_of(f);
    table.rows.push_back({words(f.name), std::isfinite(f.value) ? Cell(value_text(f), f.value) : Cell("-"),
                          std::isfinite(f.uncertainty) ? Cell(uncertainty_text(f), f.uncertainty) : Cell(""),
                          limit_text(f), judgement, words(f.signal), words_of(f.remark)});
  }
  page.add(table);
  if (!sheet.curves.empty())
    page.section("Sweeps",
                 "Both branches over current. What lies between them is hysteresis and the lag of the meter.");
  for (const curves::SweepCurve& c : sheet.curves) {
    const Plot sweep = branches(c, rated_current);
    page.add(sweep);
    if (const auto gap = between(sweep, words(std::string(info(c.signal).name)), display_unit(c.signal)))
      page.add(*gap);
  }
  if (!sheet.response.empty()) add_response(page, sheet);
  if (stated) add_data_sheet(page, *stated);
  return page;
}

}  // namespace servodx::report
