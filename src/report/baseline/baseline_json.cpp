#include "report/baseline/baseline_json.h"

#include <nlohmann/json.hpp>

#include "diagnose/record_figures.h"
#include "diagnose/record_law.h"
#include "evidence/conditions.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/diagnose/verdict_words.h"
#include "report/explain/explain_report.h"
#include "servodx/log.h"
#include "servodx/operating_point.h"
#include "store/baseline_keys.h"

namespace servodx::report {
namespace {

Json to_json(const DetectionBaseline::Score& s) {
  Json gains = Json::object();
  for (const auto& [fault, gain] : s.gains) gains[label_of(fault)] = gain;
  Json out = {{"log", s.log},
              {"sha256", s.sha256},
              {"content", s.content},
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

Json baseline_json(const BaselineParts& parts) {
  Json body = baseline_json(parts.detection);
  body["explain"] = healthy_json(parts.causes.value());
  if (parts.of) body["made_of"] = {{"rig", parts.of->rig}, {"signals", parts.of->signals}};
  return body;
}

Json baseline_json(const Baseline& baseline) { return baseline_json(parts_of(baseline)); }

}  // namespace servodx::report
