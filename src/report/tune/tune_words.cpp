#include "report/tune/tune_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fit/free_values.h"
#include "optimise/box_least_squares.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/replay_part.h"
#include "servodx/log.h"
#include "servodx/tune.h"
#include "tune/constants.h"

namespace servodx::report {
namespace {

constexpr double predicts_worse = 2.0;  // held-out over fitted error
constexpr double seen = 3.0;            // deviates
// Fitted error over the sensor's noise from which the model follows another rig than this: with the data sheet of the
// rig pooled errors are 1 to 22 of it, with another valve's flow and cylinder 160 to 760 (piston, pressures).
constexpr double follows = 50.0;

bool has_arrived(const TuneResult& result) {
  switch (result.stop) {
    case StopReason::converged:
    case StopReason::goal:
      return true;
    case StopReason::stalled:
    case StopReason::iteration_limit:
    case StopReason::evaluation_limit:
      return result.still_promised <= tune_constants::worth_a_step + tune_constants::tells_valleys * result.cost;
    case StopReason::interrupted:
    case StopReason::start_failed:
      return false;
  }
  return false;
}

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

struct Prediction {
  double usual = 0;  // held-out over fitted error, median over the logs
  double worst = 0;  // and the log that is predicted worst
  const LogResult* log = nullptr;
};

Prediction prediction_of(const TuneResult& result, Signal signal) {
  Prediction p;
  std::vector<double> ratios;
  for (const LogResult& log : result.logs)
    for (const ChannelResult& c : log.channels) {
      if (c.signal != signal || !(c.rms > 0) || !std::isfinite(c.heldout_rms)) continue;
      ratios.push_back(c.heldout_rms / c.rms);
      if (ratios.back() > p.worst) p.worst = ratios.back(), p.log = &log;
    }
  if (ratios.empty()) return p;
  std::sort(ratios.begin(), ratios.end());
  p.usual = ratios[ratios.size() / 2];
  return p;
}

std::vector<Visible> best_of(const std::vector<Promise>& promises) {
  std::vector<Visible> best;
  for (const Promise& p : promises)
    for (std::size_t k = 0; k < p.faults.size(); ++k) {
      if (best.size() <= k)
        best.push_back(p.faults[k]), best.back().deviates_at_least = best.back().deviates_at_typical = 0;
      best[k].deviates_at_least =
          std::fmax(best[k].deviates_at_least, p.faults[k].deviates_at_least);  // NaN where a simulation failed
      best[k].deviates_at_typical = std::fmax(best[k].deviates_at_typical, p.faults[k].deviates_at_typical);
    }
  return best;
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

GoodEnough good_enough(const TuneResult& result, const std::vector<Promise>& promises, const BeyondFaults* likeliest) {
  GoodEnough g;
  std::vector<std::string> errors, worse, far;
  for (const ChannelResult& c : result.channels) {
    const std::string name = words(std::string(info(c.signal).name));
    if (c.noise_rms > 0 && std::isfinite(c.heldout_rms))
      errors.push_back(name + " " + digits(c.heldout_rms / c.noise_rms, 2));
    if (c.noise_rms > 0 && c.rms > follows * c.noise_rms)
      far.push_back(fmt::format("{} {} times", name, digits(c.rms / c.noise_rms, 2)));
    const Prediction p = prediction_of(result, c.signal);
    if (p.usual > predicts_worse)
      worse.push_back(fmt::format("{} {} times", name, digits(p.usual, 2)));
    else if (p.worst > predicts_worse)
      g.exceptions.push_back(fmt::format("{} of {} ({} times)", name, file_name(p.log->path), digits(p.worst, 2)));
  }
  if (!errors.empty()) g.errors = "error over noise on the held-out part: " + join(errors);
  if (result.interrupted) g.reasons.push_back("it was interrupted");
  if (!result.unfollowed.empty())
    g.reasons.push_back("the model does not follow these logs: " + unfollowed_in_words(result.unfollowed) +
                        (likeliest ? "; " + beyond_in_words(*likeliest) : ""));
  if (!far.empty())
    g.reasons.push_back("the model does not follow these logs (error over noise: " + join(far) +
                        "): check the rig file's data sheet (flow, areas, supply), signs and gains of sensors");
  if (!result.off_drawing.empty())
    g.reasons.push_back("what the data sheet states ended at the end of its range (" +
                        off_drawing_in_words(result.off_drawing) +
                        " the sheet's): something that the model lacks pulls; trust verdicts at small openings less");
  if (!worse.empty())
    g.reasons.push_back("it predicts worse than it fits (" + join(worse) + "): tune with more logs, of more kinds");
  if (!has_arrived(result) && !result.interrupted)
    g.reasons.push_back("the search has not arrived (" + end_in_words(result) + "): more --rounds");
  if (result.starts.size() > 1 && result.reached_best() < 2)
    g.reasons.push_back("no second start reached the best valley: more --generations");
  g.best = best_of(promises);
  for (const Visible& v : g.best) {
    if (!(v.deviates_at_typical >= seen))
      g.hidden.push_back(v.fault);
    else if (!(v.deviates_at_least >= seen))
      g.faint.push_back(v.fault);
  }
  if (!g.hidden.empty())
    g.reasons.push_back("on logs like these it would not see, even at typical size: " + join(g.hidden));
  g.trust = !result.unfollowed.empty() ? Trust::no : g.reasons.empty() ? Trust::yes : Trust::with_care;
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
