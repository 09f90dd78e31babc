#include "report/tune/tune_json.h"

#include <nlohmann/json.hpp>

#include "report/shared/search_words.h"
#include "report/tune/tune_words.h"
#include "servodx/tune.h"

namespace servodx::report {
namespace {

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
    case StageMethod::none:
      return "none";
  }
  return "";
}

Json ceres_json(const TuneResult& result) {
  const auto& c = result.ceres;
  return {{"end", report::word_of(c.end)},     {"solves", c.solves},           {"steps", c.steps},
          {"refused_steps", c.refused},        {"released_walls", c.released}, {"jacobians", c.jacobians},
          {"learnt_jacobians", c.learnt},      {"evaluations", c.evaluations}, {"initial_cost", number(c.initial_cost)},
          {"final_cost", number(c.final_cost)}};
}

}  // namespace

Json tune_json(const TuneResult& result) {
  Json parameters = Json::array(), logs = Json::array();
  for (const ParameterResult& parameter : result.parameters) parameters.push_back(to_json(parameter));
  for (const LogResult& log : result.logs)
    logs.push_back({{"path", log.path}, {"null", number(log.null)}, {"channels", to_json(log.channels)}});
  Json starts = Json::array(), stages = Json::array();
  for (const StageResult& s : result.stages)
    stages.push_back({{"stage", word_of(s.stage)},
                      {"by", word_of(s.by)},
                      {"cost_before", number(s.before)},
                      {"cost_after", number(s.after)},
                      {"heldout_over_noise", number(s.heldout_over_noise)},
                      {"simulations", s.simulations},
                      {"jacobians", s.jacobians},
                      {"seconds", s.seconds}});
  for (const StartEnd& start : result.starts) starts.push_back(number(start.cost));
  Json effects = Json::array();
  for (const EarnedEffect& e : result.effects)
    effects.push_back({{"effect", e.effect}, {"heldout_gain", number(e.gain)}, {"kept", e.kept}});
  return {{"channels", to_json(result.channels)},
          {"parameters", parameters},
          {"effects", effects},
          {"starts", starts},
          {"reached_best", result.reached_best()},
          {"interrupted", result.interrupted},
          {"logs", logs},
          {"local", {{"stages", stages}, {"ceres", ceres_json(result)}}}};
}

}  // namespace servodx::report
