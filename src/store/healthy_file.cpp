#include "store/healthy_file.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"
#include "evidence/conditions.h"

namespace servodx::store {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

HealthyReference read_healthy(const std::string& path) {
  constexpr const char* make_again = "make it again with 'servodx baseline'";
  const auto refuse = [&](const char* key, const char* rule) { throw InputError({path, 0, key}, rule, make_again); };
  HealthyReference out;
  try {
    const Json file = json_in_file<Json>(path, make_again);
    if (!file.contains("explain")) refuse("explain", "says nothing of what healthy logs show of each cause");
    const auto value = [](const Json& j) { return j.is_number() ? j.get<double>() : std::nan(""); };
    for (const Json& l : file.at("explain").at("logs")) {
      HealthyLog log;
      log.log = l.at("log").get<std::string>(), log.sha256 = l.at("sha256").get<std::string>();
      if (l.contains("other")) log.other = l.at("other").get<bool>();  // later than the rest
      if (l.contains("test") && l.at("test").is_object()) {            // the same
        const Json& test = l.at("test");
        log.test =
            TestConditions{value(test.at("drive_span")), value(test.at("drive_band")), {}, value(test.at("drive_rms"))};
        if (test.at("temperature").is_number()) log.test->temperature = value(test.at("temperature"));
      }
      log.adequacy = value(l.at("adequacy")), log.air = value(l.at("air_fraction"));
      for (const Json& e : l.at("errors"))
        log.errors.push_back({e.at("signal").get<std::string>(), value(e.at("size")), value(e.at("memory")),
                              value(e.at("effective")), value(e.at("rate"))});
      for (const Json& s : l.at("scores")) {
        HealthyScore score{
            s.at("effect").get<std::string>(), s.at("where").get<std::string>(), {}, value(s.at("gain")), 1.0};
        if (s.contains("prior")) score.prior = value(s.at("prior"));  // later than the rest
        for (const Json& p : s.at("sizes")) score.sizes.push_back({value(p.at(0)), value(p.at(1))});
        log.scores.push_back(std::move(score));
      }
      if (l.contains("thickness"))  // later than the rest
        for (HealthyScore& s : log.scores) s.thickness = value(l.at("thickness"));
      if (l.contains("drive_delay")) log.drive_delay = value(l.at("drive_delay"));        // later than the rest
      if (l.contains("command_slope")) log.command_slope = value(l.at("command_slope"));  // later than the rest
      if (l.contains("misses"))
        for (const auto& [part, size] : l.at("misses").items()) log.misses.push_back({part, value(size)});
      log.has_shares = l.contains("shares");  // later than the rest
      if (log.has_shares)
        for (const Json& h : l.at("shares"))
          log.shares.push_back({h.at("effect").get<std::string>(), h.at("where").get<std::string>(),
                                value(h.at("share")), value(h.at("lower")), value(h.at("prior"))});
      out.logs.push_back(std::move(log));
    }
  } catch (const Json::exception&) {
    refuse("explain", "is not as 'baseline' writes it");
  }
  return out;
}

}  // namespace servodx::store
