#include "report/tune/tune_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit/identifiability.h"
#include "report/check_log/check_log.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parameter_part.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "report/tune/tune_words.h"
#include "servodx/replay.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "tune/trust.h"
#include "tune/tune.h"

namespace servodx::report {
namespace {

// Residual over noise up to which a channel is as good as the sensor lets it be, and from which it deserves a look.
constexpr double near_noise = 2.0, far_from_noise = 10.0;

std::string fit_in_words(const ChannelResult& c) {
  const double times = c.heldout_rms / c.noise_rms;
  if (!std::isfinite(times)) return "";
  return times < near_noise ? "as good as the sensor" : times < far_from_noise ? "" : "look at its residual";
}

void add_channels(Page& page, const std::string& title, const std::vector<ChannelResult>& channels) {
  TablePart table{
      title, "lrrrlrl", {"channel", "rms error", "held out", "noise", "unit", "held out over noise", ""}, {}, 0};
  for (const ChannelResult& c : channels) {
    const ChannelFigures f = figures(c);
    table.rows.push_back({words(std::string(info(c.signal).name)), Cell(digits(f.rms), f.rms),
                          Cell(digits(f.heldout_rms), f.heldout_rms), Cell(digits(f.noise_rms), f.noise_rms), f.unit,
                          Cell(digits(f.heldout_rms / f.noise_rms), f.heldout_rms / f.noise_rms), fit_in_words(c)});
  }
  page.add(table);
}

// Where a start began; those of the genetic search are counted from its first.
std::string start_words(const std::vector<StartEnd>& starts, std::size_t which) {
  const auto is_genetic = [](const StartEnd& start) { return start.from == StartEnd::From::genetic; };
  switch (starts[which].from) {
    case StartEnd::From::table:
      return "table's values";
    case StartEnd::From::rig_size:
      return "effects by the rig's size";
    case StartEnd::From::genetic:
      return fmt::format("genetic {}",
                         std::count_if(starts.begin(), starts.begin() + static_cast<long>(which) + 1, is_genetic));
  }
  return "";
}

// Where the stage begins or what it fits, for a reader of the page.
std::string stage_words(const Stage& stage, const std::vector<StartEnd>& starts) {
  switch (stage.kind) {
    case Stage::Kind::screening:
    case Stage::Kind::genetic:
      return word_of(stage);
    case Stage::Kind::start:
      return "from " + start_words(starts, static_cast<std::size_t>(stage.start - 1));
    case Stage::Kind::weights:
      return "on all but the end of each log";
    case Stage::Kind::effects:
      return "trial of the effects";
    case Stage::Kind::everything:
      return "on whole logs";
    case Stage::Kind::errors:
      return "errors of the rows";
  }
  return "";
}

// Least missed first, as they were tried.
void add_effects(Page& page, const std::vector<EarnedEffect>& effects) {
  if (effects.empty()) return;
  TablePart table{
      "Effects, least missed first: the fall of the held-out cost with each", "lrl", {"effect", "gain", ""}, {}, 0};
  for (const EarnedEffect& e : effects)
    table.rows.push_back({words(e.effect), Cell(digits(e.gain, 3), e.gain), e.kept ? "free" : "off"});
  page.add(table);
}

Cell cell_if_any(double value, int n) { return std::isfinite(value) ? Cell(digits(value, n), value) : Cell(""); }

void add_search(Page& page, const TuneResult& result) {
  if (result.starts.size() > 1) {
    std::vector<std::size_t> order(result.starts.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return result.starts[i].cost; });
    Bars bars{"Where each start ended", "start", "cost", {}, {}, {}};
    for (const std::size_t i : order)
      bars.rows.push_back({start_words(result.starts, i), result.starts[i].cost, digits(result.starts[i].cost, 4), "",
                           result.starts[i].in_best_valley ? Tone::good : Tone::plain, ""});
    page.add(bars);
  }
  if (result.convergence.empty()) return;
  Plot plot;
  plot.title = "Cost, stage by stage";
  plot.x_label = "simulations";
  plot.log_y = true;
  std::vector<Stage> stages;
  for (const ConvergencePoint& c : result.convergence) {
    plot.x.push_back(static_cast<double>(c.simulations));
    if (std::find(stages.begin(), stages.end(), c.stage) == stages.end()) stages.push_back(c.stage);
  }
  constexpr Role roles[] = {Role::measured, Role::reference, Role::other, Role::named, Role::input};
  for (std::size_t s = 0; s < stages.size(); ++s) {
    Series series{stage_words(stages[s], result.starts), {}, roles[s % std::size(roles)]};
    for (const ConvergencePoint& c : result.convergence)
      series.y.push_back(c.stage == stages[s] ? c.cost : std::nan(""));
    plot.series.push_back(std::move(series));
  }
  page.add(plot);
  if (!result.stages.empty()) {
    TablePart table{"What each step cost and gained",
                    "llrrrrr",
                    {"stage", "by", "cost from", "to", "held out over noise", "simulations", "Jacobians"},
                    {},
                    0};
    for (const StageResult& s : result.stages)
      table.rows.push_back({stage_words(s.stage, result.starts), words_of(s.by), cell_if_any(s.before, 5),
                            cell_if_any(s.after, 5), cell_if_any(s.heldout_over_noise, 3),
                            Cell(std::to_string(s.simulations), static_cast<double>(s.simulations)),
                            Cell(std::to_string(s.jacobians), static_cast<double>(s.jacobians))});
    page.add(table);
  }
  page.text(
      "Each stage weighs the residuals in its own way: compare levels within a stage, not between stages. What was "
      "held "
      "out compares between all. The JSON result has each step's seconds.");
}

}  // namespace

Page tune_page(const Header& header, const TuneResult& result, const GoodEnough& enough,
               const std::vector<Replay>& replays) {
  const auto logs = static_cast<long>(result.logs.size());
  Page page(header, fmt::format("Nominal parameters from {} log{}", logs, logs == 1 ? "" : "s"));
  long known = 0, held = 0;
  std::vector<std::string> at_end;
  for (const ParameterResult& p : result.parameters) {
    known += std::isfinite(p.std_error);
    if (p.verdict == RowVerdict::at_bound) at_end.push_back(words(p.name));
    held += !std::isfinite(p.std_error) && p.verdict != RowVerdict::at_bound;
  }
  Verdict v;
  const bool yes = enough.trust == Trust::yes, no = enough.trust == Trust::no;
  v.tone = yes ? Tone::good : no ? Tone::bad : Tone::doubt;
  v.word = result.interrupted ? "INTERRUPTED" : yes ? "GOOD ENOUGH" : no ? "NOT GOOD ENOUGH" : "WITH CARE";
  v.headline = yes  ? "to diagnose with"
               : no ? "The model does not follow these logs: do not diagnose with this table"
                    : "Diagnose with this table, but mind what follows";
  v.detail = fmt::format("{} parameters fitted to {} log{}; {}.", known + static_cast<long>(at_end.size()), logs,
                         logs == 1 ? "" : "s", enough.errors);
  v.facts = {{"Known with an error", std::to_string(known)},
             {"At an end of their range", std::to_string(at_end.size())},
             {"Held: the logs do not show it", std::to_string(held)},
             {"Starts that agree", fmt::format("{} of {}", result.reached_best(), result.starts.size())}};
  for (const std::string& part : praise_of(enough)) v.reasons.push_back(sentence(words(part)));
  for (const std::string& reason : enough.reasons) v.reasons.push_back(sentence(words(reason)));
  if (!enough.exceptions.empty())
    v.reasons.push_back("Predicted worse than fitted: " + join(enough.exceptions) + ", so such logs are few.");
  if (!at_end.empty())
    v.reasons.push_back(fmt::format("At an end of {} range: {}. Check the data sheet behind {}, or widen the bounds.",
                                    at_end.size() == 1 ? "its" : "their", join(at_end),
                                    at_end.size() == 1 ? "it" : "them"));
  page.verdict(v);

  page.section("How well the model fits",
               "Held out: the last part of every log, before the final fit saw it. Noise: the sensor's own.");
  add_channels(page, "Channels, all logs together", result.channels);
  TablePart by_log{"Log by log: of each channel the error over the sensor's noise", "l", {"log"}, {}, 0};
  for (const ChannelResult& c : result.channels) {
    by_log.alignment += 'r';
    by_log.head.push_back(words(std::string(info(c.signal).name)));
  }
  by_log.alignment += "rl";
  by_log.head.insert(by_log.head.end(), {"null", "command from sample to sample"});
  for (const LogResult& log : result.logs) {
    std::vector<Cell> row = {log.path};
    for (const ChannelResult& pooled : result.channels) {
      row.push_back("");
      for (const ChannelResult& c : log.channels)
        if (c.signal == pooled.signal) row.back() = Cell(digits(c.rms / c.noise_rms, 2), c.rms / c.noise_rms);
    }
    row.push_back(Cell(percent(log.null) + " of rated", log.null));
    row.push_back(Cell(log.command_slope < 0.05   ? "held"
                       : log.command_slope > 0.95 ? "runs in a line"
                                                  : "runs " + percent(log.command_slope) + " of the step",
                       log.command_slope));
    by_log.rows.push_back(std::move(row));
  }
  page.add(by_log);

  if (!enough.best.empty()) {
    page.section(
        "Which faults a diagnosis would see",
        "On the log of these that shows each best, against the errors that this model makes, in sigmas: below 3 "
        "the fault stays hidden.");
    add_visible(page, enough.best);
  }

  page.section("Parameters",
               "From the table's value to the fitted one. Sigma is the standard error of the fitted value.");
  page.add(moves_of(result.parameters, "What moved"));
  add_effects(page, result.effects);
  page.section("Did the search arrive?", "A valley that several starts reach is likelier the right one.");
  add_search(page, result);
  for (const Replay& r : replays) {
    page.section("Measured and simulated: " + file_name(r.log), "", &r != &replays.front());
    add_replay(page, r, {.shown = {}, .onset = {}, .logs = replays.size()});
  }
  return page;
}

}  // namespace servodx::report
