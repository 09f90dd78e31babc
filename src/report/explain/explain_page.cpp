#include <fmt/format.h>

#include <algorithm>

#include "base/normal.h"
#include "evidence/heldout_gain.h"
#include "explain/blocks.h"
#include "explain/explain.h"
#include "explain/learnt_curves.h"
#include "explain/missing.h"
#include "explain/outcome.h"
#include "explain/show.h"
#include "report/explain/explain_report.h"
#include "report/explain/explain_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/log.h"
#include "servodx/replay.h"
#include "servodx/tune.h"

namespace servodx::report {
namespace {

std::string of_misfit(const Interval& g) {
  return fmt::format("{} ({} to {}, 90 %)", percent(g.value), percent(g.lower), percent(g.upper));
}

// For the head of a page: what a fit loses there is no gain, and its minus would have to be explained.
std::string gain_in_words(const Interval& g) { return g.value > 0 ? of_misfit(g) : "nothing"; }

std::string headline(const ExplainResult& r) {
  if (r.verdict == ExplainVerdict::sufficient) return "The simulation is no more wrong than on healthy logs";
  if (r.causes.empty())
    return "Something is missing that no cause in the list explains" +
           (r.where.empty() ? "" : ", near " + words(r.where));
  const ExplainedCause& best = r.causes.front();
  const std::string more = r.causes.size() > 1 ? fmt::format(" and {} more", r.causes.size() - 1) : "";
  const std::string name = words(best.effect) + " at " + words(best.where) + more;
  if (r.heldout_gain.value <= 0) return name;  // told by the blocks alone
  return fmt::format("Mending {} removes {} of the misfit", name, percent(r.heldout_gain.value));
}

// "610 N (596 to 623, 90 %); tuned 150 N"
std::string size_of_first(const ExplainResult& r) {
  std::string text;
  const ExplainedCause& best = r.causes.front();
  if (best.parameters.size() == 1) {
    const ExplainedParameter& p = best.parameters.front();
    const HandyUnit unit = handy_unit(p.unit, p.value);
    text = fmt::format("{}, tuned {}{}{}", size_in_words(p), digits(p.before * unit.factor),
                       unit.name.empty() ? "" : " ", unit.name);
  }
  return text;
}

// "valve glitch (backlash between feedback wire and spool, full width)".
std::string with_meanings(const std::vector<ExplainedCause>& causes) {
  std::vector<std::string> all;
  for (const ExplainedCause& c : causes)
    all.push_back(words(c.effect) + (c.meaning.empty() ? "" : " (" + c.meaning + ")"));
  return join(all, "; ");
}

std::vector<std::string> reasons(const ExplainResult& r) {
  std::vector<std::string> why;
  // The channel that shows it most.
  const ExplainedChannel* worst = nullptr;
  for (const ExplainedChannel& c : r.channels)
    if (!worst || c.rms_before * worst->noise_rms > worst->rms_before * c.noise_rms) worst = &c;
  if (worst) {
    const ChannelFigures f =  // the last stands for what is left
        figures({*find_signal(worst->signal), worst->unit, worst->rms_before, worst->noise_rms, worst->rms_after});
    const auto in_unit = [&](double value) { return digits(value) + " " + f.unit; };
    why.push_back(fmt::format("It shows most in the {}: off by {} rms as tuned{}; the sensor's noise is {}.",
                              words(worst->signal), in_unit(f.rms),
                              r.causes.empty() ? "" : ", by " + in_unit(f.heldout_rms) + " with what was found",
                              in_unit(f.noise_rms)));
  }
  const BlockReplay* newest = nullptr;
  for (const BlockReplay& b : r.blocks)
    if (b.p_new && (!newest || *b.p_new < *newest->p_new)) newest = &b;
  if (newest && r.verdict != ExplainVerdict::sufficient)
    why.push_back(
        fmt::format("With measured signals at its ends, the block {} misses {} of {}; a healthy log misses "
                    "as much with a chance of {}.",
                    newest->block, handy(newest->missing, newest->unit), handy(newest->passing, newest->unit),
                    chance(*newest->p_new)));
  if (r.p_adequacy)
    why.push_back(
        fmt::format("What is left is {} times the tuning logs' misfit{}; a healthy log is left with as much "
                    "with a chance of {}.",
                    digits(r.adequacy_after), r.causes.empty() ? "" : " (" + digits(r.adequacy_before) + " before)",
                    chance(*r.p_adequacy)));
  if (r.false_alarm) {
    std::string rate = rate_in_words(*r.false_alarm);
    rate.front() = 'A';
    why.push_back(rate + ".");
  }
  for (const ExplainedCause& c : r.causes) {
    std::vector<std::string> others;
    for (const std::string& o : c.confusable_with) others.push_back(words(o));
    if (c.told_by == ToldBy::currents)
      why.push_back(
          sentence(fmt::format("{} was found between the command and the coil current, where it removes {} of the "
                               "error; the simulation is driven by the measured current, so it does not show there",
                               words(c.effect), percent(c.heldout_gain.value))));
    if (c.told_by == ToldBy::blocks)
      why.push_back(
          sentence(fmt::format("{} was found by the block replay, with measured signals between the blocks, where it "
                               "removes {} of their error; the free run alone does not decide it",
                               words(c.effect), percent(c.heldout_gain.value))));
    if (!others.empty())
      why.push_back(fmt::format("In place of {} it may be {}.", words(c.effect), join(others, " or ")));
    if (!c.test.empty()) why.push_back(sentence(words(c.effect) + " shows best in " + c.test));
  }
  return why;
}

// Sorted by half of the interval's width. [unit of the size]
Cell interval_cell(const ExplainedParameter& p, double factor) {
  const std::string ends = fmt::format("{} to {}", digits(p.lower * factor), digits(p.upper * factor));
  return {p.told == SizeTold::interval ? ends : words_of(p.told), 0.5 * (p.upper - p.lower)};
}

TablePart causes_table(const std::string& title, const std::vector<ExplainedCause>& causes) {
  TablePart table{
      title, "lllrrrll", {"cause", "where", "number", "tuned", "value", "90 %", "unit", "gain held out"}, {}, 0};
  const bool rivals =
      std::any_of(causes.begin(), causes.end(), [](const auto& c) { return !c.confusable_with.empty(); });
  if (rivals) table.alignment += 'l', table.head.push_back("or else");
  for (const ExplainedCause& c : causes) {
    std::vector<std::string> others;
    for (const std::string& o : c.confusable_with) others.push_back(words(o));
    for (const ExplainedParameter& p : c.parameters) {
      const HandyUnit unit = handy_unit(p.unit, p.value);
      table.rows.push_back({words(c.effect),
                            words(c.where),
                            p.name == c.effect ? std::string() : words(p.name),
                            {digits(p.before * unit.factor), p.before},
                            {digits(p.value * unit.factor), p.value},
                            interval_cell(p, unit.factor),
                            unit.name,
                            {of_misfit(c.heldout_gain), c.heldout_gain.value}});
      if (rivals) table.rows.back().push_back(join(others));
    }
  }
  return table;
}

// A residual against one variable of the operating point: mean and rms of eight parts with equally many samples.
Plot map_plot(const ShownChannel& c, const ResidualMap& m) {
  Plot plot;
  double most = 0, farthest = 0;
  for (const MapBin& b : m.bins)
    most = std::max(most, b.rms), farthest = std::max({farthest, std::abs(b.from), std::abs(b.to)});
  const HandyUnit unit = handy_unit(std::string(info(*find_signal(c.signal)).si_unit), most),
                  along = handy_unit(m.unit, farthest);
  plot.title = fmt::format("{} residual [{}]", words(c.signal), unit.name);
  plot.x_label = words(m.variable) + (along.name.empty() ? "" : " [" + along.name + "]");
  Series mean{"mean", {}, Role::measured}, above{"mean + rms about it", {}, Role::other},
      below{"mean - rms about it", {}, Role::other};
  for (const MapBin& b : m.bins) {
    const double spread = std::sqrt(std::max(0.0, b.rms * b.rms - b.mean * b.mean));
    plot.x.push_back(0.5 * (b.from + b.to) * along.factor);
    mean.y.push_back(b.mean * unit.factor);
    above.y.push_back((b.mean + spread) * unit.factor), below.y.push_back((b.mean - spread) * unit.factor);
  }
  plot.series = {mean, above, below};
  plot.low = true;
  return plot;
}

Plot spectrum_plot(const ShownChannel& c) {
  Plot plot;
  double most = 0;
  for (const auto& [f, v] : c.spectrum) most = std::max(most, v);
  const HandyUnit unit = handy_unit(std::string(info(*find_signal(c.signal)).si_unit), most);
  plot.title = fmt::format("{} residual [{}/sqrt(Hz)]", words(c.signal), unit.name);
  plot.x_label = "frequency [Hz]";
  Series s{"residual", {}, Role::measured};
  for (const auto& [f, v] : c.spectrum) plot.x.push_back(f), s.y.push_back(v * unit.factor);
  plot.series = {s};
  plot.low = plot.log_y = true;
  return plot;
}

void add_missing(Page& page, const ExplainResult& r) {
  const MissingInputs& m = r.missing;
  page.section("What is missing over time",
               "A current, force, flow or pressure at one place of the model, estimated from what all channels leave.");
  const MissingInput& best = m.places.front();
  page.text(words(missing_in_words(r)) + ".");
  Bars bars{"Places", "place", "log likelihood over nothing missing", {}, {}, {}};
  for (const MissingInput& p : m.places)
    bars.rows.push_back({words(p.where) + ", " + p.quantity, std::max(0.0, p.gain), digits(p.gain),
                         fmt::format("{} rms, {} of its square in line with {}", handy(p.rms, p.unit), percent(p.share),
                                     words(p.variable)),
                         p.likely ? Tone::doubt : Tone::plain, ""});
  page.add(bars);
  const HandyUnit unit = handy_unit(best.unit, best.rms);
  for (std::size_t l = 0; l < m.time.size(); ++l) {
    Plot plot;
    plot.title = fmt::format("{} missing at {}{} [{}]", best.quantity, words(best.where),
                             m.time.size() > 1 ? fmt::format(", log {}", l + 1) : "", unit.name);
    plot.x_label = "time [s]";
    plot.x = m.time[l];
    Series value{"missing", {}, Role::named};
    Band band{"90 %", {}, {}};
    for (std::size_t k = 0; k < best.value[l].size(); ++k) {
      const double v = best.value[l][k], half = normal_95_one_sided * best.error[l][k];
      value.y.push_back(v * unit.factor);
      band.lower.push_back((v - half) * unit.factor), band.upper.push_back((v + half) * unit.factor);
    }
    plot.series = {value};
    plot.band = band;
    page.add(plot);
  }
}

Verdict verdict_of(const ExplainResult& r) {
  Verdict v;
  v.tone = r.verdict == ExplainVerdict::sufficient ? Tone::good
           : r.verdict == ExplainVerdict::extended ? Tone::bad
                                                   : Tone::doubt;
  v.word = stamp_of(r.verdict);
  v.headline = headline(r);
  if (r.verdict == ExplainVerdict::extended)
    v.detail = "What the simulation has wrong on these logs: " + with_meanings(r.causes) + ".";
  if (!r.causes.empty())
    if (const std::string size = size_of_first(r); !size.empty())
      v.facts.push_back({words(r.causes.front().effect), size});
  if (r.curve) v.detail = "No cause in the list explains it; a curve learnt from the logs does.";
  if (r.suspicion) v.detail = "Not beyond healthy logs: " + suspicion_in_words(*r.suspicion) + ".";
  if (!r.depends_on.empty()) v.facts.push_back({"It follows", words(r.depends_on)});
  if (!r.causes.empty()) v.facts.push_back({"Mending it removes, of the misfit", gain_in_words(r.heldout_gain)});
  v.facts.push_back({"Re-tuning alone removes", gain_in_words(r.retuned)});
  v.facts.push_back({"Misfit, times the tuning logs'",
                     digits(r.adequacy_before) + (r.causes.empty() ? "" : ", mended " + digits(r.adequacy_after))});
  v.reasons = reasons(r);
  return v;
}

void add_curve(Page& page, const LearntCurve& c) {
  Plot plot;
  plot.title = fmt::format("learnt curve in {} [{}]{}", words(c.where), c.unit,
                           c.factor.empty() ? "" : ", by " + words(c.factor));
  plot.x_label = fmt::format("{} [{}]", words(c.variable), c.variable_unit);
  Series s{"curve", {}, Role::named};
  Band band{"standard error", {}, {}};
  for (const CurvePoint& p : c.points) {
    plot.x.push_back(p.x), s.y.push_back(p.value);
    band.lower.push_back(p.value - p.std_error), band.upper.push_back(p.value + p.std_error);
  }
  plot.series = {s};
  plot.band = band;
  page.add(plot);
  if (!c.closed_form.empty()) page.text("In short: " + c.closed_form);
}

TablePart channels_table(const ExplainResult& r) {
  TablePart channels{"Channels",
                     "lrrrrrll",
                     {"channel", "before", "after", "noise", "held out, before", "held out, after", "unit",
                      "where the excess gathers"},
                     {},
                     0};
  for (const ExplainedChannel& c : r.channels) {
    const Signal signal = *find_signal(c.signal);
    const auto cells = [&](double a, double b, double d) { return figures(ChannelResult{signal, c.unit, a, b, d}); };
    const ChannelFigures before = cells(c.rms_before, c.noise_rms, c.heldout_before),
                         after = cells(c.rms_after, c.noise_rms, c.heldout_after);
    std::string summary;
    for (const ShownChannel& s : r.shown)
      if (s.signal == c.signal) summary = words_of(s.excess);
    channels.rows.push_back({words(c.signal),
                             {digits(before.rms), before.rms},
                             {digits(after.rms), after.rms},
                             {digits(before.noise_rms), before.noise_rms},
                             {digits(before.heldout_rms), before.heldout_rms},
                             {digits(after.heldout_rms), after.heldout_rms},
                             before.unit,
                             words(summary)});
  }
  return channels;
}

void add_blocks(Page& page, const ExplainResult& r) {
  page.section("Where",
               "Each block of the model with measured signals at its ends, so that no other block's error enters: "
               "what it misses, as a part of what passes through it.");
  Bars bars{"Blocks", "block", "missing over passing", {}, {}, {}};
  for (const BlockReplay& b : r.blocks)
    bars.rows.push_back({b.block, b.passing > 0 ? b.missing / b.passing : 0,
                         fmt::format("{} of {}", handy(b.missing, b.unit), handy(b.passing, b.unit)),
                         fmt::format("{} of it in line with {}{}", percent(b.share), words(b.variable),
                                     b.p_new ? "; in health with a chance of " + chance(*b.p_new) : ""),
                         b.p_new && *b.p_new < 0.05 ? Tone::doubt : Tone::plain, ""});
  page.add(bars);
}

Bars candidates_of(const ExplainResult& r) {
  Bars bars{"Candidates", "cause", "predicted gain", {}, {}, {}};
  for (const ExplainedCandidate& c : r.candidates) {
    if (bars.rows.size() >= 15) break;
    bars.rows.push_back(
        {words(c.effect) + " at " + words(c.where), c.predicted_gain, digits(c.predicted_gain),
         std::string(words_of(c.fate)) + (c.p_new ? "; in health with a chance of " + chance(*c.p_new) : ""),
         is_taken(c.fate) ? Tone::bad : Tone::plain, ""});
  }
  return bars;
}

}  // namespace

Page explain_page(const Header& header, const ExplainResult& r, const std::vector<Replay>& replays) {
  Page page(header, "What the simulation misses");
  page.verdict(verdict_of(r));
  if (!r.causes.empty() || r.curve)
    page.section("What was found", "Its numbers, and what each is worth on data that the fit had not seen.");
  if (!r.causes.empty()) page.add(causes_table("Causes", r.causes));
  if (r.curve) add_curve(page, *r.curve);

  page.section("How wrong it is", "Residual of each channel as tuned and with the causes, beside the sensor's noise.");
  page.add(channels_table(r));
  for (const Replay& replay : replays) {
    page.section(file_name(replay.log), "Measured, as tuned, and with the causes.", &replay != &replays.front());
    add_replay(page, replay, {.shown = {}, .onset = {}, .logs = replays.size()});
  }
  if (!r.blocks.empty()) add_blocks(page, r);
  if (!missing_in_words(r).empty()) add_missing(page, r);
  for (const ShownChannel& c : r.shown) {
    page.section(words(c.signal) + ": residual maps", words(words_of(c.excess)), true);
    for (const ResidualMap& m : c.maps)
      if (!m.bins.empty()) page.add(map_plot(c, m));
    if (!c.spectrum.empty()) page.add(spectrum_plot(c));
  }
  page.section("What was tried",
               "By the misfit that each would remove, as the slope of the residual predicts; the best were fitted.");
  page.add(candidates_of(r));
  if (!r.standing.empty()) page.add(causes_table("Found on healthy logs too", r.standing));
  return page;
}

}  // namespace servodx::report
