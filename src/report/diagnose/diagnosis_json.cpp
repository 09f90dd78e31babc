#include "report/diagnose/diagnosis_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "diagnose/assessment.h"
#include "diagnose/blame.h"
#include "diagnose/decide.h"
#include "diagnose/hypotheses.h"
#include "diagnose/judge.h"
#include "diagnose/judgeable.h"
#include "diagnose/moved.h"
#include "diagnose/naming.h"
#include "diagnose/reading.h"
#include "diagnose/record_law.h"
#include "optimise/search_stop.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/diagnose/friction_words.h"
#include "report/diagnose/next_calls.h"
#include "report/diagnose/verdict_words.h"
#include "report/shared/conditions.h"
#include "report/shared/search_words.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "store/baseline_keys.h"

namespace servodx::report {
namespace {

template <class Results>
Json array_of(const Results& results) {
  Json array = Json::array();
  for (const auto& result : results) array.push_back(to_json(result));
  return array;
}

Json moved_json(const std::vector<MovedRow>& rows) {
  constexpr const char* by_name[] = {"fault", "tolerance", "nuisance"};
  Json array = Json::array();
  for (const MovedRow& row : rows) {
    array.push_back(to_json(row));
    array.back()["by"] = by_name[static_cast<std::size_t>(row.by)];
  }
  return array;
}

}  // namespace

Json to_json(const HypothesisResult& h) {
  Json shapes = Json::array(), stops = Json::array();
  for (std::size_t i = 0; i < h.shapes.size(); ++i)
    shapes.push_back({{"name", h.fault->shapes[i].name}, {"value", number(h.shapes[i])}});
  for (const SearchStop& stop : h.stops) stops.push_back(words_of(stop));
  return {{"name", label_of(h.fault)},
          {"probability", number(h.probability)},
          {"misfit", number(h.misfit)},
          {"gain", number(h.gain)},
          {"adequacy", number(h.adequacy)},
          {"motion_left", number(h.motion_left)},
          {"severity",
           {{"value", number(h.severity)},
            {"lower", number(h.severity_lower)},
            {"upper", number(h.severity_upper)},
            {"unit", unit_of(h.fault)},
            {"at_least", h.at_least}}},
          {"shape", shapes.empty() ? Json(nullptr) : shapes.front()},
          {"shapes", shapes},
          {"stops", stops}};
}

Json to_json(const Suspicion& s) {
  return {{"name", label_of(s.fault)},
          {"severity",
           {{"value", number(s.severity)},
            {"lower", number(s.lower)},
            {"upper", number(s.upper)},
            {"unit", unit_of(s.fault)}}},
          {"rate", number(s.rate)},
          {"logs", s.logs},
          {"logs_needed", s.logs_needed > 0 ? Json(s.logs_needed) : Json(nullptr)}};
}

Json detectable_json(const Diagnosis& d) {
  Json out = Json::object();
  for (const Detectable& f : d.detectable)
    out[label_of(f.fault)] = {{"value", f.severity ? number(*f.severity) : Json(nullptr)}, {"unit", unit_of(f.fault)}};
  return out;
}

Json to_json(const BeyondFaults& b) {
  return {{"effect", b.first.empty() ? Json(nullptr) : Json(b.first)},
          {"where", b.where},
          {"depends_on", b.depends_on},
          {"heldout_share", number(b.share)},
          {"taken", b.taken}};
}

Json channel_json(const NamedFault& f) {
  const std::string channel = channel_of(f);
  return channel.empty() ? Json(nullptr) : Json(channel);
}

// The one named first.
Json faults_json(const Diagnosis& d) {
  Json out = Json::array();
  for (const NamedFault& f : d.faults)
    out.push_back({{"name", label_of(f.fault)},
                   {"channel", channel_json(f)},
                   {"probability", number(f.probability)},
                   {"severity",
                    {{"value", number(f.severity)},
                     {"lower", number(f.lower)},
                     {"upper", number(f.upper)},
                     {"unit", unit_of(f.fault)}}}});
  return out;
}

Json records_json(const Diagnosis& d) {
  Json out = Json::array();
  for (const RecordFinding& f : d.records)
    out.push_back({{"fault", label_of(f.fault)},
                   {"figure", f.figure ? Json(store::key_of(*f.figure)) : Json(nullptr)},
                   {"signal", std::string(name_of(f.signal))},
                   {"value", number(f.value)},
                   {"usual", number(f.usual)},
                   {"chance", number(f.chance)},
                   {"statement", record_in_words(f)}});
  return out;
}

Json to_json(const FaultSize& s) {
  return {{"name", label_of(s.fault)},
          {"severity",
           {{"value", number(s.severity)},
            {"lower", number(s.severity_lower)},
            {"upper", number(s.severity_upper)},
            {"unit", unit_of(s.fault)}}}};
}

// The best three: a page of them tells no more.
Json pairs_json(const Diagnosis& d) {
  constexpr std::size_t most = 3;
  Json out = Json::array();
  for (std::size_t i = 0; i < std::min(most, d.assessment.pairs.size()); ++i) {
    const PairResult& p = d.assessment.pairs[i];
    out.push_back({{"faults", {to_json(p.first), to_json(p.second)}},
                   {"gain", number(p.gain)},
                   {"of_effect", number(p.of_effect)},
                   {"adequacy", number(p.adequacy)}});
  }
  return out;
}

// Of a log that was read wrongly, and of no other: any has a reading that leaves least.
Json reading_json(const Diagnosis& d) {
  if (d.doubt != Doubt::misread || !d.assessment.reading) return nullptr;
  const Reading& r = *d.assessment.reading;
  Json signals = Json::array();
  for (const Signal s : r.of) signals.push_back(std::string(name_of(s)));
  return {{"reason", word_of(r.kind)}, {"signals", signals}, {"factor", number(r.factor)}, {"left", number(r.left)}};
}

Json to_json(const Diagnosis& d) {
  Json probabilities = Json::object();
  for (const auto& [label, p] : labelled_probabilities(d)) probabilities[label] = number(p);
  const bool sized = d.fault != nullptr;
  return {{"log", d.log},
          {"logs", d.assessment.logs},
          {"verdict", word_of(d.verdict)},
          {"kind", word_of(blame_of(d))},
          {"error", number(d.error)},
          {"threshold", number(d.threshold)},
          {"p_value", number(d.p_value)},
          {"fault", d.fault ? Json(label_of(d.fault)) : Json(nullptr)},
          {"faults", faults_json(d)},
          {"channel", d.faults.empty() ? Json(nullptr) : channel_json(d.faults.front())},
          {"records", records_json(d)},
          {"probabilities", probabilities},
          {"suspicion", d.suspicion ? to_json(*d.suspicion) : Json(nullptr)},
          {"detectable", detectable_json(d)},
          {"lateral_force", friction_json(d.friction)},
          {"explained", d.beyond ? to_json(*d.beyond) : Json(nullptr)},
          {"ambiguous_with", ambiguous_labels(d)},
          {"separating_test", separating_test_of(d)},
          {"severity",
           {{"value", sized ? number(d.severity.value) : Json(nullptr)},
            {"lower", sized ? number(d.severity.lower) : Json(nullptr)},
            {"upper", sized ? number(d.severity.upper) : Json(nullptr)},
            {"unit", unit_of(d.fault)}}},
          {"onset_time", d.onset ? number(*d.onset) : Json(nullptr)},
          {"parameters", moved_json(d.moved)},
          {"action", d.action.text},
          {"gross", words_of(d.assessment.gross)},
          {"unjudgeable", words_of(d.verdict == VerdictKind::unknown ? d.assessment.unjudgeable : Unjudgeable::no)},
          {"reason", reason_of(d)},
          {"reading", reading_json(d)},
          {"hypothesis_told", label_of(d.nearest)},
          {"test", test_json(d.assessment.test)},
          {"operating_point", conditions_json(d.conditions)},
          {"unlike_baseline",
           d.unlike ? Json{{"nearest", d.unlike->log}, {"test", test_json(d.unlike->test)}} : Json(nullptr)},
          {"compared_with_others", d.others},
          {"compared_with_repeats", d.repeats},
          {"null", number(d.null)},
          {"channels", to_json(d.assessment.channels)},
          {"hypotheses", array_of(d.assessment.hypotheses)},
          {"pairs", pairs_json(d)},
          {"notes", texts_of(d.assessment.notes)}};
}

Json diagnose_json(const std::vector<Diagnosis>& results) { return {{"results", array_of(results)}}; }

Json diagnose_json(const std::vector<servodx::Verdict>& verdicts) {
  Json results = Json::array();
  for (const servodx::Verdict& v : verdicts) results.push_back(to_json(*v.whole));
  return {{"results", std::move(results)}};
}

}  // namespace servodx::report
