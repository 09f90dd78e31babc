#include "explain/engine.h"

#include <cstddef>
#include <utility>

#include "explain/deviance.h"
#include "explain/forward.h"

namespace servodx {
namespace {

ExplainedFit retuned_alone(const Subject& subject, const EngineOptions& options, const ExplainedFit& before) {
  ExplainedFit wide = fit_causes(subject, {}, &before, nullptr, explain_constants::full_iterations, false, true);
  if (wide.ok) cross_validate(subject, wide, options.hold_out());
  return wide;
}

// As tuned, re-tuned alone, and no cause yet.
void begin(Subject& subject, const EngineOptions& options, const FoundCauses* begun, FoundCauses& out) {
  if (!begun) cross_validate(subject, out.before, options.hold_out());
  options.tell(0.15);
  out.candidates.resize(subject.causes().size());
  for (std::size_t c = 0; c < out.candidates.size(); ++c) out.candidates[c].cause = static_cast<int>(c);
  if (begun)
    out.wide = begun->wide;
  else if (subject.retunes() && !subject.holds())
    out.wide = retuned_alone(subject, options, out.before);
  if (out.wide.ok) out.retuned = heldout_gain(out.before, out.wide, options.seed);
  options.tell(0.2);
}

// Numbers and gains with all that is left beside each other.
void size_up(const Subject& subject, const EngineOptions& options, Selected& selected, FoundCauses& out) {
  for (CauseResult& r : selected.causes) {
    CauseNumbers numbers = numbers_of(subject, selected.fit, r.cause);
    r.value = std::move(numbers.value), r.std_error = std::move(numbers.std_error);
  }
  if (selected.causes.size() == 1 && selected.rounds > 1) {  // what came before it is out again
    selected.causes.front().heldout_gain = heldout_gain(out.before, selected.fit, options.seed);
    selected.causes.front().delta_bic = delta_bic(out.before, selected.fit, out.degrees);
  }
  out.causes = std::move(selected.causes);
  out.after = std::move(selected.fit);
}

// Where healthy data say that the base holds, re-tuning is only reported beside what was found.
void compare_with_retuning(const Subject& subject, const EngineOptions& options, FoundCauses& out) {
  if (!options.compare_with_retuning || out.causes.empty() || !subject.retunes() || !subject.holds() ||
      options.stopped())
    return;
  if (!out.wide.ok) out.wide = retuned_alone(subject, options, out.before);
  if (!out.wide.ok) return;
  out.retuned = heldout_gain(out.before, out.wide, options.seed);
  for (CauseResult& r : out.causes) r.beyond_retuning = heldout_gain(out.wide, out.after, options.seed);
}

}  // namespace

FoundCauses explain(Subject& subject, const EngineOptions& options, const FoundCauses* begun) {
  FoundCauses out;
  out.before = begun ? begun->before : fit_base(subject, options.iterations);
  options.tell(0.1);
  out.after = out.before;
  out.degrees = degrees_of(subject);
  if (!out.before.ok || options.stopped()) return out;
  begin(subject, options, begun, out);
  Selected selected{out.before, out.wide, {}, 0};
  while (selected.rounds < options.most && !options.stopped())
    if (!accept_one_more(subject, options, begun != nullptr, selected, out)) break;
  leave_out_again(subject, options, selected, out);
  size_up(subject, options, selected, out);
  compare_with_retuning(subject, options, out);
  options.tell(0.85);
  return out;
}

}  // namespace servodx
