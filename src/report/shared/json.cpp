#include "report/shared/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/result_schema.h"
#include "evidence/conditions.h"
#include "report/shared/handy.h"
#include "report/shared/row_verdict_word.h"
#include "servodx/log.h"
#include "servodx/tune.h"

namespace servodx::report {
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
  Json out = {{"tool", "servodx"}, {"version", header.version}};
  if (!header.commit.empty()) out["commit"] = header.commit;
  out.update({{"schema", result_schema},
              {"command", header.command},
              {"seed", header.seed},
              {"settings", *header.settings},
              {"inputs", inputs},
              {"seconds", number(header.seconds)},
              {"simulations", header.simulations},
              {"failed_simulations", header.failed_simulations},
              {"notes", header.notes}});
  return out;
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

Json to_json(const std::vector<ChannelResult>& channels) {
  Json array = Json::array();
  for (const ChannelResult& channel : channels) array.push_back(to_json(channel));
  return array;
}

std::string dump(const Header& header, const Json& body) {
  Json all = to_json(header);
  all.update(body);
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace servodx::report
