#include "explain/forward.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "evidence/heldout_gain.h"
#include "explain/cause_score.h"
#include "explain/constants.h"
#include "explain/deviance.h"
#include "explain/forward_rules.h"
#include "explain/hold_out.h"
#include "explain/outcome.h"
#include "explain/score.h"
#include "simulate/together.h"

namespace servodx {
namespace {

using namespace explain_constants;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// What a round begins with.
struct Round {
  std::vector<CauseScore> scores;  // [cause]
  WholeEvidence whole;
  std::vector<ScoredEvidence> evidence;  // [cause]
};

// A cause that was tried: the fit with it, and what it gains.
struct Trial {
  ExplainedFit fit;
  ExplainedFit retuned;  // the same on top of re-tuning
  Interval heldout_gain, beyond_retuning, share;
  double delta_bic = 0;
  bool measured = false;
  bool is_new = false;  // by its size, by its share, or because the data are abnormal
  bool stands = false;  // judged, and not refused

  int cause() const { return fit.causes.back(); }
};

// In already, or it goes by a number of one that is: two names of one number would leave the first without a say.
bool is_in(const Subject& subject, const std::vector<int>& accepted, int cause) {
  const std::vector<Number>& its = subject.causes()[at(cause)].numbers;
  return std::any_of(accepted.begin(), accepted.end(), [&](int other) {
    const std::vector<Number>& others = subject.causes()[at(other)].numbers;
    return other == cause || std::any_of(its.begin(), its.end(), [&](const Number& a) {
             return std::any_of(others.begin(), others.end(), [&](const Number& b) { return a.name == b.name; });
           });
  });
}

WholeEvidence whole_before(const EngineOptions& options, const Selected& so_far) {
  WholeEvidence w;
  w.accepted = so_far.rounds;
  w.compared = static_cast<bool>(options.p_left);
  w.level = level_of_round(options.level, w.compared, w.accepted);
  if (options.p_share) w.level_of_shares = options.level_of_shares;
  if (w.compared) w.p_left = options.p_left(so_far.fit, LeftOf::rows_and_blocks, so_far.rounds);
  if (is_abnormal(w)) w.p_left_rows = options.p_left(so_far.fit, LeftOf::rows, so_far.rounds);
  return w;
}

Round look(const Subject& subject, const EngineOptions& options, const Selected& so_far, FoundCauses& out) {
  Round round;
  round.scores = score_causes(subject, so_far.fit, options.among);
  if (so_far.rounds == 0) out.scores = round.scores;
  round.whole = whole_before(options, so_far);
  for (std::size_t c = 0; c < round.scores.size(); ++c) {
    const CauseScore& score = round.scores[c];
    ScoredEvidence& e = round.evidence.emplace_back();
    e.cause = score.cause;
    e.looked_at = !score.probes.empty();
    e.accepted_already = is_in(subject, so_far.fit.causes, score.cause);
    e.prior = subject.causes()[c].prior;
    e.predicted_gain = score.gain;
    e.p_new = options.p_new ? 1.0 : 0.0;
    if (!e.looked_at) continue;
    if (options.p_new) e.p_new = options.p_new(score, so_far.rounds);
    if (so_far.rounds > 0) continue;
    CandidateResult& r = out.candidates[c];
    r.predicted_gain = score.gain, r.p_new = e.p_new, r.fate = Fate::score_too_small;
  }
  return round;
}

// Of a round's work, in the progress.
struct Share {
  int round;
  double from, to;
};
constexpr double part_of_fits = 0.65;  // the rest is judging's; by hand: nothing hangs on it

// Fits that share nothing, side by side in the same packs. What a stop cuts short is left as it was.
void fit_together(const Subject& subject, const EngineOptions& options, const Share& share, std::size_t fits,
                  const std::function<void(std::size_t)>& fit) {
  std::atomic<std::size_t> done = 0;
  std::size_t told = 0;
  const std::vector<long> samples = samples_of_logs(subject);
  const auto go_on = [&] {
    if (const std::size_t now = done; now != std::exchange(told, now)) {
      const double part = share.from + (share.to - share.from) * static_cast<double>(now) / static_cast<double>(fits);
      options.tell(0.15 + 0.6 * (share.round + part) / options.most);
    }
    return !options.stopped();
  };
  fits_together(
      static_cast<int>(fits), static_cast<std::size_t>(std::accumulate(samples.begin(), samples.end(), 0L)),
      subject.threads(),
      [&](int i) {
        fit(at(i));
        ++done;
      },
      go_on);
}

// The first round also fits a few that are no news: what stands in healthy data is said.
std::vector<Trial> fit_best(const Subject& subject, const EngineOptions& options, bool begun, const Round& round,
                            const Selected& so_far, double degrees) {
  const bool standing = so_far.rounds == 0 && options.p_new && !begun;
  const int old = options.p_share ? options.fitted : standing_tried;
  const Budget budget{options.fitted, options.fitted / rare_share, standing ? old : 0};
  std::vector<Trial> out;
  const std::vector<int> order = order_of_trial(round.evidence, round.whole, budget, std::log(std::max(2.0, degrees)));
  std::vector<ExplainedFit> fits(order.size());
  fit_together(subject, options, {so_far.rounds, 0, part_of_fits}, fits.size(), [&](std::size_t i) {
    std::vector<int> causes = so_far.fit.causes;
    causes.push_back(order[i]);
    fits[i] = fit_causes(subject, causes, &so_far.fit, &round.scores[at(order[i])], quick_iterations, true);
  });
  for (ExplainedFit& f : fits)
    if (f.ok) out.emplace_back().fit = std::move(f);
  for (Trial& t : out) t.delta_bic = delta_bic(so_far.fit, t.fit, degrees);
  return out;
}

// In full, on data that it has not seen, and on top of re-tuning.
void measure_trial(const Subject& subject, const EngineOptions& options, const Round& round, const Selected& so_far,
                   double degrees, Trial& t) {
  ExplainedFit whole = fit_causes(subject, t.fit.causes, &t.fit, nullptr, full_iterations, false);
  if (whole.ok && whole.deviance < t.fit.deviance) t.fit = std::move(whole);
  t.delta_bic = delta_bic(so_far.fit, t.fit, degrees);
  cross_validate(subject, t.fit, options.hold_out());
  t.heldout_gain = heldout_gain(so_far.fit, t.fit, options.seed);
  t.share = heldout_share(subject, subject.causes()[at(t.cause())], so_far.fit, t.fit, options.seed);
  if (!so_far.retuned.ok) return;
  const CauseScore& score = round.scores[at(t.cause())];
  t.retuned = fit_causes(subject, t.fit.causes, &so_far.retuned, &score, quick_iterations, true);
  if (!t.retuned.ok) return;
  cross_validate(subject, t.retuned, options.hold_out());
  t.beyond_retuning = heldout_gain(so_far.retuned, t.retuned, options.seed);
}

FittedEvidence fitted_evidence(const Round& round, const Trial& t) {
  const ScoredEvidence& c = round.evidence[at(t.cause())];
  return {c.prior, is_new(c, round.whole), is_news_by_itself(c, round.whole), t.delta_bic};
}

void measure_best(const Subject& subject, const EngineOptions& options, const Round& round, const Selected& so_far,
                  double degrees, std::vector<Trial>& trials) {
  JudgingBudget budget(options.judged, rare_share);
  std::vector<Trial*> best;
  for (Trial& t : trials)
    if (budget.takes(fitted_evidence(round, t))) best.push_back(&t);
  const auto measure_one = [&](std::size_t i) {
    Trial t = *best[i];
    measure_trial(subject, options, round, so_far, degrees, t);
    t.measured = true;
    *best[i] = std::move(t);
  };
  // With the rows free, a Jacobian has so many columns that they follow the run (simulate_near), which needs all packs.
  if (subject.holds())
    return fit_together(subject, options, {so_far.rounds, part_of_fits, 1}, best.size(), measure_one);
  for (std::size_t i = 0; i < best.size() && !options.stopped(); ++i) measure_one(i);
}

bool is_named(const Cause& c) { return !c.curve && !is_rare(c); }

// Healthy data are asked the same of the causes that have a name.
bool share_is_news(const Subject& subject, const EngineOptions& options, const Round& round, const Trial& t) {
  return options.p_share && is_named(subject.causes()[at(t.cause())]) &&
         is_news_by_share(options.p_share(subject.causes()[at(t.cause())], t.share.value), round.whole);
}

JudgedEvidence judged_evidence(const Subject& subject, const EngineOptions& options, const Round& round,
                               const Selected& so_far, const Trial& t) {
  const FittedEvidence f = fitted_evidence(round, t);
  const bool by_share = share_is_news(subject, options, round, t);
  JudgedEvidence j;
  j.curve = subject.causes()[at(t.cause())].curve;
  j.is_new = f.is_new || by_share, j.news_by_itself = f.news_by_itself || by_share;
  j.least_share = options.least_share;
  j.share = t.share.value;
  j.abnormal_rows = has_abnormal_rows(round.whole);
  j.level = round.whole.level;
  if (j.abnormal_rows) j.p_left_rows = options.p_left(t.fit, LeftOf::rows, so_far.rounds);
  j.beside_retuning = so_far.retuned.ok;
  j.beyond_retuning = t.beyond_retuning.value;
  j.heldout_lower = t.heldout_gain.lower;
  return j;
}

// The best are measured, in order of judging, which is the order that they are left in.
void judge(const Subject& subject, const EngineOptions& options, const Round& round, const Selected& so_far,
           std::vector<Trial>& trials, FoundCauses& out) {
  std::vector<FittedEvidence> evidence;
  for (const Trial& t : trials) evidence.push_back(fitted_evidence(round, t));
  std::vector<Trial> ordered;
  for (int i : order_of_judging(evidence, leading)) ordered.push_back(std::move(trials[at(i)]));
  trials = std::move(ordered);
  measure_best(subject, options, round, so_far, out.degrees, trials);
  for (Trial& t : trials) {
    CandidateResult later, &r = so_far.rounds == 0 ? out.candidates[at(t.cause())] : later;
    r.fitted = true;
    r.delta_bic = t.delta_bic;
    r.fate = t.delta_bic <= 0 ? Fate::not_worth_its_numbers : Fate::others_fit_better;
    if (!t.measured) continue;
    r.delta_bic = t.delta_bic, r.heldout_gain = t.heldout_gain, r.beyond_retuning = t.beyond_retuning,
    r.share = t.share;
    const JudgedEvidence judged = judged_evidence(subject, options, round, so_far, t);
    const std::optional<Fate> refused = refusal_of(judged);
    t.is_new = judged.is_new;
    t.stands = !refused;
    if (refused) r.fate = *refused;
    if (refused == Fate::abnormal_with_it && so_far.rounds == 0 && t.heldout_gain.lower > 0)
      out.refused.push_back(t.fit);
  }
}

CauseResult result_of(const Subject& subject, const Selected& so_far, const Trial& t, bool fresh) {
  CauseResult r;
  r.cause = t.cause();
  r.is_new = fresh;
  r.heldout_gain = t.heldout_gain;
  r.delta_bic = t.delta_bic;
  r.misfit_gain = so_far.fit.deviance - t.fit.deviance;
  r.beyond_retuning = t.beyond_retuning;
  CauseNumbers numbers = numbers_of(subject, t.fit, r.cause);
  r.value = std::move(numbers.value), r.std_error = std::move(numbers.std_error);
  return r;
}

Rivals rivals(const EngineOptions& options, const Round& round, const Selected& so_far, const Trial& first,
              const Trial& second) {
  const auto suffices = [&](const Trial& t) {
    return options.p_left && options.p_left(t.fit, LeftOf::rows, so_far.rounds) > round.whole.level;
  };
  Rivals r;
  r.first_prior = round.evidence[at(first.cause())].prior, r.second_prior = round.evidence[at(second.cause())].prior;
  r.first_bic = first.delta_bic, r.second_bic = second.delta_bic;
  if (r.first_prior == r.second_prior) return r;
  const bool first_is_rarer = r.first_prior < r.second_prior;
  const Trial &rarer = first_is_rarer ? first : second, &commoner = first_is_rarer ? second : first;
  r.first_suffices = suffices(first), r.second_suffices = suffices(second);
  r.rarer_lower = heldout_gain(commoner.fit, rarer.fit, options.seed).lower;
  return r;
}

// The best of what is new; null: none stands.
Trial* best_trial(const EngineOptions& options, const Round& round, const Selected& so_far,
                  std::vector<Trial>& trials) {
  Trial* best = nullptr;
  for (Trial& t : trials)
    if (t.stands && t.is_new)
      if (!best || first_is_better(rivals(options, round, so_far, t, *best))) best = &t;
  return best;
}

// Something is new, so one whose size healthy data show as well may be what it is.
std::vector<int> in_place_of(const Subject& subject, const EngineOptions& options, const Trial& best,
                             const std::vector<Trial>& trials) {
  std::vector<int> out;
  for (const Trial& t : trials) {
    if (!t.stands || &t == &best) continue;
    InItsPlace o;
    o.best_lower = heldout_gain(t.fit, best.fit, options.seed).lower;
    o.best_bic = best.delta_bic, o.other_bic = t.delta_bic;
    const Cause& its = subject.causes()[at(best.cause())];
    o.both_named = is_named(its) && is_named(subject.causes()[at(t.cause())]);
    o.other_is_new = t.is_new;
    if (options.p_share)
      o.p_best_share = options.p_share(its, heldout_share(subject, its, t.fit, best.fit, options.seed).value);
    if (does_as_well(o)) out.push_back(t.cause());
  }
  return out;
}

}  // namespace

double delta_bic(const ExplainedFit& before, const ExplainedFit& after, double degrees) {
  const double numbers = static_cast<double>(after.fit.numbers.size()) - static_cast<double>(before.fit.numbers.size());
  return before.deviance - after.deviance - numbers * std::log(std::max(2.0, degrees));
}

bool accept_one_more(const Subject& subject, const EngineOptions& options, bool begun, Selected& so_far,
                     FoundCauses& out) {
  const Round round = look(subject, options, so_far, out);
  std::vector<Trial> trials = fit_best(subject, options, begun, round, so_far, out.degrees);
  judge(subject, options, round, so_far, trials, out);
  for (const Trial& t : trials)
    if (t.stands && !t.is_new) {
      out.candidates[at(t.cause())].fate = Fate::not_beyond_healthy;
      out.standing.push_back(result_of(subject, so_far, t, false));
    }
  Trial* best = best_trial(options, round, so_far, trials);
  if (!best) return false;
  CauseResult accepted = result_of(subject, so_far, *best, true);
  accepted.confusable_with = in_place_of(subject, options, *best, trials);
  out.candidates[at(accepted.cause)].fate = Fate::taken;
  so_far.causes.push_back(std::move(accepted));
  so_far.fit = std::move(best->fit);
  if (so_far.retuned.ok) so_far.retuned = std::move(best->retuned);
  ++so_far.rounds;
  return true;
}

void leave_out_again(const Subject& subject, const EngineOptions& options, Selected& so_far, FoundCauses& out) {
  for (std::size_t i = 0; so_far.causes.size() > 1 && i + 1 < so_far.causes.size() && !options.stopped();) {
    std::vector<int> without = so_far.fit.causes;
    std::erase(without, so_far.causes[i].cause);
    ExplainedFit f = fit_causes(subject, without, &so_far.fit, nullptr, full_iterations, false);
    if (f.ok) cross_validate(subject, f, options.hold_out());
    const Interval worth = f.ok ? heldout_gain(f, so_far.fit, options.seed) : Interval{1, 1, 1};
    if (is_missed(worth)) {
      so_far.causes[i].heldout_gain = worth;
      ++i;
      continue;
    }
    out.candidates[at(so_far.causes[i].cause)].fate = Fate::not_missed_later;
    so_far.causes.erase(so_far.causes.begin() + static_cast<long>(i));
    so_far.fit = std::move(f);
  }
}

}  // namespace servodx
