#include "explain/answer.h"

#include <cstddef>

#include "explain/constants.h"
#include "explain/fit_causes.h"
#include "explain/hold_out.h"
#include "explain/verdict.h"

namespace servodx {

ExplainedFit first_alone(const Inquiry& q, const FoundCauses& found) {
  if (found.causes.size() == 1) return found.after;
  const int first = found.causes.front().cause;
  ExplainedFit one = fit_causes(q.subject(), {first}, &found.before, &found.scores[static_cast<std::size_t>(first)],
                                explain_constants::base_iterations, false);
  if (one.ok) cross_validate(q.subject(), one, q.folds());
  return one;
}

double share_of_first(const Inquiry& q, const FoundCauses& found) {
  if (found.causes.size() == 1) return heldout_gain(found.before, found.after, q.options().seed).value;
  return found.candidates[static_cast<std::size_t>(found.causes.front().cause)].heldout_gain.value;
}

bool left_like_healthy(const Inquiry& q, const FoundCauses& found) {
  return q.test() && q.test()->any(q.subject().misses(found.after.residual)) > q.level();
}

double chance_left(const Inquiry& q, const FoundCauses& found) {
  return found.causes.empty() ? q.chance_left(found.before, true) : q.chance_left(found.after, false);
}

bool is_nameless(const Inquiry& q, const FoundCauses& found) {
  if (!q.test()) return false;
  EndEvidence e;
  e.compared = true;
  e.level = q.level();
  e.chance_left = chance_left(q, found);
  e.causes = found.causes.size();
  if (e.causes > 0) e.share_of_first = share_of_first(q, found);
  return has_no_name(e);
}

Answer find_names(Inquiry& q) {
  Answer answer;
  answer.found = explain(q.subject(), q.for_names());
  return answer;
}

}  // namespace servodx
