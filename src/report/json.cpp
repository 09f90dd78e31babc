#include "report/json.h"

#include <algorithm>
#include <cmath>

#include "base/result_schema.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/blame.h"
#include "diagnose/decide.h"
#include "diagnose/hypotheses.h"
#include "diagnose/judge.h"
#include "diagnose/moved.h"
#include "diagnose/naming.h"
#include "diagnose/reading.h"
#include "diagnose/record_law.h"
#include "diagnose/records.h"
#include "evidence/conditions.h"
#include "evidence/operating_point.h"
#include "report/conditions.h"
#include "report/diagnosis_words.h"
#include "report/friction_words.h"
#include "report/handy.h"
#include "report/row_verdict_word.h"
#include "report/tune_words.h"
#include "servodx/log.h"
#include "servodx/tune.h"
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

const char* word_of(StageMethod method) {
  switch (method) {
    case StageMethod::genetic:
      return "genetic";
    case StageMethod::least_squares:
      return "least_squares";
    case StageMethod::ceres:
      return "ceres";
    case StageMethod::nlopt:
      return "nlopt";
  }
  return "";
}

Json ceres_json(const TuneResult& result) {
  const auto& c = result.ceres;
  return {{"end", name(c.end)},
          {"solves", c.solves},
          {"steps", c.steps},
          {"refused_steps", c.refused},
          {"released_walls", c.released},
          {"jacobians", c.jacobians},
          {"learnt_jacobians", c.learnt},
          {"evaluations", c.evaluations},
          {"initial_cost", number(c.initial_cost)},
          {"final_cost", number(c.final_cost)}};
}

}  // namespace

Json test_json(const TestConditions& test) {
  return {{"drive_span", number(test.drive_span)},
          {"drive_rms", number(test.drive_rms)},
          {"drive_band", number(test.drive_band)},
          {"temperature", test.temperature ? number(*test.temperature) : Json(nullptr)}};
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json to_json(const Header& header) {
  Json inputs = Json::array();
  for (const InputFile& file : header.inputs) inputs.push_back({{"path", file.path}, {"sha256", file.sha256}});
  return {{"tool", "servodx"},
          {"version", header.version},
          {"schema", result_schema},
          {"command", header.command},
          {"seed", header.seed},
          {"settings", header.settings},
          {"inputs", inputs},
          {"seconds", number(header.seconds)},
          {"simulations", header.simulations},
          {"failed_simulations", header.failed_simulations},
          {"notes", header.notes}};
}

Json to_json(const ParameterResult& p) {
  return {{"id", p.id > 0 ? Json(p.id) : Json(nullptr)},
          {"name", p.name},
          {"unit", p.unit},
          {"nominal", number(p.nominal)},
          {"estimate", number(p.estimate)},
          {"std_error", number(p.std_error)},
          {"profile", {{"lower", number(p.profile_lower)}, {"upper", number(p.profile_upper)}}},
          {"verdict", word_of(p.verdict)},
          {"confounded_with", p.confounded_with},
          {"effect_at_lower", number(p.effect_at_lower)},
          {"effect_at_upper", number(p.effect_at_upper)}};
}

Json to_json(const ChannelResult& channel) {
  const ChannelFigures f = figures(channel);
  return {{"signal", info(channel.signal).name},
          {"unit", f.unit},
          {"rms", number(f.rms)},
          {"noise_rms", number(f.noise_rms)},
          {"heldout_rms", number(f.heldout_rms)}};
}

Json tune_json(const TuneResult& result) {
  Json logs = Json::array();
  for (const LogResult& log : result.logs)
    logs.push_back({{"path", log.path}, {"null", number(log.null)}, {"channels", array_of(log.channels)}});
  Json starts = Json::array(), stages = Json::array();
  for (const StageResult& s : result.stages)
    stages.push_back({{"stage", word_of(s.stage)},
                      {"by", word_of(s.by)},
                      {"cost_before", number(s.before)},
                      {"cost_after", number(s.after)},
                      {"simulations", s.simulations},
                      {"jacobians", s.jacobians}});
  for (double cost : result.starts) starts.push_back(number(cost));
  Json effects = Json::array();
  for (const EarnedEffect& e : result.effects)
    effects.push_back({{"effect", e.effect}, {"heldout_gain", number(e.gain)}, {"kept", e.kept}});
  return {{"channels", array_of(result.channels)},
          {"parameters", array_of(result.parameters)},
          {"effects", effects},
          {"starts", starts},
          {"reached_best", result.reached_best()},
          {"interrupted", result.interrupted},
          {"logs", logs},
          {"local", {{"stages", stages}, {"ceres", ceres_json(result)}}}};
}

namespace {

Json to_json(const DetectionBaseline::Score& s) {
  Json gains = Json::object();
  for (const auto& [fault, gain] : s.gains) gains[label_of(fault)] = gain;
  Json out = {{"log", s.log},
              {"sha256", s.sha256},
              {"score", number(s.score)},
              {"adequacy", number(s.adequacy)},
              {"gains", gains}};
  if (s.test) out["test"] = test_json(*s.test);
  Json figures = Json::array();
  for (const RecordFigure& f : s.figures)
    figures.push_back(
        {{"figure", store::key_of(f.kind)}, {"signal", std::string(name_of(f.signal))}, {"value", number(f.value)}});
  out["figures"] = std::move(figures);
  Json point = Json::object();
  for (std::size_t i = 0; i < s.point.size(); ++i)
    if (s.point[i]) point[store::key_of(static_cast<Condition>(i))] = number(*s.point[i]);
  out["operating_point"] = std::move(point);
  return out;
}

Json to_json(const std::vector<DetectionBaseline::Score>& scores) {
  Json out = Json::array();
  for (const DetectionBaseline::Score& s : scores) out.push_back(to_json(s));
  return out;
}

}  // namespace

Json baseline_json(const DetectionBaseline& b) {
  return {{"threshold", number(b.threshold)},
          {"false_alarm",
           {{"asked", number(b.asked)},
            {"promised", number(b.promised)},
            {"logs", b.logs},
            {"statement", statement_of(b)},
            {"promised_95", number(b.promised_95)},
            {"logs_needed", b.logs_needed}}},
          {"scores", to_json(b.scores)},
          {"others", to_json(b.others)},
          {"adequacy_limit", number(b.adequacy_limit)},
          {"null_limit", number(b.null_limit)},
          {"tuned_sha256", b.tuned_sha256}};
}

Json to_json(const HypothesisResult& h) {
  Json shapes = Json::array();
  for (std::size_t i = 0; i < h.shapes.size(); ++i)
    shapes.push_back({{"name", h.fault->shapes[i].name}, {"value", number(h.shapes[i])}});
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
          {"stops", h.stops}};
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
          {"unjudgeable", words_of(d.assessment.unjudgeable)},
          {"reason", reason_of(d)},
          {"reading", reading_json(d)},
          {"hypothesis_told", label_of(d.nearest)},
          {"test", test_json(d.assessment.test)},
          {"operating_point", conditions_json(d.conditions)},
          {"unlike_baseline",
           d.unlike ? Json{{"nearest", d.unlike->log}, {"test", test_json(d.unlike->test)}} : Json(nullptr)},
          {"compared_with_others", d.others},
          {"null", number(d.null)},
          {"channels", array_of(d.assessment.channels)},
          {"hypotheses", array_of(d.assessment.hypotheses)},
          {"pairs", pairs_json(d)},
          {"notes", d.assessment.notes}};
}

Json diagnose_json(const std::vector<Diagnosis>& results) { return {{"results", array_of(results)}}; }

std::string dump(const Header& header, const Json& body) {
  Json all = to_json(header);
  all.update(body);
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace servodx::report
