#include <fmt/format.h>

#include <algorithm>

#include "report/explain_report.h"
#include "report/handy.h"
#include "report/replay_part.h"

namespace servodx::report {
namespace {

std::string of_misfit(const Interval& g) {
  return fmt::format("{} ({} to {}, 90 %)", percent(g.value), percent(g.lower), percent(g.upper));
}

std::string headline(const ExplainResult& r) {
  if (r.verdict == "sufficient") return "The simulation misses nothing that healthy logs do not show";
  if (r.causes.empty()) return "Something is missing that no cause in the list mends, near " + words(r.where);
  std::string text;
  for (const ExplainedCause& c : r.causes)
    text += (text.empty() ? "" : ", ") + words(c.effect) + " at " + words(c.where);
  return text;
}

TablePart causes_table(const std::string& title, const std::vector<ExplainedCause>& causes) {
  TablePart table{
      title, "llrrrlll", {"cause", "where", "number", "value", "90 %", "unit", "gain held out", "or else"}, {}, 0};
  for (const ExplainedCause& c : causes) {
    std::string others;
    for (const std::string& o : c.confusable_with) others += (others.empty() ? "" : ", ") + words(o);
    for (const ExplainedParameter& p : c.parameters) {
      const double half = 1.645 * p.std_error;
      table.rows.push_back({words(c.effect),
                            words(c.where),
                            words(p.name),
                            {digits(p.value), p.value},
                            {std::isfinite(half) ? "+-" + digits(half, 2) : "at a bound", half},
                            p.unit,
                            {of_misfit(c.heldout_gain), c.heldout_gain.value},
                            others});
    }
  }
  return table;
}

// A residual against one variable of the operating point: mean and rms of eight parts with equally many samples.
Plot map_plot(const ShownChannel& c, const ResidualMap& m) {
  Plot plot;
  plot.title = fmt::format("{} residual [{}]", words(c.signal), info(*find_signal(c.signal)).si_unit);
  plot.x_label = fmt::format("{} [{}]", words(m.variable), m.unit);
  Series mean{"mean", {}, Role::measured}, above{"mean + rms about it", {}, Role::other},
      below{"mean - rms about it", {}, Role::other};
  for (const MapBin& b : m.bins) {
    const double spread = std::sqrt(std::max(0.0, b.rms * b.rms - b.mean * b.mean));
    plot.x.push_back(0.5 * (b.from + b.to));
    mean.y.push_back(b.mean), above.y.push_back(b.mean + spread), below.y.push_back(b.mean - spread);
  }
  plot.series = {mean, above, below};
  plot.low = true;
  return plot;
}

Plot spectrum_plot(const ShownChannel& c) {
  Plot plot;
  plot.title = fmt::format("{} residual [{}/sqrt(Hz)]", words(c.signal), info(*find_signal(c.signal)).si_unit);
  plot.x_label = "frequency [Hz]";
  Series s{"residual", {}, Role::measured};
  for (const auto& [f, v] : c.spectrum) plot.x.push_back(f), s.y.push_back(v);
  plot.series = {s};
  plot.low = plot.log_y = true;
  return plot;
}

}  // namespace

Page explain_page(const Header& header, const ExplainResult& r, const std::vector<Replay>& replays) {
  Page page(header, "What the simulation misses");
  Verdict v;
  v.tone = r.verdict == "sufficient" ? Tone::good : r.verdict == "extended" ? Tone::bad : Tone::doubt;
  v.word = r.verdict;
  v.headline = headline(r);
  if (!r.causes.empty())
    v.detail = fmt::format("Mending it removes {} of the misfit on data that the fit had not seen.",
                           of_misfit(r.heldout_gain));
  v.facts = {{"Re-tuning alone removes", of_misfit(r.retuned)},
             {"Misfit over that of the tuning logs, before", digits(r.adequacy_before)},
             {"after", digits(r.adequacy_after)}};
  if (r.p_adequacy) v.facts.push_back({"Chance that a healthy log is left with as much", digits(*r.p_adequacy, 2)});
  for (const ExplainedCause& c : r.causes)
    if (!c.test.empty()) v.reasons.push_back(words(c.effect) + " shows best in " + c.test);
  page.verdict(v);
  if (!r.causes.empty()) page.add(causes_table("Causes", r.causes));
  if (r.curve) {
    Plot plot;
    plot.title = fmt::format("learnt curve in {} [{}]", words(r.curve->where), r.curve->unit);
    plot.x_label = fmt::format("{} [{}]", words(r.curve->variable), r.curve->variable_unit);
    Series s{"curve", {}, Role::named};
    Band band{"standard error", {}, {}};
    for (const CurvePoint& p : r.curve->points) {
      plot.x.push_back(p.x), s.y.push_back(p.value);
      band.lower.push_back(p.value - p.std_error), band.upper.push_back(p.value + p.std_error);
    }
    plot.series = {s};
    plot.band = band;
    page.add(plot);
    if (!r.curve->closed_form.empty()) page.text("In short: " + r.curve->closed_form);
  }

  page.section("How wrong it is", "Residual of each channel as tuned and with the causes, beside the sensor's noise.");
  TablePart channels{"Channels",
                     "lrrrrrll",
                     {"channel", "before", "after", "noise", "held out", "after", "unit", "where the excess gathers"},
                     {},
                     0};
  for (const ExplainedChannel& c : r.channels) {
    const Signal signal = *find_signal(c.signal);
    const auto cells = [&](double a, double b, double d) { return figures(ChannelResult{signal, c.unit, a, b, d}); };
    const ChannelFigures before = cells(c.rms_before, c.noise_rms, c.heldout_before),
                         after = cells(c.rms_after, c.noise_rms, c.heldout_after);
    std::string summary;
    for (const ShownChannel& s : r.shown)
      if (s.signal == c.signal) summary = s.summary;
    channels.rows.push_back({words(c.signal),
                             {digits(before.rms), before.rms},
                             {digits(after.rms), after.rms},
                             {digits(before.noise_rms), before.noise_rms},
                             {digits(before.heldout_rms), before.heldout_rms},
                             {digits(after.heldout_rms), after.heldout_rms},
                             before.unit,
                             summary});
  }
  page.add(channels);
  for (const Replay& replay : replays) {
    page.section(file_name(replay.log), "Measured, as tuned, and with the causes.", &replay != &replays.front());
    add_replay(page, replay, {.shown = {}, .onset = {}, .logs = replays.size()});
  }

  if (!r.blocks.empty()) {
    page.section("Where",
                 "Each block of the model with measured signals at its ends, so that no other block's error enters: "
                 "what it misses, as a part of what passes through it.");
    Bars bars{"Blocks", "block", "missing over passing", {}, {}, {}};
    for (const BlockReplay& b : r.blocks)
      bars.rows.push_back({b.block, b.passing > 0 ? b.missing / b.passing : 0,
                           fmt::format("{} of {}", handy(b.missing, b.unit), handy(b.passing, b.unit)),
                           fmt::format("{} of it in line with {}{}", percent(b.share), words(b.variable),
                                       b.p_new ? "; chance in health " + digits(*b.p_new, 2) : ""),
                           b.p_new && *b.p_new < 0.05 ? Tone::doubt : Tone::plain, ""});
    page.add(bars);
  }
  for (const ShownChannel& c : r.shown) {
    page.section(words(c.signal) + ": residual maps", c.summary, true);
    for (const ResidualMap& m : c.maps)
      if (!m.bins.empty()) page.add(map_plot(c, m));
    if (!c.spectrum.empty()) page.add(spectrum_plot(c));
  }

  page.section("What was tried", "By the misfit that its score predicts it would remove.");
  Bars bars{"Candidates", "cause", "predicted gain", {}, {}, {}};
  for (const ExplainedCandidate& c : r.candidates) {
    if (bars.rows.size() >= 15) break;
    bars.rows.push_back({words(c.effect) + " at " + words(c.where), c.predicted_gain, digits(c.predicted_gain),
                         c.reason + (c.p_new ? "; chance in health " + digits(*c.p_new, 2) : ""),
                         c.reason == "taken" ? Tone::bad : Tone::plain, ""});
  }
  page.add(bars);
  if (!r.standing.empty()) page.add(causes_table("Standing: healthy logs show it too", r.standing));
  return page;
}

}  // namespace servodx::report
