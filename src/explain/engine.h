// Name and measure: which causes a subject's data ask for, and what each gains on data that the fit has not seen.
//
// 1. Score test (Rao 1948): at the fit without a cause, the change that a probe of its size makes in the residual, less
//    what the free numbers can imitate, says how much misfit the cause would remove. All causes cost a few runs each.
// 2. The best few are fitted in full, everything else free again, and judged where they were not fitted: the free run
//    over blocks of time that were left out in turn, beside re-tuning alone, which gets the same.
// 3. Forward, the best first; then each is left out again, and what is not missed stays out.
// Held-out gains carry a block-bootstrap interval: residuals are correlated, blocks hardly.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "explain/outcome.h"
#include "explain/subject.h"

namespace servodx {

// Of one probe of a cause: its size in units of the probe, with what the free numbers cannot imitate.
struct ProbeScore {
  double size = 0, std_error = 0;  // [of the probe]
};
struct CauseScore {
  int cause = 0;
  double gain = 0;                 // predicted fall of the deviance
  int alternative = 0;             // of its probes
  std::vector<ProbeScore> probes;  // all of them, alternatives one after another
  double of = 1;                   // what it is a factor on: mean of the base's numbers that it is atop of
};

struct Interval {
  double value = 0, lower = 0, upper = 0;
};

// A fit with some causes in it.
struct ExplainedFit {
  bool wide = false;  // re-tuned
  std::vector<int> causes;
  SubjectFit fit;
  bool ok = false;
  Point point;
  double misfit = 0;    // sum of squares, priors included
  double deviance = 0;  // -2 log likelihood where a channel may err more than is usual: deviance_of
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  std::vector<std::vector<double>>
      heldout;                       // [block][series]: sum of squared rows of blocks that were left out in turn
  Eigen::VectorXd heldout_residual;  // physical, each block's from the fit that had not seen it
};

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
  double delta_bic = 0;
  Fate fate = Fate::not_looked_at;
};

struct EngineOptions {
  std::uint64_t seed = 1;
  int folds = 5;
  int blocks = 15;      // of time, over all logs together; a fold leaves out every `folds`-th
  int fitted = 8;       // causes that are fitted, each round
  int judged = 4;       // of these, judged on held-out data; and half as many that are rarer than others
  int most = 3;         // causes accepted
  int iterations = 12;  // of a fit
  const std::atomic<bool>* stop = nullptr;
  std::function<void(double)> progress;
  // Chance that healthy data score a cause like this, all causes counted together; empty: no healthy data, all is new.
  // `round`: causes accepted so far.
  std::function<double(const CauseScore&, int round)> p_new;
  // Chance that healthy data are left as wrong as by this fit; empty: not asked. Where it is small something is new,
  // and a cause need not be news by itself.
  std::function<double(const ExplainedFit&, int round)> p_left;
  double level = 0.05;                      // something is new below this; both questions share it
  std::function<bool(const Cause&)> among;  // causes to look at; empty: all
};

struct Explanation {
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

// The fit with these causes, from where `from` got to, the last one from where its score says. Quick: what was free in
// `from` keeps its derivatives. Re-tuned where `from` is, or where `wide` asks for it.
ExplainedFit fit_causes(const Subject& subject, const std::vector<int>& causes, const ExplainedFit* from,
                        const CauseScore* score, int iterations, bool quick, bool wide = false);
// Re-tuned alone; then the weights are what is left of it, and it is re-tuned with these.
ExplainedFit fit_base(Subject& subject, int iterations);
// The fit with these causes held at `numbers`, theirs one after another: what is free beside them, from where `from`
// is. A cause's columns of the Jacobian are zero.
ExplainedFit hold_causes(const Subject& subject, const std::vector<int>& causes, const Point& numbers,
                         const ExplainedFit& from, int iterations);
// A score for each cause; without probes where `among` does not let it through. Empty: all.
std::vector<CauseScore> score_causes(const Subject& subject, const ExplainedFit& at,
                                     const std::function<bool(const Cause&)>& among = {});
// The numbers of a fit's causes, one after another.
Point numbers_of_causes(const Subject& subject, const ExplainedFit& fit);
// Fills heldout.
void cross_validate(const Subject& subject, ExplainedFit& fit, const EngineOptions& options);
// Fraction of `before`'s held-out misfit that `after` removes, with its block-bootstrap interval (90 %).
Interval heldout_gain(const ExplainedFit& before, const ExplainedFit& after, std::uint64_t seed);
double degrees_of(const Subject& subject);
// -2 log likelihood of a residual, rows of the priors included, each channel's variance unknown but not below what is
// usual for it. A sum of squares would drown the names of a large effect: one that leaves a hundredth of the square
// does far better than one that leaves a tenth, and by hardly more of the sum.
double deviance_of(const Subject& subject, const Eigen::VectorXd& residual);

// `begun`: an explanation of the same data among other causes, whose base fit serves again.
Explanation explain(Subject& subject, const EngineOptions& options, const Explanation* begun = nullptr);

}  // namespace servodx
