#include "report/trend/life_gauges.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "fleet/prometheus_text.h"
#include "prognose/trend.h"
#include "report/trend/trend_words.h"

namespace servodx::report {
namespace {

// Prometheus has its own word for what never comes.
std::string hours(double value) { return std::isinf(value) ? "+Inf" : fmt::format("{}", value); }

}  // namespace

std::string life_gauges(const std::vector<Trend>& trends) {
  using prometheus::head, prometheus::label;
  std::string out;
  head(out, "servodx_valve_state", "1 for the state that the valve's history shows.");
  for (const Trend& t : trends)
    out += fmt::format("servodx_valve_state{{valve={},state={}}} 1\n", label(t.valve), label(word_of(t.whole->state)));
  head(out, "servodx_valve_life_left_hours", "Hours of use until the valve fails: median and bounds.");
  for (const Trend& t : trends) {
    if (!t.remaining) continue;
    for (const auto& [bound, left] :
         {std::pair("lower", t.remaining->lower), {"median", t.remaining->median}, {"upper", t.remaining->upper}})
      if (!std::isnan(left))
        out += fmt::format("servodx_valve_life_left_hours{{valve={},bound={}}} {}\n", label(t.valve), label(bound),
                           hours(left));
  }
  return out;
}

}  // namespace servodx::report
