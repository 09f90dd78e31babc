#include "diagnose/judge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "diagnose/blame.h"
#include "diagnose/constants.h"
#include "diagnose/healthy_law.h"
#include "diagnose/naming.h"
#include "diagnose/reading.h"
#include "diagnose/record_figures.h"
#include "diagnose/visible.h"
#include "evidence/conditions.h"
#include "evidence/constants.h"
#include "evidence/probabilities.h"
#include "evidence/rank_promise.h"
#include "evidence/tail_law.h"
#include "servodx/log.h"
#include "servodx/operating_point.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;
using evidence_constants::effect_error;

std::optional<Diagnosis::Unlike> unlike_all(const TestConditions& test, const DetectionBaseline& baseline) {
  const DetectionBaseline::Score* nearest = nearest_of_unlike(test, baseline);
  if (!nearest) return {};
  return Diagnosis::Unlike{nearest->log, *nearest->test};
}

std::vector<ConditionRow> conditions_of(const Assessment& a, const DetectionBaseline& baseline) {
  std::vector<OperatingPoint> healthy;
  for (const DetectionBaseline::Score& s : baseline.scores) healthy.push_back(s.point);
  return conditions_beside(a.points, a.sheet, healthy);
}

// Of several logs of one state the test that is least like any of the baseline, its logs of other tests included: what
// it knows of the rest says little of that one.
TestConditions least_known_test(const Assessment& a, const DetectionBaseline& baseline) {
  const auto from_nearest = [&](const TestConditions& test) {
    double nearest = HUGE_VAL;
    for (const auto* logs : {&baseline.scores, &baseline.others})
      for (const DetectionBaseline::Score& s : *logs)
        if (s.test) nearest = std::min(nearest, distance(test, *s.test));
    return nearest;
  };
  if (a.tests.empty()) return a.test;
  return *std::max_element(a.tests.begin(), a.tests.end(), [&](const TestConditions& x, const TestConditions& y) {
    return from_nearest(x) < from_nearest(y);
  });
}

double p_value_of(double error, const DetectionBaseline& baseline, const HealthyLaw& law) {
  std::vector<double> healthy;
  for (const std::size_t i : law.positions()) healthy.push_back(baseline.scores[i].score);
  return rank_p_value(error, healthy);
}

Suspicion suspicion_of(const HypothesisResult& h, double gain, const HealthyLaw& law) {
  return {h.fault,
          h.severity,
          h.severity_lower,
          h.severity_upper,
          std::min(1.0, law.chance_of_gain(gain) / k::share_of_gain),
          law.logs(),
          law.logs_needed(gain)};
}

double rate_of_records(const DetectionBaseline& b) {
  return rate_of_question(b.asked, static_cast<int>(b.scores.size()), k::share_of_records);
}

std::size_t position_of(const Fault* fault, const Assessment& a) {
  std::size_t i = 0;
  while (i + 1 < a.hypotheses.size() && a.hypotheses[i].fault != fault) ++i;
  return i;
}

double gain_of(const FaultGains& usual, const Fault* fault) {
  const auto known = usual.find(fault);
  return known == usual.end() ? 0.0 : known->second;
}

// Of a gain [of misfit, inflated], beside the mean gain of the same fault on healthy logs.
double part_beyond(double gain, double usual) {
  return gain > 0 ? std::max(1 / (1 + usual), 1 - k::most_lent * usual / gain) : 1.0;
}

// At an end that is no end of the fault: something else pulls. `of`: a hypothesis, or one fault of a pair.
bool is_pulled_to_end(const auto& of) { return of.at_worst && !(of.fault && of.fault->ends_whole); }

// Inside its range and of the others of its kind the likeliest: a fault that takes nearly as much as the one given.
std::optional<std::size_t> rival_inside(const Assessment& a, const std::vector<WeighedHypothesis>& weighed,
                                        std::size_t at_end) {
  const double healthy = a.hypotheses.front().misfit;
  const double near = (1 - effect_error) * (1 - effect_error) * (healthy - a.hypotheses[at_end].misfit);
  std::optional<std::size_t> out;
  for (std::size_t i = 1; i < weighed.size(); ++i) {
    const HypothesisResult& h = a.hypotheses[i];
    if (i == at_end || is_pulled_to_end(h) || healthy - h.misfit < near) continue;
    if (!out || weighed[i].misfit < weighed[*out].misfit) out = i;
  }
  return out;
}

// A size at the far end of its range stands there because something else pulls. Where a fault inside its range takes as
// much, to what a model errs by of its own effect, that one stands before it.
void put_ends_behind(const Assessment& a, std::vector<WeighedHypothesis>& weighed) {
  const std::vector<WeighedHypothesis> as_fitted = weighed;
  for (std::size_t i = 1; i < weighed.size(); ++i) {
    if (!is_pulled_to_end(a.hypotheses[i])) continue;
    if (const auto rival = rival_inside(a, as_fitted, i))
      weighed[i].misfit =
          std::max(weighed[i].misfit, as_fitted[*rival].misfit - 2 * a.misfit_scale * std::log(k::end_of_range_odds));
  }
}

// Where the likeliest leaves more than a fault may, what is left is an error of the model that nobody has seen. Such an
// error lasts: it is some independent ones, and not as many as samples.
double tempered_scale(const Assessment& a, const std::vector<WeighedHypothesis>& weighed, double usual_adequacy) {
  const auto least = std::min_element(weighed.begin(), weighed.end(),
                                      [](const auto& x, const auto& y) { return x.misfit < y.misfit; });
  const HypothesisResult& likeliest = a.hypotheses[static_cast<std::size_t>(least - weighed.begin())];
  const bool as_known = likeliest.adequacy <= k::fault_allowance * std::max(1.0, usual_adequacy);
  return as_known ? a.misfit_scale : std::max(a.misfit_scale, likeliest.misfit / k::errors_of_a_fault);
}

// A hypothesis that gains on healthy logs as well takes up what the model has wrong: only what it gains beyond that
// counts, for the name as for the verdict.
void weigh_beside_usual(Assessment& a, const FaultGains& usual, double usual_adequacy) {
  const double healthy = a.hypotheses.front().misfit;
  std::vector<WeighedHypothesis> weighed;
  for (const HypothesisResult& h : a.hypotheses) {
    const double gain = healthy - h.misfit;
    weighed.push_back(
        {h.fault ? h.fault->prior : 1.0, gain > 0 ? -gain * part_beyond(h.gain, gain_of(usual, h.fault)) : -gain});
  }
  a.misfit_scale = tempered_scale(a, weighed, usual_adequacy);
  put_ends_behind(a, weighed);
  const std::vector<double> p = probabilities_of(weighed, a.misfit_scale);
  for (std::size_t i = 0; i < p.size(); ++i) a.hypotheses[i].probability = p[i];
  std::stable_sort(a.hypotheses.begin() + 1, a.hypotheses.end(),
                   [](const auto& x, const auto& y) { return x.probability > y.probability; });
}

// Of so many logs as the assessment holds.
FaultGains usual_gains_of(const Assessment& a, const DetectionBaseline& baseline) {
  FaultGains usual = usual_gains(baseline);
  for (auto& [fault, gain] : usual) gain *= static_cast<double>(std::max<std::size_t>(1, a.logs.size()));
  return usual;
}

// What the model errs by on the worst of healthy logs may gain a second name as well: it has to gain beyond that. Where
// the first alone leaves more than any healthy log, what both leave says by how much the model errs here.
double errs_beside(const PairResult& p, double alone, double usual_adequacy) {
  const double usual = std::max(1.0, usual_adequacy);
  return alone > usual ? std::clamp(p.adequacy, 1.0, usual) : usual;
}

PairEvidence pair_of(const PairResult& p, const Assessment& a, const FaultGains& usual, double usual_adequacy) {
  const double of_health = gain_of(usual, p.second.fault);
  const std::size_t first = position_of(p.first.fault, a);
  const double errs = std::pow(errs_beside(p, a.hypotheses[first].adequacy, usual_adequacy), 2);
  PairEvidence e;
  e.first = first, e.second = position_of(p.second.fault, a);
  e.gain = std::sqrt(std::max(0.0, p.gain) / errs / (1 + of_health));
  e.adequacy = p.adequacy;
  e.at_least = p.first.at_least || p.second.at_least;
  e.at_worst = is_pulled_to_end(p.first) || is_pulled_to_end(p.second);
  return e;
}

// A fault whose gain's root is expected so far beyond the limit is found in 95 of 100 logs: noise moves the root by one
// deviate.
std::vector<Detectable> detectable_of(const Assessment& a, const FaultGains& usual, double limit) {
  const double needed = (limit + k::deviates_of_one_in_20) * (limit + k::deviates_of_one_in_20);
  std::vector<Detectable> out;
  for (auto side = a.visible.begin(); side != a.visible.end();) {
    const Fault* fault = side->fault;
    const auto next = std::find_if(side, a.visible.end(), [&](const VisibleFault& v) { return v.fault != fault; });
    out.push_back({fault, least_found_either_side(std::span(side, next), needed * (1 + gain_of(usual, fault)))});
    side = next;
  }
  return out;
}

// One sensor's sign, or the two chambers': a broken sensor is found by them as well.
bool shows_a_broken_sensor(const Reading& r) {
  const auto is_chamber = [](Signal s) { return s == Signal::pressure_a || s == Signal::pressure_b; };
  if (r.kind == Misreading::turned) return r.of.size() == 1 && r.of.front() != Signal::command;
  return r.kind == Misreading::exchanged && std::all_of(r.of.begin(), r.of.end(), is_chamber);
}

// What no log parts from a fault that is named, unless a record tells it or it is named as well.
void add_twins(Diagnosis& d) {
  for (const NamedFault& named : d.faults) {
    const Fault* twin = named.fault->twin;
    if (!twin || (twin->told_by && d.assessment.current_recorded)) continue;
    const bool is_named =
        std::any_of(d.faults.begin(), d.faults.end(), [&](const NamedFault& other) { return other.fault == twin; });
    auto& others = d.ambiguous_with;
    if (!is_named && std::find(others.begin(), others.end(), twin) == others.end()) others.push_back(twin);
  }
}

// Of the first fault named.
void take_first(Diagnosis& d) {
  if (d.faults.empty()) return;
  const NamedFault& first = d.faults.front();
  d.fault = first.fault;
  d.severity = {first.severity, first.lower, first.upper};
  if (first.record && first.record->since) d.onset = first.record->since;
}

// Where a sensor is broken or the log was read wrongly, the fits are of no valve: what they moved, since when, and what
// they could have shown is no finding.
void leave_out_fits(Diagnosis& d) {
  if (!sensor_finding_of(d) && blame_of(d) != Blame::log) return;
  d.moved.clear(), d.detectable.clear();
  d.onset.reset();
}

}  // namespace

std::vector<RecordFinding> records_of(const Assessment& a, const DetectionBaseline& baseline) {
  std::vector<std::vector<RecordFigure>> healthy;
  for (const DetectionBaseline::Score& s : baseline.scores) healthy.push_back(s.figures);
  return record_findings(a.figures, a.broken, healthy, rate_of_records(baseline));
}

Evidence evidence_of(const Assessment& a, const DetectionBaseline& baseline, const HealthyLaw& law,
                     const std::vector<RecordFinding>& records) {
  const FaultGains usual = usual_gains_of(a, baseline);
  Evidence e;
  e.gain = score_of(a, usual);
  e.error = law.error_of(e.gain, a.hypotheses.front().adequacy);
  e.threshold = law.limit();
  e.usual_adequacy = baseline.adequacy_limit;
  e.known_test = !baseline.of_other_tests && knows_test(baseline, a.test);
  e.gross = a.gross;
  e.unjudgeable = a.unjudgeable;
  for (const HypothesisResult& h : a.hypotheses)
    e.hypotheses.push_back({h.fault, h.probability, h.adequacy, is_pulled_to_end(h), h.gain, h.motion_left});
  e.others_left = a.others_left;
  if (a.reading) e.reading = {a.reading->left, shows_a_broken_sensor(*a.reading)};
  if (!a.pairs.empty()) e.pair = pair_of(a.pairs.front(), a, usual, baseline.adequacy_limit);
  for (const RecordFinding& f : records) e.records.push_back({*f.fault->told_by, f.broken.has_value()});
  return e;
}

Diagnosis judge(Assessment a, const DetectionBaseline& whole) {
  a.test = least_known_test(a, whole);
  const DetectionBaseline baseline = baseline_for(a.test, whole);
  weigh_beside_usual(a, usual_gains_of(a, baseline), baseline.adequacy_limit);
  const SuspectLog suspect = suspect_of(a);
  const HealthyLaw law(baseline, &suspect);
  std::vector<RecordFinding> records = records_of(a, whole);
  const Evidence evidence = evidence_of(a, baseline, law, records);
  const Decision decision = decide(evidence);
  Diagnosis d;
  d.log = a.log;
  d.verdict = decision.verdict, d.doubt = decision.doubt;
  d.error = evidence.error, d.threshold = evidence.threshold;
  d.p_value = p_value_of(evidence.error, baseline, law);
  d.baseline_logs = law.logs();
  d.records = std::move(records);
  const Named named{
      a, decision, d.records, law, evidence.gain, evidence.pair ? evidence.pair->gain : 0.0, rate_of_records(whole)};
  d.faults = name_faults(named);
  d.probabilities = probabilities_of(named, d.faults);
  if (decision.suspected && law.chance_of_gain(evidence.gain) <= k::worth_saying)
    d.suspicion = suspicion_of(a.hypotheses[*decision.suspected], evidence.gain, law);
  d.unlike = unlike_all(a.test, whole);
  if (baseline.of_other_tests) d.others = static_cast<int>(baseline.scores.size());
  if (baseline.of_repeats) d.repeats = static_cast<int>(baseline.scores.size());
  d.conditions = conditions_of(a, whole);
  d.detectable = detectable_of(a, usual_gains_of(a, baseline), law.limit());
  for (const std::size_t i : decision.ambiguous) d.ambiguous_with.push_back(a.hypotheses[i].fault);
  const HypothesisResult& told = a.hypotheses[decision.hypothesis];
  d.nearest = told.fault;
  d.null = told.null;
  d.moved = told.moved;
  d.onset = a.onset;
  d.assessment = std::move(a);
  take_first(d);
  add_twins(d);
  leave_out_fits(d);
  return d;
}

}  // namespace servodx
