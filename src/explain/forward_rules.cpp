#include "explain/forward_rules.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "explain/constants.h"
#include "explain/subject.h"

namespace servodx {
namespace {

using namespace explain_constants;

}  // namespace

double level_of_round(double level, bool compared, int accepted) {
  const double share = compared ? both_questions * level : level;
  return accepted == 0 ? share : share * share;
}

bool is_abnormal(const WholeEvidence& w) { return w.compared && w.p_left <= w.level; }
bool has_abnormal_rows(const WholeEvidence& w) { return is_abnormal(w) && w.p_left_rows <= w.level; }

bool is_news_by_itself(const ScoredEvidence& c, const WholeEvidence& w) { return c.p_new <= w.level; }

bool is_new(const ScoredEvidence& c, const WholeEvidence& w) {
  if (!c.looked_at) return false;
  const bool found_suffices = w.accepted > 0 && w.compared && !is_abnormal(w);
  if (found_suffices && is_rare(c.prior)) return false;
  return is_news_by_itself(c, w) || is_abnormal(w);
}

bool is_news_by_share(double p_share, const WholeEvidence& w) {
  return w.accepted == 0 && p_share <= w.level_of_shares;
}

std::vector<int> order_of_trial(const std::vector<ScoredEvidence>& causes, const WholeEvidence& whole, Budget budget,
                                double least_gain) {
  std::vector<ScoredEvidence> order = causes;
  std::stable_sort(order.begin(), order.end(), [&](const ScoredEvidence& a, const ScoredEvidence& b) {
    const bool a_new = is_new(a, whole), b_new = is_new(b, whole);
    if (a_new != b_new) return a_new;
    if (a_new && is_news_by_itself(a, whole) != is_news_by_itself(b, whole)) return is_news_by_itself(a, whole);
    return a.predicted_gain > b.predicted_gain;
  });
  std::vector<int> out;
  for (const ScoredEvidence& c : order) {
    if (!c.looked_at || c.accepted_already || c.predicted_gain < least_gain) continue;
    const bool is_old = !is_new(c, whole);
    if (is_old && is_rare(c.prior)) continue;
    int& left = is_old ? budget.standing : is_rare(c.prior) ? budget.rare : budget.named;
    if (left-- > 0) out.push_back(c.cause);
  }
  return out;
}

std::vector<int> order_of_judging(const std::vector<FittedEvidence>& fitted, int leading) {
  std::vector<int> order(fitted.size());
  std::iota(order.begin(), order.end(), 0);
  const auto of = [&](int i) -> const FittedEvidence& { return fitted[static_cast<std::size_t>(i)]; };
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
    return of(i).prior != of(j).prior ? of(i).prior > of(j).prior : of(i).delta_bic > of(j).delta_bic;
  });
  for (auto first = order.begin(); first != order.end();) {
    const auto end = std::find_if(first, order.end(), [&](int i) { return of(i).prior != of(*first).prior; });
    const int leads = is_rare(of(*first).prior) ? leading / rare_share : leading;
    if (end - first > leads) std::stable_partition(first + leads, end, [&](int i) { return of(i).news_by_itself; });
    first = end;
  }
  return order;
}

bool JudgingBudget::takes(const FittedEvidence& f) {
  if (f.delta_bic <= 0) return false;
  return (is_rare(f.prior) ? rare_ : named_)-- > 0;
}

std::optional<Fate> refusal_of(const JudgedEvidence& j) {
  // A name that is not news by itself has to be what makes the data abnormal.
  const bool has_to_restore = !j.curve && !j.news_by_itself && j.is_new && j.abnormal_rows;
  if (has_to_restore && !(j.p_left_rows > j.level)) return Fate::abnormal_with_it;
  if (j.beside_retuning && j.beyond_retuning <= 0) return Fate::retuning_does_as_well;
  if (!(j.heldout_lower > 0)) return Fate::no_heldout_gain;
  if (j.share < j.least_share) return Fate::removes_too_little;
  return {};
}

bool first_is_better(const Rivals& r) {
  if (r.first_prior < r.second_prior) return !r.second_suffices && r.rarer_lower > 0;
  if (r.first_prior > r.second_prior) return r.first_suffices || r.rarer_lower <= 0;
  return r.first_bic > r.second_bic;
}

bool does_as_well(const InItsPlace& o) {
  if (o.best_lower <= 0 || o.best_bic - o.other_bic < odds) return true;
  return o.both_named && o.other_is_new && o.p_best_share > chance_at_odds;
}

bool is_missed(const Interval& worth) { return worth.lower > 0; }

}  // namespace servodx
