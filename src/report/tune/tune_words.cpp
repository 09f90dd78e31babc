#include "report/tune/tune_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

#include "diagnose/best_seen.h"
#include "fit/free_values.h"
#include "optimise/box_least_squares.h"
#include "optimise/local.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/replay_part.h"
#include "report/shared/search_words.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/tune.h"
#include "tune/trust.h"
#include "tune/tune.h"

namespace servodx::report {
namespace {

std::string word_of(StopReason reason) {
  switch (reason) {
    case StopReason::converged:
      return "converged";
    case StopReason::goal:
      return "goal";
    case StopReason::stalled:
      return "stalled";
    case StopReason::iteration_limit:
      return "iteration limit";
    case StopReason::evaluation_limit:
      return "evaluation limit";
    case StopReason::interrupted:
      return "interrupted";
    case StopReason::start_failed:
      return "start failed";
  }
  return "";
}

std::string end_in_words(const TuneResult& result) {
  const std::string left = std::isfinite(result.still_promised)
                               ? fmt::format("{} of its cost still promised", digits(result.still_promised, 2))
                               : "without derivatives nothing says how much is left";
  return fmt::format("{}, {}", word_of(result.stop), left);
}

}  // namespace

std::string words_of(StageMethod method) {
  switch (method) {
    case StageMethod::genetic:
      return "genetic search";
    case StageMethod::least_squares:
      return "bounded search";
    case StageMethod::ceres:
      return "Ceres";
    case StageMethod::nlopt:
      return "BOBYQA";
    case StageMethod::none:
      return "";
  }
  return "";
}

std::string word_of(const Stage& stage) {
  switch (stage.kind) {
    case Stage::Kind::screening:
      return "screening";
    case Stage::Kind::genetic:
      return "genetic search";
    case Stage::Kind::start:
      return fmt::format("start {}", stage.start);
    case Stage::Kind::weights:
      return "weights";
    case Stage::Kind::effects:
      return "effects";
    case Stage::Kind::everything:
      return "everything";
    case Stage::Kind::errors:
      return "errors";
  }
  return "";
}

namespace {

Note note_of_distrust(const TuneResult& result) {
  const auto by_bobyqa = [](const StageResult& s) { return s.by == StageMethod::nlopt; };
  const auto last = std::find_if(result.stages.rbegin(), result.stages.rend(), by_bobyqa);
  const StageResult rescue = last == result.stages.rend() ? StageResult{} : *last;
  return {Note::Kind::derivatives,
          fmt::format("derivatives were not to be trusted ({}): BOBYQA went on without them, cost {:.4g} to {:.4g}",
                      result.distrust == Distrust::missing_columns ? "some could not be had"
                                                                   : "no step kept what they promised",
                      rescue.before, rescue.after)};
}

}  // namespace

std::vector<Note> notes_of(const TuneResult& result) {
  std::vector<Note> notes = result.notes;
  notes.push_back({Note::Kind::search_end, "local stage: " + words_of(result.search_end)});
  if (result.distrust != Distrust::none) notes.push_back(note_of_distrust(result));
  notes.insert(notes.end(), result.notes_by_log.begin(), result.notes_by_log.end());
  return notes;
}

std::string gains_in_words(const TuneResult& result) {
  std::vector<std::string> parts;
  std::size_t from = result.stages.empty() ? 0 : result.stages.size() - 1;  // of the last fit, which our search begins
  for (std::size_t i = 0; i < result.stages.size(); ++i)
    if (result.stages[i].by == StageMethod::least_squares) from = i;
  for (std::size_t i = 0; i < result.stages.size(); ++i) {
    const StageResult& s = result.stages[i];
    if (s.by == StageMethod::none || (s.by != StageMethod::genetic && i < from)) continue;
    const std::string how = s.after < s.before ? fmt::format("{} to {}", digits(s.before, 5), digits(s.after, 5))
                                               : "no lower than " + digits(s.before, 5);
    parts.push_back(
        fmt::format("{}: {} ({} simulations, {} Jacobians)", words_of(s.by), how, s.simulations, s.jacobians));
  }
  return parts.empty() ? "" : "cost by stage: " + join(parts, "; ");
}

std::string effects_in_words(const std::vector<EarnedEffect>& effects) {
  std::vector<std::string> kept, off;
  for (const EarnedEffect& e : effects)
    (e.kept ? kept : off).push_back(fmt::format("{} {}", e.effect, digits(e.gain, 2)));
  std::string text;
  if (!kept.empty()) text = "effects, with what each gains on the held-out part: " + join(kept);
  if (!off.empty())
    text += (kept.empty() ? "effects" : "; ") + std::string("off, as no better with them: ") + join(off);
  return text;
}

namespace {

std::string off_drawing_in_words(const std::vector<OffDrawing>& rows) {
  std::vector<std::string> parts;
  for (const OffDrawing& r : rows) parts.push_back(fmt::format("{} {} times", words(r.row), digits(r.times, 2)));
  return join(parts);
}

}  // namespace

std::string unfollowed_in_words(const std::vector<Unfollowed>& channels) {
  std::vector<std::string> parts;
  for (const Unfollowed& u : channels)
    parts.push_back(fmt::format("{} is left with {} times its noise", words(std::string(name_of(u.signal))),
                                digits(u.over_noise, 2)));
  return join(parts);
}

namespace {

std::string join_times(const std::vector<TrustVerdict::Times>& channels) {
  std::vector<std::string> parts;
  for (const TrustVerdict::Times& c : channels)
    parts.push_back(fmt::format("{} {} times", words(std::string(info(c.signal).name)), digits(c.times, 2)));
  return join(parts);
}

std::vector<std::string> names_of(const std::vector<std::size_t>& which, const std::vector<Visible>& faults) {
  std::vector<std::string> names;
  for (const std::size_t k : which) names.push_back(faults[k].fault);
  return names;
}

std::string reason_in_words(TrustDoubt doubt, const TrustVerdict& verdict, const TuneResult& result,
                            const std::vector<std::string>& hidden, const BeyondFaults* likeliest) {
  switch (doubt) {
    case TrustDoubt::interrupted:
      return "it was interrupted";
    case TrustDoubt::unfollowed:
      return "the model does not follow these logs: " + unfollowed_in_words(result.unfollowed) +
             (likeliest ? "; " + beyond_in_words(*likeliest) : "");
    case TrustDoubt::another_sheet:
      return "the model does not follow these logs (error over noise: " + join_times(verdict.beyond_noise) +
             "): check the rig file's data sheet (flow, areas, supply), signs and gains of sensors";
    case TrustDoubt::off_drawing:
      return "what the data sheet states ended at the end of its range (" + off_drawing_in_words(result.off_drawing) +
             " the sheet's): something that the model lacks pulls; trust verdicts at small openings less";
    case TrustDoubt::predicts_worse:
      return "it predicts worse than it fits (" + join_times(verdict.worse) + "): tune with more logs, of more kinds";
    case TrustDoubt::not_arrived:
      return "the search has not arrived (" + end_in_words(result) + "): more --rounds";
    case TrustDoubt::lone_valley:
      return "no second start reached the best valley: more --generations";
    case TrustDoubt::hidden_faults:
      return "on logs like these it would not see, even at typical size: " + join(hidden);
  }
  return "";
}

}  // namespace

GoodEnough good_enough(const TuneResult& result, const std::vector<Promise>& promises, const BeyondFaults* likeliest) {
  GoodEnough g;
  g.best = best_seen(promises);
  std::vector<TrustEvidence::Fault> faults;
  for (const Visible& v : g.best) faults.push_back({v.deviates_at_least, v.deviates_at_typical});
  const TrustVerdict verdict = trust_in(evidence_of(result, std::move(faults)));
  g.trust = verdict.trust;
  std::vector<std::string> errors;
  for (const ChannelResult& c : result.channels)
    if (c.noise_rms > 0 && std::isfinite(c.heldout_rms))
      errors.push_back(words(std::string(info(c.signal).name)) + " " + digits(c.heldout_rms / c.noise_rms, 2));
  if (!errors.empty()) g.errors = "error over noise on the held-out part: " + join(errors);
  for (const TrustVerdict::Exception& e : verdict.exceptions)
    g.exceptions.push_back(fmt::format("{} of {} ({} times)", words(std::string(info(e.signal).name)),
                                       file_name(result.logs[e.log].path), digits(e.times, 2)));
  g.hidden = names_of(verdict.hidden, g.best), g.faint = names_of(verdict.faint, g.best);
  for (const TrustDoubt doubt : verdict.doubts)
    g.reasons.push_back(reason_in_words(doubt, verdict, result, g.hidden, likeliest));
  return g;
}

std::vector<std::string> praise_of(const GoodEnough& g) {
  if (g.trust != Trust::yes) return {};
  std::vector<std::string> parts = {fmt::format("it predicts {} as well as it fits, and the search has arrived",
                                                g.exceptions.empty() ? "logs" : "most logs")};
  if (!g.best.empty())
    parts.push_back("on the log of these that shows it best a diagnosis sees every fault at its typical size, and " +
                    (g.faint.empty() ? "at its mildest" : "may miss at their mildest " + join(g.faint)));
  return parts;
}

std::string line_of(const GoodEnough& g) {
  const std::string but =
      g.exceptions.empty() ? "" : "; predicted worse than fitted: " + join(g.exceptions) + ", so such logs are few";
  if (g.trust != Trust::yes)
    return fmt::format("{}: {}{}", g.trust == Trust::no ? "no" : "with care", fmt::join(g.reasons, "; "), but);
  return "yes: " + join(praise_of(g), "; ") + but;
}

Json to_json(const GoodEnough& g) {
  const auto number = [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); };
  Json faults = Json::array();
  for (const Visible& v : g.best)
    faults.push_back({{"fault", v.fault},
                      {"unit", v.unit},
                      {"least", v.least},
                      {"deviate_at_least", number(v.deviates_at_least)},
                      {"typical", v.typical},
                      {"deviate_at_typical", number(v.deviates_at_typical)}});
  return {{"yes", g.trust == Trust::yes}, {"no", g.trust == Trust::no}, {"reasons", g.reasons},
          {"exceptions", g.exceptions},   {"hidden", g.hidden},         {"faint", g.faint},
          {"visible_faults", faults}};
}

}  // namespace servodx::report
