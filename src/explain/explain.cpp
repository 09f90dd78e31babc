#include "explain/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "base/error.h"
#include "explain/answer.h"
#include "explain/cause_score.h"
#include "explain/channels.h"
#include "explain/conclude.h"
#include "explain/describe.h"
#include "explain/extended_table.h"
#include "explain/fit_causes.h"
#include "explain/hold_out.h"
#include "explain/inquiry.h"
#include "explain/kept.h"
#include "explain/subject.h"
#include "servodx/note.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

std::vector<Note> notes_of_subject(const Inquiry& q) {
  std::vector<Note> out;
  for (std::size_t l = 0; l < q.logs().size(); ++l) {
    const std::vector<Note>& notes = q.subject().logs()[l].notes;
    out.insert(out.end(), notes.begin() + static_cast<long>(q.logs()[l].notes.size()), notes.end());
  }
  return out;
}

// Residuals, blocks and the missing input, as tuned.
void show_as_tuned(const Inquiry& q, const ExplainedFit& before, ExplainResult& out) {
  out.shown = show(q.subject(), q.logs(), before.point);
  out.blocks = replay_blocks(q.subject(), before.point);
  if (q.test())
    for (BlockReplay& b : out.blocks) b.p_new = q.test()->miss({b.block, b.missing});
  const auto missing = [&] {
    return missing_inputs(q.subject(), before.point, [&](double f) {
      q.options().watch.tell("explain, missing input", f, q.subject().simulations());
      return !q.options().watch.stopped();
    });
  };
  out.missing = q.subject().stages.made("missing input", missing, before.point, before.deviance);
}

// Of the curves that were scored the best at each place.
std::vector<PlaceScore> places_of(const Inquiry& q, const std::vector<CauseScore>& curves) {
  std::vector<PlaceScore> out;
  for (const CauseScore& s : curves) {
    const Cause& c = q.cause(s.cause);
    if (!c.curve) continue;
    const auto p = q.test() ? std::optional<double>(q.chance_of(s)) : std::nullopt;
    auto at = std::find_if(out.begin(), out.end(), [&](const PlaceScore& place) { return place.where == c.where; });
    if (at == out.end()) at = out.insert(at, {c.where, "", -1, p});
    if (s.gain > at->gain) *at = {c.where, c.family, s.gain, p};
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return out;
}

std::vector<ExplainedCandidate> candidates_of(const Inquiry& q, const Answer& answer) {
  std::vector<ExplainedCandidate> out;
  for (const CandidateResult& r : answer.found.candidates) {
    const Cause& c = q.cause(r.cause);
    if ((c.curve && !answer.curve) || r.fate == Fate::not_looked_at) continue;
    out.push_back({c.effect, c.where, r.fate, r.predicted_gain,
                   q.test() ? std::optional<double>(r.p_new) : std::nullopt, r.fitted, r.heldout_gain, r.share,
                   r.delta_bic});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.predicted_gain > b.predicted_gain; });
  return out;
}

void describe_causes(const Inquiry& q, const Answer& answer, ExplainResult& out) {
  const Subject& told_by = answer.told_by_blocks ? static_cast<const Subject&>(*answer.blocks) : q.subject();
  for (const CauseResult& r : answer.found.causes) out.causes.push_back(described(q, told_by, r, answer.found.after));
  for (const CauseResult& r : answer.found.standing) out.standing.push_back(described_standing(q, r));
  out.candidates = candidates_of(q, answer);
}

// What a user sees is the free simulation: channels weigh alike, by the ratio of their held-out rms.
bool is_worse_in_rms(const std::vector<ExplainedChannel>& channels) {
  double sum = 0;
  for (const ExplainedChannel& c : channels)
    if (c.heldout_before > 0 && c.heldout_after > 0) sum += std::log(c.heldout_after / c.heldout_before);
  return sum > 0;
}

void measure(const Inquiry& q, const Answer& answer, ExplainResult& out) {
  const FoundCauses& found = answer.found;
  out.retuned = found.retuned;
  out.adequacy_before = q.subject().adequacy(found.before.residual);
  out.adequacy_after = q.subject().adequacy(found.after.residual);
  if (!found.causes.empty()) out.heldout_gain = heldout_gain(found.before, found.after, q.options().seed);
  for (std::size_t l = 0; l < q.logs().size(); ++l) {
    out.before.push_back(q.subject().candidate({}, found.before.point, static_cast<int>(l)));
    out.after.push_back(q.subject().candidate(found.after.causes, found.after.point, static_cast<int>(l)));
  }
  out.worse_withheld = !q.options().keep_worse && is_worse_in_rms(out.channels);
  out.table = out.worse_withheld ? q.subject().table() : extended_table(q.subject(), found, out.causes);
  if (answer.told_by_blocks && out.heldout_gain.lower <= 0)
    out.notes.push_back(
        {Note::Kind::told_by_blocks,
         fmt::format("{} is found by the blocks with measured signals between them. The simulation by itself does not "
                     "follow better with it: held out it gains {:.0f} % ({:.0f} to {:.0f}).",
                     out.causes.front().effect, 100 * out.heldout_gain.value, 100 * out.heldout_gain.lower,
                     100 * out.heldout_gain.upper)});
}

// First: it is ahead of all else. The table has no row of it, as the measured current drives the simulation.
void add_drive(const Inquiry& q, const Answer& answer, ExplainResult& out) {
  if (!answer.drive) return;
  std::vector<ExplainedCause> causes;
  for (const CauseResult& r : answer.of_drive.causes) causes.push_back(described_of_drive(q, answer, r));
  for (const CandidateResult& r : answer.of_drive.candidates) {
    const Cause& c = answer.drive->causes()[static_cast<std::size_t>(r.cause)];
    if (r.fate == Fate::not_looked_at) continue;
    // In place of the valve's own of that name, which would lie behind the coil.
    std::erase_if(out.candidates, [&](const ExplainedCandidate& of_valve) {
      return of_valve.effect == c.effect && of_valve.where == c.where && !is_taken(of_valve.fate);
    });
    out.candidates.insert(out.candidates.begin(), {c.effect, c.where, r.fate, r.predicted_gain, r.p_new, r.fitted,
                                                   r.heldout_gain, r.share, r.delta_bic});
  }
  if (causes.empty()) return;
  if (out.verdict == ExplainVerdict::extended) out.where = causes.front().where;
  out.causes.insert(out.causes.begin(), causes.begin(), causes.end());
  const std::vector<ExplainedChannel> channels = explained_channels(*answer.drive, q.logs(), answer.of_drive);
  out.channels.insert(out.channels.begin(), channels.begin(), channels.end());
}

void count_work(const Inquiry& q, ExplainResult& out) {
  out.interrupted = q.options().watch.stopped();
  for (const LoneLog& lone : q.lone())
    out.simulations += lone.subject.simulations(), out.failed_simulations += lone.subject.failed_simulations();
  out.simulations += q.subject().simulations() + q.beforehand().simulations;
  out.failed_simulations += q.subject().failed_simulations() + q.beforehand().failed;
}

}  // namespace

ExplainResult explain_logs(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                           const HealthyReference* healthy, const ExplainOptions& options) {
  options.validate();
  Inquiry inquiry(logs, tuned, rig, healthy, options);
  Answer answer = find_names(inquiry);
  if (!answer.found.before.ok)
    throw InputError({.file = tuned.path}, "the simulation fails at the table's values on these logs",
                     "check that the table is of this rig");
  try_curves(inquiry, answer);
  ask_blocks(inquiry, answer);
  ask_drive(inquiry, answer);

  ExplainResult out;
  out.notes = notes_of_subject(inquiry);
  show_as_tuned(inquiry, answer.found.before, out);
  out.places = places_of(inquiry, answer.curve_scores);
  describe_causes(inquiry, answer, out);
  out.channels = explained_channels(inquiry.subject(), inquiry.logs(), answer.found);
  conclude(inquiry, answer, out);
  measure(inquiry, answer, out);
  add_drive(inquiry, answer, out);
  count_work(inquiry, out);
  return out;
}

}  // namespace servodx
