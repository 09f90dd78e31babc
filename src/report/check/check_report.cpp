#include "report/check/check_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/celsius.h"
#include "faults/fault.h"
#include "faults/registry.h"
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
  if (const Fault* fault = find_fault(c.cause); fault && fault->along && c.along)
    json["along"] = {{"name", fault->along->name},
                     {"value", number(c.along->value)},
                     {"std_error", number(c.along->std_error)},
                     {"whole_error", number(c.along->whole_error)}};
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

// A part lost is told by the drop over what is left, and that of a clean screen is known no better than the bores; of
// another size the model's form leaves as much open as its fault states.
std::string untold(const Check& c) {
  if (c.told) return "";
  const bool apart = std::abs(c.value - c.tuned) > 2 * c.whole_error;
  const Fault* fault = find_fault(c.cause);
  const char* by = fault && fault->part_lost ? "by the drop over it " : "by the model's form ";
  return fmt::format(": {}not distinguished from the tuned {}", apart ? by : "", handy(c.tuned, c.unit));
}

// What wears along, where the wear is told.
std::string beside(const Check& c) {
  const Fault* fault = find_fault(c.cause);
  if (!c.told || !c.along || !fault || !fault->along) return "";
  return fmt::format("; {}: {} +- {}", fault->along->name, digits(c.along->value, 2), digits(c.along->whole_error, 2));
}

}  // namespace

std::string text_of(const CheckResult& r) {
  Columns rows("lrlrl", 2);
  for (const Check& c : r.checks)
    rows.row({name_of(c), handy(c.value, c.unit), "+-", handy(c.std_error, c.unit),
              std::isfinite(c.whole_error) ? fmt::format("with the model's own error +- {}{}{}",
                                                         handy(c.whole_error, c.unit), untold(c), beside(c))
              : c.value != c.measured      ? "measured " + handy(c.measured, c.unit)
                                           : ""});
  std::string text = fmt::format("{}: oil at {:.1f} degC ({})\n", r.log, r.temperature.value - zero_celsius,
                                 name_of(r.temperature.source));
  return text + rows.text();
}

}  // namespace servodx::report
