// Name and measure: which causes a subject's data ask for, and what each gains on data that the fit has not seen.
//
// 1. Score test (score.h): how much misfit each cause would remove.
// 2. The best few are fitted in full, everything else free again (fit_causes.h), and judged where they were not fitted
//    (hold_out.h): the free run over blocks of time that were left out in turn, beside re-tuning alone, which gets the
//    same.
// 3. Forward, the best first (forward.h); then each is left out again, and what is not missed stays out.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "evidence/heldout_gain.h"
#include "explain/cause_score.h"
#include "explain/constants.h"
#include "explain/fit_causes.h"
#include "explain/hold_out.h"
#include "explain/outcome.h"
#include "explain/subject.h"

namespace servodx {

struct CauseResult {
  int cause = 0;
  std::vector<double> value, std_error;  // [unit] of its numbers; NaN where a wall holds it
  Interval beyond_retuning;              // the same on top of re-tuning, or where the base's numbers hold, against it
  Interval heldout_gain;                 // fraction of the held-out misfit that it removes, 90 %
  double delta_bic = 0;                  // positive: worth its numbers
  double misfit_gain = 0;                // fall of the deviance when it was added
  std::vector<int> confusable_with;      // causes that do nearly as well in its place
  bool is_new = true;                    // false: healthy data show it as well
};

struct CandidateResult {
  int cause = 0;
  double predicted_gain = 0, p_new = 1;
  bool fitted = false;
  Interval heldout_gain, beyond_retuning;
  Interval share;  // of the held-out misfit of what it speaks of
  double delta_bic = 0;
  Fate fate = Fate::not_looked_at;
};

// What of a fit is compared with how healthy data are left: the rows of its residual, or beside these what the blocks
// miss, where the subject has blocks and no cause is accepted yet.
enum class LeftOf { rows_and_blocks, rows };

struct EngineOptions {
  std::uint64_t seed = 1;
  int folds = explain_constants::folds;
  int blocks = explain_constants::blocks;     // of time, over all logs together; a fold leaves out every `folds`-th
  int fitted = explain_constants::fitted;     // causes that are fitted, each round
  int judged = explain_constants::judged;     // of these, judged on held-out data; and half as many that are rarer
  int most = explain_constants::most_causes;  // causes accepted
  int iterations = explain_constants::base_iterations;  // of a fit
  std::function<bool()> stop;
  std::function<void(double)> progress;
  // Chance that healthy data score a cause like this, all causes counted together; empty: no healthy data, all is new.
  // `round`: causes accepted so far.
  std::function<double(const CauseScore&, int round)> p_new;
  // Chance that healthy data are left as wrong as by this fit; empty: not asked. Where it is small something is new,
  // and a cause need not be news by itself. `round`: causes accepted so far.
  std::function<double(const ExplainedFit&, LeftOf what, int round)> p_left;
  double level = explain_constants::alarm_by_mark;  // something is new below this; both questions share it
  // Chance that some cause removes a share of what healthy data miss, held out, that is as far above what is usual of it;
  // empty: not asked. Then a cause that is no news by its size is news by its share, where this lies below a level of
  // its own.
  std::function<double(const Cause&, double share)> p_share;
  double level_of_shares = 0;
  double least_share = 0;                   // of the held-out misfit: a cause that removes less is refused
  std::function<bool(const Cause&)> among;  // causes to look at; empty: all
  bool compare_with_retuning = true;        // where the base holds: what a cause gains beyond re-tuning

  Folds hold_out() const { return {folds, blocks}; }
  bool stopped() const { return stop && stop(); }
  void tell(double done) const {
    if (progress) progress(done);
  }
};

struct FoundCauses {
  ExplainedFit before, after;         // as tuned; with the causes
  ExplainedFit wide;                  // re-tuned alone
  Interval retuned;                   // its held-out gain
  std::vector<CauseResult> causes;    // new
  std::vector<CauseResult> standing;  // worth having, and healthy data show them too
  std::vector<CandidateResult> candidates;
  std::vector<ExplainedFit> refused;  // names that help, and leave the data abnormal
  std::vector<CauseScore> scores;     // at `before`
  double degrees = 0;                 // independent samples
};

// `begun`: an explanation of the same data among other causes, whose base fit serves again.
FoundCauses explain(Subject& subject, const EngineOptions& options, const FoundCauses* begun = nullptr);

}  // namespace servodx
