#include "explain/describe.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "base/normal.h"
#include "effects/registry.h"
#include "effects/row_effects.h"
#include "explain/beside_healthy.h"
#include "explain/fit_causes.h"
#include "explain/healthy.h"
#include "explain/outcome.h"
#include "fit/free_values.h"
#include "parameters/list.h"

namespace servodx {

double healthy_spread(const Subject& subject, const HealthyTest& test, int cause, std::size_t number, double std_error,
                      double of) {
  const Cause& c = subject.causes()[static_cast<std::size_t>(cause)];
  const Number& n = c.numbers[number];
  HealthyScore here{c.effect, place_key(c), {}, 0, 1, subject.thickness()};
  for (std::size_t a = 0; n.size && a < c.probes.size(); ++a) {
    const auto& probe = c.probes[a].front();
    if (c.probes[a].size() > 1 || probe[number] == n.off) continue;
    const double unit = c.atop.empty() ? std::abs(probe[number] - n.off) : 1 / of;  // as `summarise` counts
    here.sizes.assign(a + 1, {0, std_error / unit});
    return unit * test.spread(here, a);
  }
  return 0;
}

std::string meaning_of(const Cause& c) {
  if (const int row = find_parameter(c.effect); row >= 0)
    return std::string(parameter_list[static_cast<std::size_t>(row)].meaning);
  for (const RowEffect& e : row_effects())
    if (e.name == c.effect && e.where == c.where) return e.meaning;  // a lag of one sensor is not that of another
  for (const EffectInfo& e : effect_list())
    if (e.name == c.effect) return e.meaning;
  return {};
}

ExplainedParameter sized(const Number& n, double value, double std_error, double factor) {
  ExplainedParameter out{n.name, n.unit, factor * value, factor * std_error, factor * n.off};
  const double lower = value - normal_95_one_sided * std_error, upper = value + normal_95_one_sided * std_error;
  out.lower = factor * std::max(lower, n.lower), out.upper = factor * std::min(upper, n.upper);
  if (!std::isfinite(std_error)) {
    out.lower = out.upper = std::nan("");
    out.told = SizeTold::at_bound;
  } else if (lower <= n.lower && upper >= n.upper) {
    out.told = SizeTold::not_told;
  }
  return out;
}

namespace {

std::vector<std::string> confusable_with(const Inquiry& q, const CauseResult& r) {
  std::vector<std::string> out;
  for (const int other : r.confusable_with) out.push_back(name_of(q.cause(other)));
  const Cause& c = q.cause(r.cause);
  for (const RowEffect& e : row_effects())
    if (e.name == c.effect && e.where == c.where && e.also) out.push_back(e.also);
  return out;
}

// Where it shows several times its error most.
std::string place_of(const Cause& c, const CauseResult& r) {
  std::string out = c.where;
  double surest = 0;
  for (std::size_t j = 0; j < c.places.size(); ++j) {
    const double times = r.std_error[j] > 0 ? std::abs(r.value[j] - c.numbers[j].off) / r.std_error[j] : 0.0;
    if (c.numbers[j].size && times > surest) surest = times, out = c.places[j];
  }
  return out;
}

}  // namespace

std::string name_of(const Cause& c) { return c.effect + (is_of_sensor(c) ? " at " + c.where : ""); }

ExplainedCause described(const Inquiry& q, const Subject& told_by, const CauseResult& r, const ExplainedFit& fit) {
  const Cause& c = q.cause(r.cause);
  const bool by_simulation = &told_by == static_cast<const Subject*>(&q.subject());
  ExplainedCause out;
  out.effect = c.effect, out.where = place_of(c, r), out.test = c.test, out.meaning = meaning_of(c);
  out.heldout_gain = r.heldout_gain, out.beyond_retuning = r.beyond_retuning, out.delta_bic = r.delta_bic;
  out.told_by = by_simulation ? ToldBy::simulation : ToldBy::blocks, out.curve = c.curve, out.of_sensor = is_of_sensor(c);
  const auto& values = q.subject().values(r.cause);
  for (std::size_t j = 0; j < c.numbers.size(); ++j) {
    double factor = 1;
    if (values[j].apply && !c.curve)  // a factor on the log's own
      factor = q.subject().candidate(fit.causes, fit.point, 0)[static_cast<std::size_t>(values[j].at)] / r.value[j];
    const double scatter = q.test() ? healthy_spread(told_by, *q.test(), r.cause, j, r.std_error[j], factor) : 0.0;
    const double error = std::hypot(r.std_error[j], scatter);
    out.parameters.push_back(sized(c.numbers[j], r.value[j], error, factor));
  }
  out.confusable_with = confusable_with(q, r);
  return out;
}

ExplainedCause described_standing(const Inquiry& q, const CauseResult& r) {
  ExplainedFit alone;
  alone.causes = {r.cause};
  alone.point = q.subject().start(alone.causes);
  return described(q, q.subject(), r, alone);
}

}  // namespace servodx
