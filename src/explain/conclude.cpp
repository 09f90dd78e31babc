#include "explain/conclude.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evidence/posterior.h"
#include "evidence/tail_law.h"
#include "explain/blocks.h"
#include "explain/cause_score.h"
#include "explain/constants.h"
#include "explain/describe.h"
#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/hold_out.h"
#include "explain/outcome.h"
#include "explain/share_null.h"
#include "explain/subject.h"
#include "explain/verdict.h"
#include "servodx/log.h"

namespace servodx {
namespace {

double missing_part(const BlockReplay& b) { return b.passing > 0 ? b.missing / b.passing : 0.0; }

// By what it misses of what passes; null: no log shows a block.
const BlockReplay* worst_block(const std::vector<BlockReplay>& blocks) {
  const auto worst = std::max_element(blocks.begin(), blocks.end(),
                                      [](const auto& a, const auto& b) { return missing_part(a) < missing_part(b); });
  return worst == blocks.end() ? nullptr : &*worst;
}

// Of spool and pressures: a piston's position drifts with any error of flow, and its noise is no measure of that.
double over_noise(const std::vector<ExplainedChannel>& channels) {
  double worst = 0;
  for (const ExplainedChannel& c : channels)
    if (c.noise_rms > 0 && c.id != Signal::piston_position) worst = std::max(worst, c.heldout_after / c.noise_rms);
  return worst;
}

EndEvidence evidence_of(const Inquiry& q, const Answer& answer, const ExplainResult& so_far) {
  EndEvidence e;
  e.level = q.level();
  e.compared = q.test() != nullptr;
  if (e.compared) e.chance_left = chance_left(q, answer.found);
  e.causes = answer.found.causes.size();
  if (e.causes > 0) e.share_of_first = share_of_first(q, answer.found);
  e.curve = answer.curve.has_value();
  e.told_by_blocks = answer.told_by_blocks;
  e.told_of_drive = !answer.of_drive.causes.empty();
  e.over_noise = over_noise(so_far.channels);
  if (const BlockReplay* worst = worst_block(so_far.blocks)) e.block_misses = missing_part(*worst);
  return e;
}

// The block that is least like healthy ones; where every block looks healthy, the name that helps most knows the place
// better, though it does not suffice.
std::string place_without_name(const Inquiry& q, const Answer& answer, const std::vector<BlockReplay>& blocks) {
  if (!q.test()) return worst_block(blocks)->places.front();
  const auto least =
      std::min_element(blocks.begin(), blocks.end(), [](const auto& a, const auto& b) { return *a.p_new < *b.p_new; });
  std::string where = least->places.front();
  if (*least->p_new <= q.level()) return where;
  double most = 0;
  for (const ExplainedFit& name : answer.found.refused) {
    const double gain = heldout_gain(answer.found.before, name, q.options().seed).value;
    if (gain > most) most = gain, where = q.cause(name.causes.back()).where;
  }
  return where;
}

// Of the causes that have a name and were judged on held-out data the one that removes most; null: none removes any.
const CandidateResult* first_of(const Inquiry& q, const Answer& answer) {
  const CandidateResult* best = nullptr;
  for (const CandidateResult& c : answer.found.candidates)
    if (!is_rare(q.cause(c.cause)) && !q.cause(c.cause).curve && c.delta_bic > 0 && c.share.lower > 0)
      if (!best || c.share.value > best->share.value) best = &c;
  return best;
}

std::optional<ExplainSuspicion> suspicion_of(const Inquiry& q, const Answer& answer,
                                             const std::vector<ExplainedCause>& standing) {
  const CandidateResult* first = q.test() && q.test()->shares().logs() > 0 ? first_of(q, answer) : nullptr;
  if (!first) return {};
  const Cause& c = q.cause(first->cause);
  const ShareNull& healthy = q.test()->shares();
  const double chance = healthy.chance(c.effect, first->share.value);
  if (chance > explain_constants::worth_saying) return {};
  ExplainSuspicion out{c.effect, c.where, {}, first->share};
  for (const ExplainedCause& s : standing)
    if (s.effect == c.effect && s.where == c.where && !s.parameters.empty()) out.size = s.parameters.front();
  out.rate = std::min(1.0, chance / explain_constants::of_shares);
  out.of_sensor = is_of_sensor(c);
  out.logs = healthy.logs();
  out.logs_needed = healthy.logs_needed(c.effect, first->share.value, q.options().level);
  return out;
}

// Chance of the first cause, by the question that makes it news; of data that no cause is news in, of what is left.
double chance_of_answer(const Inquiry& q, const Answer& answer, const EndEvidence& evidence) {
  double least = evidence.chance_left;
  const auto ask = [&](const CandidateResult& c) {
    const std::string& effect = q.cause(c.cause).effect;
    least = std::min({least, c.p_new, c.share.value > 0 ? q.test()->shares().chance(effect, c.share.value) : 1.0});
  };
  if (const CandidateResult* first = first_of(q, answer)) ask(*first);
  for (const CauseResult& r : answer.found.causes) ask(answer.found.candidates[static_cast<std::size_t>(r.cause)]);
  return std::min(1.0, explain_constants::questions * least);
}

ExplainedProbabilities probabilities_of(const Inquiry& q, const Answer& answer, const EndEvidence& evidence) {
  PosteriorEvidence e;
  ExplainedProbabilities out;
  e.chance = chance_of_answer(q, answer, evidence);
  e.rate = rate_of_question(q.options().level, q.healthy_logs(), 1);
  for (const CandidateResult& c : answer.found.candidates) {
    const bool judged = c.fitted && c.delta_bic > 0 && c.heldout_gain.lower > 0;
    if (!judged || q.cause(c.cause).curve) continue;
    e.worth.push_back(c.delta_bic + 2 * std::log(q.cause(c.cause).prior));
    e.share_of_best = std::max(e.share_of_best, c.share.value);
    out.causes.push_back({name_of(q.cause(c.cause))});
  }
  const Posterior posterior = posterior_of(e);
  for (std::size_t k = 0; k < out.causes.size(); ++k) out.causes[k].value = posterior.causes[k];
  out.unlisted = posterior.unlisted, out.nothing = posterior.nothing;
  return out;
}

}  // namespace

void conclude(const Inquiry& q, const Answer& answer, ExplainResult& out) {
  const EndEvidence evidence = evidence_of(q, answer, out);
  out.verdict = verdict_of(evidence);
  if (evidence.compared) out.p_adequacy = evidence.chance_left;
  const bool no_name = out.verdict == ExplainVerdict::unexplained && !answer.curve;
  if (no_name && !out.blocks.empty())
    out.where = place_without_name(q, answer, out.blocks);
  else if (!out.causes.empty())
    out.where = answer.better_place.empty() ? out.causes.front().where : answer.better_place;
  out.curve = answer.curve;
  if (out.curve) out.depends_on = out.curve->depends_on();
  if (no_name)  // no curve does either; what it follows most is said all the same
    for (const PlaceScore& p : out.places)
      if (p.where == out.where) out.depends_on = p.variable;
  if (out.verdict == ExplainVerdict::sufficient) out.suspicion = suspicion_of(q, answer, out.standing);
  if (q.test()) {
    const int logs = q.healthy_logs();
    out.false_alarm = {q.options().level, rate_of_question(q.options().level, logs, 1), logs, q.alike()};
    out.probabilities = probabilities_of(q, answer, evidence);
  }
}

}  // namespace servodx
