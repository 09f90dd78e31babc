#include "diagnose/decide.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "diagnose/constants.h"
#include "diagnose/judgeable.h"
#include "faults/gross_finding.h"
#include "faults/record.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

std::size_t most_probable(const std::vector<HypothesisEvidence>& hypotheses) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < hypotheses.size(); ++i)
    if (hypotheses[i].probability > hypotheses[best].probability) best = i;
  return best;
}

bool shown_by(const Fault* fault, GrossFinding finding) {
  return finding != GrossFinding::none && fault && fault->seen_outright && fault->seen_outright->finding == finding;
}

std::optional<std::size_t> place_seen_outright(const Evidence& e) {
  for (std::size_t i = 0; i < e.hypotheses.size(); ++i)
    if (shown_by(e.hypotheses[i].fault, e.gross)) return i;
  return {};
}

// What stands first is kept: a log that cannot be told from healthy ones may be no healthy one.
Decision call_healthy(Decision d, const Evidence& e) {
  const std::size_t best = most_probable(e.hypotheses);
  if (e.hypotheses[best].fault && e.hypotheses[best].gain > 0) d.suspected = best;
  return d;
}

Decision name_outright(Decision d, std::size_t fault) {
  d.verdict = VerdictKind::fault;
  d.hypothesis = fault;
  d.severity = SeveritySource::seen_outright;
  std::fill(d.probabilities.begin(), d.probabilities.end(), 0.0);
  d.probabilities[fault] = 1.0;
  return d;
}

Decision name_fitted(Decision d, std::size_t fault) {
  d.verdict = VerdictKind::fault;
  d.hypothesis = fault;
  d.severity = SeveritySource::fit;
  for (std::size_t i = 0; i < d.probabilities.size(); ++i)
    if (i != fault && d.probabilities[i] > k::ambiguous_probability) d.ambiguous.push_back(i);
  return d;
}

Decision name_nothing(Decision d, std::size_t nearest, Doubt why) {
  d.verdict = VerdictKind::unknown;
  d.doubt = why;
  d.hypothesis = nearest;
  std::fill(d.probabilities.begin(), d.probabilities.end(), 0.0);
  return d;
}

}  // namespace

bool explains_enough(const HypothesisEvidence& fault, const Evidence& e) {
  const double usual = std::max(1.0, e.usual_adequacy), by_health = e.hypotheses.front().adequacy;
  const auto within = [&](double allowance, double part) {
    return fault.adequacy <= std::hypot(allowance * usual, fault.at_worst ? 0.0 : part * by_health);
  };
  return within(k::fault_allowance, k::unexplained_part) &&
         (e.known_test || within(k::fault_allowance_elsewhere, k::unexplained_part_elsewhere));
}

namespace {

// Both sizes are found, the second gains what a name needs, and the two leave the log as one fault may leave it.
bool is_pair(const PairEvidence& p, const Evidence& e) {
  const HypothesisEvidence both{e.hypotheses[p.first].fault, 0, p.adequacy, p.at_worst, e.gain};
  return !p.at_least && e.gain > e.threshold && p.gain > e.threshold && explains_enough(both, e);
}

Decision name_pair(Decision d, const PairEvidence& pair) {
  d.verdict = VerdictKind::fault;
  d.hypothesis = pair.first;
  d.beside = pair.second;
  d.severity = SeveritySource::fit;
  return d;
}

Decision decide_on_valve(const Evidence& e) {
  Decision d;
  for (const HypothesisEvidence& h : e.hypotheses) d.probabilities.push_back(h.probability);
  if (e.error <= e.threshold) return call_healthy(std::move(d), e);
  if (const auto outright = place_seen_outright(e)) return name_outright(std::move(d), *outright);
  if (e.pair && is_pair(*e.pair, e)) return name_pair(std::move(d), *e.pair);
  const std::size_t best = most_probable(e.hypotheses);
  const HypothesisEvidence& h = e.hypotheses[best];
  if (h.fault && e.gain > e.threshold && explains_enough(h, e)) return name_fitted(std::move(d), best);
  return name_nothing(std::move(d), best, Doubt::no_fault);
}

Decision name_by_record(Decision valve, std::size_t record) {
  valve.valve_too = valve.verdict == VerdictKind::fault;
  valve.verdict = VerdictKind::fault;
  valve.doubt = Doubt::none;
  valve.record = record;
  valve.suspected.reset();
  valve.severity = SeveritySource::record;
  return valve;
}

// What the record tells is in the simulation, which is driven by it: what is left unlike health is something else.
bool leaves_the_rest_as_health(const Decision& valve, const Evidence& e) {
  return valve.verdict != VerdictKind::unknown ||
         e.hypotheses.front().adequacy <= k::fault_allowance * std::max(1.0, e.usual_adequacy);
}

double least_left(const Evidence& e) {
  double least = 1;
  for (const HypothesisEvidence& h : e.hypotheses) least = std::min(least, h.motion_left);
  return least;
}

bool explains(const std::optional<ReadingEvidence>& reading) {
  return reading && reading->motion_left <= k::misread_leaves;
}

// What the verdict would be of must leave more of the log than the mistake does, by far; so must health as the log was
// read: a log that moves as a healthy one's needs no mistake.
bool is_misread(const Decision& valve, const Evidence& e) {
  if (!explains(e.reading)) return false;
  if (e.reading->of_a_sensor && !e.records.empty() && e.records.front().broken) return false;
  const double told = valve.beside
                          ? least_left(e)
                          : std::min(e.hypotheses.front().motion_left, e.hypotheses[valve.hypothesis].motion_left);
  if (valve.verdict == VerdictKind::healthy && told <= k::worth_reading) return false;  // it is read well enough
  return e.reading->motion_left < k::misread_beside * told;
}

// A spool on its stops, or at rest, is seen without a simulation.
bool is_unrelated(const Decision& valve, const Evidence& e) {
  if (valve.severity == SeveritySource::seen_outright || e.gross != GrossFinding::none) return false;
  const bool alone = valve.verdict == VerdictKind::fault && !valve.beside;
  return (alone ? e.hypotheses[valve.hypothesis].motion_left : least_left(e)) > k::unrelated_leaves;
}

Decision unknown_for(Doubt why, const Evidence& e) {
  Decision none;
  none.probabilities.resize(e.hypotheses.size());
  return name_nothing(std::move(none), most_probable(e.hypotheses), why);
}

// Of the valve nothing can be said. Where no current reaches it though the command moves, the driver is why.
Decision decide_on_unjudgeable(const Evidence& e) {
  Decision none = unknown_for(explains(e.reading) ? Doubt::misread : Doubt::unjudgeable, e);
  if (e.unjudgeable != Unjudgeable::nothing_asked) return none;
  const auto driver =
      std::find_if(e.records.begin(), e.records.end(), [](const RecordEvidence& r) { return r.of == Record::driver; });
  if (driver == e.records.end()) return none;
  return name_by_record(std::move(none), static_cast<std::size_t>(driver - e.records.begin()));
}

}  // namespace

Decision decide(const Evidence& e) {
  if (e.unjudgeable != Unjudgeable::no) return decide_on_unjudgeable(e);
  Decision valve = decide_on_valve(e);
  if (is_misread(valve, e)) return unknown_for(Doubt::misread, e);
  if (!e.records.empty() && e.records.front().broken && e.others_left <= k::others_follow) {
    valve.verdict = VerdictKind::unknown;  // no fault of the valve stands beside it
    return name_by_record(std::move(valve), 0);
  }
  if (is_unrelated(valve, e)) return unknown_for(Doubt::unrelated, e);
  if (valve.severity == SeveritySource::seen_outright) return valve;
  const auto record = std::find_if(e.records.begin(), e.records.end(),
                                   [](const RecordEvidence& r) { return !r.broken && r.of != Record::sensor; });
  if (record != e.records.end())
    return leaves_the_rest_as_health(valve, e)
               ? name_by_record(std::move(valve), static_cast<std::size_t>(record - e.records.begin()))
               : valve;
  const bool noisy = !e.records.empty() && !e.records.front().broken;
  const bool names_a_sensor = noisy && valve.verdict != VerdictKind::fault;
  return names_a_sensor ? name_by_record(std::move(valve), 0) : valve;
}

}  // namespace servodx
