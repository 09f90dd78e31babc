#include "report/prognosis.h"

#include <fmt/format.h>

#include <cmath>

#include "report/columns.h"
#include "report/handy.h"

namespace servodx::report {
namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string name_of(const Check& c) { return c.cause.empty() ? c.name : c.name + " (" + c.cause + ")"; }

}  // namespace

Json to_json(const Check& c, double temperature) {
  Json json = {{"name", c.name},
               {"value", number(c.value)},
               {"std_error", number(c.std_error)},
               {"unit", c.unit},
               {"temperature", number(temperature)},
               {"measured", number(c.measured)},
               {"expected", number(c.expected)}};
  if (!c.cause.empty()) json["cause"] = c.cause;
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
            {"source", r.temperature.source}}},
          {"offset", number(r.offset)},
          {"null", r.null ? number(*r.null) : Json(nullptr)},
          {"no_response", r.no_response},
          {"adequacy", number(r.adequacy)},
          {"mean_error",
           {{"settled", r.mean_error.settled}, {"settled_at", number(r.mean_error.settled_at)}, {"unit", "s"}}}};
}

std::string text_of(const CheckResult& r) {
  Columns rows("lrlrl", 2);
  for (const Check& c : r.checks)
    rows.row({name_of(c), handy(c.value, c.unit), "+-", handy(c.std_error, c.unit),
              c.value != c.measured ? "measured " + handy(c.measured, c.unit) : ""});
  std::string text =
      fmt::format("{}: oil at {:.1f} degC ({})\n", r.log, r.temperature.value - 273.15, r.temperature.source);
  return text + rows.text();
}

}  // namespace servodx::report
