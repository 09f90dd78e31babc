// The rules of the forward selection: which causes are tried, which are judged on held-out data, which are refused,
// which of two does better. Pure functions of what was measured; no fit and no log is touched here.
//
// A cause has to be news: its size is unlike what healthy data show of it, or the data as a whole are left unlike
// healthy ones. Both questions share the level, half each. A rarer cause (prior below 1: a bare row, a part of the
// construction) has to do better than a commoner one.
#pragma once
#include <optional>
#include <vector>

#include "evidence/heldout_gain.h"
#include "explain/outcome.h"

namespace servodx {

// The data as a whole, before a round.
struct WholeEvidence {
  int accepted = 0;            // causes so far
  double level = 0;            // chance below which something is new, in this round
  bool compared = false;       // with how healthy data are left; else the next two mean nothing
  double level_of_shares = 0;  // chance of a share below which it is news; 0: not asked
  double p_left = 1;           // chance that healthy data are left as wrong
  double p_left_rows = 1;      // the same by the simulation's channels alone, without the blocks
};
// A second false alarm on the same data shall be as rare as two.
double level_of_round(double level, bool compared, int accepted);
bool is_abnormal(const WholeEvidence& whole);
// Not by its blocks alone.
bool has_abnormal_rows(const WholeEvidence& whole);

// A cause, scored.
struct ScoredEvidence {
  int cause = 0;
  bool looked_at = false;
  bool accepted_already = false;  // or it goes by a number of one that is
  double p_new = 1;               // chance that healthy data score it like this; 0 where none are there to compare
  double prior = 1;
  double predicted_gain = 0;  // of the deviance
};
bool is_news_by_itself(const ScoredEvidence& cause, const WholeEvidence& whole);
// By itself, or because the data are abnormal. Where they are not, what was found suffices, and a rare cause beside it
// only takes some of its size.
bool is_new(const ScoredEvidence& cause, const WholeEvidence& whole);

// By what it removes of the held-out misfit. Asked of the first cause alone, as of healthy data.
bool is_news_by_share(double p_share, const WholeEvidence& whole);

struct Budget {
  int named = 0, rare = 0, standing = 0;  // causes: new ones, new rare ones, and common ones that are no news
};
// Causes to fit, in order: what is new first, by itself before what is so because the data are abnormal; then by what
// it promises. One that promises less than its one number costs is not fitted.
std::vector<int> order_of_trial(const std::vector<ScoredEvidence>& causes, const WholeEvidence& whole, Budget budget,
                                double least_gain);

// A cause, fitted.
struct FittedEvidence {
  double prior = 1;
  bool is_new = false, news_by_itself = false;
  double delta_bic = 0;  // positive: worth its numbers
};
// Positions, in order of judging: the commoner first; of these the `leading` that gain most (of the rare half as many),
// be their sizes news or not, as a better answer would gain more; then what is news by itself; then by what they gain.
std::vector<int> order_of_judging(const std::vector<FittedEvidence>& fitted, int leading);
// Whether each is judged on held-out data, asked in order of judging.
class JudgingBudget {
 public:
  explicit JudgingBudget(int judged, int rare_share) : named_(judged), rare_(judged / rare_share) {}
  bool takes(const FittedEvidence& fitted);

 private:
  int named_, rare_;
};

// A cause, judged on held-out data.
struct JudgedEvidence {
  bool curve = false, is_new = false, news_by_itself = false;
  bool abnormal_rows = false;  // before it
  double p_left_rows = 1;      // chance that healthy data are left as wrong as with it
  double level = 0;
  bool beside_retuning = false;  // it has to gain on top of re-tuning
  double beyond_retuning = 0;    // held-out share that it removes there
  double heldout_lower = 0;      // lower end of the held-out share that it removes
  double least_share = 0;        // that it has to remove
  double share = 0;              // of the held-out misfit of what it speaks of
};
// Why it is not a candidate to be taken; none: it is.
std::optional<Fate> refusal_of(const JudgedEvidence& judged);

// Two judged causes, one beside the other.
struct Rivals {
  double first_prior = 1, second_prior = 1;
  bool first_suffices = false, second_suffices = false;  // it leaves the data as healthy ones are left
  double rarer_lower = 0;  // lower end of the held-out share that the rarer removes of what the commoner leaves
  double first_bic = 0, second_bic = 0;
};
// A rarer cause has to do better than a commoner one on held-out data, beyond the interval; and one that leaves the
// data as healthy ones are left need not be outdone.
bool first_is_better(const Rivals& rivals);
// A judged cause beside the best one.
struct InItsPlace {
  double best_lower = 0;  // lower end of the held-out share that the best removes of what the other leaves
  double best_bic = 0, other_bic = 0;
  bool both_named = false;  // neither is a bare row or a curve: healthy data were asked about such as they are
  bool other_is_new = false;
  double p_best_share = 0;  // chance that a healthy log shows such a share of some cause; 0: none was asked
};
// Whether it does as well in the best one's place: within the interval of the difference, or at odds below twenty to
// one. The odds are those of the noise and, where the other is news too, of what the model itself has wrong: a name
// gains a share like that on healthy logs too, where it is not there.
bool does_as_well(const InItsPlace& other);

// A cause is missed when the fit without it follows held-out data worse. `worth`: what it removes of that fit's.
bool is_missed(const Interval& worth);

}  // namespace servodx
