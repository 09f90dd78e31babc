#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "explain/answer.h"
#include "explain/block_replay.h"
#include "explain/cause_sizes.h"
#include "explain/constants.h"
#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/healthy.h"
#include "explain/hold_out.h"
#include "explain/inquiry.h"
#include "explain/outcome.h"
#include "explain/subject.h"

namespace servodx {
namespace {

using explain_constants::base_iterations, explain_constants::both_questions, explain_constants::most_of_it;

// Either, or what does as well in its place, is the other or what does as well in its.
bool share_a_name(const CauseResult& a, const CauseResult& b) {
  const auto names = [](const CauseResult& r) {
    std::vector<int> out = r.confusable_with;
    out.push_back(r.cause);
    return out;
  };
  const std::vector<int> of_a = names(a), of_b = names(b);
  return std::find_first_of(of_a.begin(), of_a.end(), of_b.begin(), of_b.end()) != of_a.end();
}

// The replay's question to healthy logs, and the free run's answer beside it.
class BlocksInquiry {
 public:
  BlocksInquiry(Inquiry& q, Answer& answer) : q_(q), answer_(answer), sizes_(q.logs().size()) {
    for (std::size_t l = 0; l < q.lone().size(); ++l)
      if (const LoneLog& lone = q.lone()[l]; lone.fit.ok)
        sizes_[l] = score_blocks(lone.subject, lone.fit.point, *q.known()).scores;
    engine_.seed = q.options().seed, engine_.stop = q.options().watch.stop, engine_.level = q.level();
    engine_.p_new = chance_of_size(*q.test(), *answer.blocks, sizes_);
    // Beside the question of the free run, which has most of its share.
    engine_.p_left = [this](const ExplainedFit& fit, LeftOf, int) {  // its rows are the blocks'
      return std::min(1.0, q_.test()->any(answer_.blocks->misses(fit.residual)) / both_questions);
    };
  }
  BlocksInquiry(const BlocksInquiry&) = delete;
  BlocksInquiry& operator=(const BlocksInquiry&) = delete;

  FoundCauses names() {
    engine_.among = [this](const Cause& c) { return q_.has_name(c); };
    return explain(*answer_.blocks, engine_);
  }
  FoundCauses curves(const FoundCauses& begun) {
    engine_.among = [](const Cause& c) { return c.curve; };
    engine_.most = 1;
    return explain(*answer_.blocks, engine_, &begun);
  }
  bool left_like_healthy(const FoundCauses& told) const {
    return q_.test()->any(answer_.blocks->misses(told.after.residual)) > q_.level();
  }
  // What was told, held in the free run.
  ExplainedFit held(const FoundCauses& told) const {
    ExplainedFit after = hold_causes(q_.subject(), told.after.causes, numbers_of_causes(*answer_.blocks, told.after),
                                     answer_.found.before, base_iterations);
    if (after.ok) cross_validate(q_.subject(), after, q_.folds());
    return after;
  }

 private:
  Inquiry& q_;
  Answer& answer_;
  SizesByLog sizes_;
  EngineOptions engine_;
};

void take(Answer& answer, FoundCauses& told, ExplainedFit after) {
  FoundCauses& found = answer.found;
  answer.told_by_blocks = true;
  for (const CauseResult& r : found.causes)
    found.candidates[static_cast<std::size_t>(r.cause)].fate = Fate::blocks_tell_another;
  found.after = std::move(after);
  found.causes = std::move(told.causes);
  for (const CauseResult& r : found.causes)
    found.candidates[static_cast<std::size_t>(r.cause)].fate = Fate::taken_by_blocks;
  answer.curve.reset();
  answer.better_place.clear();
}

// Nothing has a name yet, or not one that leaves the logs as healthy ones are left.
bool is_open(const Inquiry& q, const Answer& answer) {
  const FoundCauses& found = answer.found;
  if (found.causes.empty() || answer.curve || answer.first_is_rare(q)) return true;
  return q.test() && !left_like_healthy(q, found) && share_of_first(q, found) < most_of_it;
}

// Where something is wrong without a name, a curve that the blocks tell serves if the free run finds none, or follows
// better with it than with its own. A rare cause has to do better, as beside the free run's.
void try_curve_of_blocks(Inquiry& q, Answer& answer, BlocksInquiry& blocks, const FoundCauses& told, bool rare) {
  FoundCauses shape = blocks.curves(told);
  if (shape.causes.empty()) return;
  ExplainedFit after = blocks.held(shape);
  if (!after.ok) return;
  const FoundCauses& found = answer.found;
  const std::uint64_t seed = q.options().seed;
  if (heldout_gain(answer.curve ? found.after : found.before, after, seed).lower <= 0) return;
  if (rare && !answer.curve && heldout_gain(after, first_alone(q, found), seed).lower > 0) return;
  const CauseResult r = shape.causes.front();
  take(answer, shape, std::move(after));
  answer.curve = learnt(q.curve_of(r.cause), r.value, r.std_error);
}

}  // namespace

void ask_blocks(Inquiry& q, Answer& answer) {
  const FoundCauses& found = answer.found;
  if (!q.test() || !found.before.ok) return;
  const bool rare = answer.first_is_rare(q) && !answer.curve, open = is_open(q, answer);
  if (!open && found.causes.front().confusable_with.empty()) return;
  answer.blocks = std::make_unique<ReplaySubject>(q.subject(), found.before.point, *q.known());
  if (answer.blocks->empty()) return;
  BlocksInquiry blocks(q, answer);
  FoundCauses told = blocks.names();
  const bool stands = !told.causes.empty() && blocks.left_like_healthy(told);
  if (stands && (open || share_a_name(told.causes.front(), found.causes.front())))
    if (ExplainedFit after = blocks.held(told); after.ok) take(answer, told, std::move(after));
  if (answer.told_by_blocks || !told.before.ok) return;
  if (answer.curve || rare || is_nameless(q, found)) try_curve_of_blocks(q, answer, blocks, told, rare);
}

}  // namespace servodx
