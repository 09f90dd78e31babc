#include "report/check/check_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/celsius.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"

namespace servodx::report {
namespace {

std::string name_of(const Check& c) { return c.cause.empty() ? c.name.text() : c.name.text() + " (" + c.cause + ")"; }

}  // namespace

Json to_json(const Check& c, double temperature) {
  Json json = {{"name", c.name.text()},
               {"value", number(c.value)},
               {"std_error", number(c.std_error)},
               {"unit", c.unit},
               {"temperature", number(temperature)},
               {"measured", number(c.measured)},
               {"expected", number(c.expected)}};
  if (!c.cause.empty()) json["cause"] = c.cause;
  if (std::isfinite(c.whole_error)) json["whole_error"] = c.whole_error, json["told"] = c.told;
  return json;
}

Json check_json(const CheckResult& r) {
  Json checks = Json::array();
  for (const Check& c : r.checks) checks.push_back(to_json(c, r.temperature.value));
  return {{"log", r.log},
          {"checks", checks},
          {"temperature",
           {{"value", number(r.temperature.value)},
            {"std_error", number(r.temperature.std_error)},
            {"unit", "K"},
            {"source", name_of(r.temperature.source)}}},
          {"offset", number(r.offset)},
          {"null", r.null ? number(*r.null) : Json(nullptr)},
          {"no_response", r.no_response},
          {"adequacy", number(r.adequacy)},
          {"mean_error",
           {{"settled", r.mean_error.settled}, {"settled_at", number(r.mean_error.settled_at)}, {"unit", "s"}}}};
}

namespace {

// A part lost is told by the drop over what is left, and that of a clean screen is known no better than the bores.
std::string untold(const Check& c) {
  if (c.told) return "";
  const bool apart = std::abs(c.value - c.tuned) > 2 * c.whole_error;
  return fmt::format(": {}not distinguished from the tuned {}", apart ? "by the drop over it " : "",
                     handy(c.tuned, c.unit));
}

}  // namespace

std::string text_of(const CheckResult& r) {
  Columns rows("lrlrl", 2);
  for (const Check& c : r.checks)
    rows.row({name_of(c), handy(c.value, c.unit), "+-", handy(c.std_error, c.unit),
              std::isfinite(c.whole_error)
                  ? fmt::format("with the model's own error +- {}{}", handy(c.whole_error, c.unit), untold(c))
              : c.value != c.measured ? "measured " + handy(c.measured, c.unit)
                                      : ""});
  std::string text = fmt::format("{}: oil at {:.1f} degC ({})\n", r.log, r.temperature.value - zero_celsius,
                                 name_of(r.temperature.source));
  return text + rows.text();
}

}  // namespace servodx::report
