#include <cstddef>
#include <utility>

#include "explain/answer.h"
#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/hold_out.h"
#include "explain/inquiry.h"
#include "explain/learnt_curves.h"
#include "explain/outcome.h"

namespace servodx {
namespace {

bool is_asked(const Inquiry& q, const Answer& answer) {
  const FoundCauses& names = answer.found;
  if (!names.before.ok) return false;
  return names.causes.empty() || answer.first_is_rare(q) || (q.test() && !left_like_healthy(q, names));
}

bool does_better(const Inquiry& q, const Answer& answer, const FoundCauses& curve) {
  if (curve.causes.empty()) return false;
  if (answer.found.causes.empty()) return true;
  const bool rare = answer.first_is_rare(q);
  const ExplainedFit name = rare ? first_alone(q, answer.found) : answer.found.after;
  if (!name.ok) return true;
  const std::uint64_t seed = q.options().seed;
  return rare ? heldout_gain(curve.after, name, seed).lower <= 0 : heldout_gain(name, curve.after, seed).lower > 0;
}

void keep_fates_of_names(const Inquiry& q, const FoundCauses& names, FoundCauses& curve) {
  for (std::size_t c = 0; c < names.candidates.size(); ++c) {
    if (q.cause(static_cast<int>(c)).curve) continue;
    curve.candidates[c] = names.candidates[c];
    if (names.candidates[c].fate == Fate::taken) curve.candidates[c].fate = Fate::curve_does_better;
  }
}

// Names that were refused because they leave the logs abnormal: where the curve does no better they are as good an
// answer as it, and where one does better the place is that name's.
void ask_refused_names(const Inquiry& q, const FoundCauses& names, Answer& curve) {
  double most = 0;
  for (const ExplainedFit& name : names.refused) {
    const int c = name.causes.back();
    if (heldout_gain(name, curve.found.after, q.options().seed).lower > 0) continue;
    curve.found.causes.front().confusable_with.push_back(c);
    const double more = heldout_gain(curve.found.after, name, q.options().seed).value;
    if (more > most) most = more, curve.better_place = q.cause(c).where;
  }
}

}  // namespace

void try_curves(Inquiry& q, Answer& answer) {
  if (!is_asked(q, answer)) return;
  guess_curves(q.subject(), q.curves(), answer.found.before.point);
  FoundCauses curve = explain(q.subject(), q.for_curves(), &answer.found);
  answer.curve_scores = curve.scores;
  if (!does_better(q, answer, curve)) return;
  keep_fates_of_names(q, answer.found, curve);
  FoundCauses names = std::move(answer.found);
  answer.found = std::move(curve);
  ask_refused_names(q, names, answer);
  answer.found.standing = std::move(names.standing);
  const CauseResult& r = answer.found.causes.front();
  answer.curve = learnt(q.curve_of(r.cause), r.value, r.std_error);
}

}  // namespace servodx
