#include "explain/sought_cause.h"

#include <algorithm>
#include <utility>

#include "effects/effect.h"
#include "explain/constants.h"

namespace servodx {

namespace k = explain_constants;

FreeValue effect_value(const EffectInfo& effect, std::size_t j, const ParameterVector& tuned) {
  const EffectParameter& p = effect.parameters[j];
  const int at = effect.first + static_cast<int>(j);
  const double v = tuned[static_cast<std::size_t>(at)];
  const double upper = p.switches && p.off == p.lower ? std::max(p.upper, k::effect_growth * v) : p.upper;
  return {p.name, at, std::min(p.lower, v), std::max(upper, v), false, v};
}

FreeValue row_value(const Table& tuned, int at) {
  const Row& r = tuned[at];
  return {r.name, at, std::min(r.lower, r.nominal), std::max(r.upper, r.nominal), r.log_scale, r.nominal};
}

std::vector<double> sizes_within(const FreeValue& value, const std::vector<double>& asked) {
  std::vector<double> out;
  for (double v : asked)
    if (v >= value.lower && v <= value.upper && v != value.start && std::find(out.begin(), out.end(), v) == out.end())
      out.push_back(v);
  return out;
}

std::vector<double> sizes_of_row(const FreeValue& value) {
  const double u = value.to_unit(value.start);
  std::vector<double> out;
  for (double du : {k::tried::near_row, -k::tried::near_row, k::tried::far_row, -k::tried::far_row})
    if (u + du >= 0 && u + du <= 1) out.push_back(value.from_unit(u + du));
  return out;
}

Number number_of(const CauseNumber& number) {
  Number out{number.value, number.value.start, number.size};
  out.unit = number.unit;
  return out;
}

std::vector<std::vector<std::vector<double>>> probes_of(const std::vector<CauseNumber>& numbers) {
  std::vector<double> rest;
  for (const CauseNumber& n : numbers) rest.push_back(n.value.start);
  std::vector<std::vector<std::vector<double>>> alternatives;
  std::vector<std::vector<double>> together;
  for (std::size_t j = 0; j < numbers.size(); ++j)
    for (std::size_t k = 0; k < numbers[j].sizes.size(); ++k) {
      std::vector<double> probe = rest;
      probe[j] = numbers[j].sizes[k];
      alternatives.push_back({probe});
      if (k == 0) together.push_back(probe);
    }
  if (together.size() > 1) alternatives.push_back(together);
  // A shape that the table has, and no log has shown, may suit what it had to imitate.
  const std::size_t plain = alternatives.size();
  for (std::size_t j = 0; j < numbers.size(); ++j)
    for (std::size_t k = 0; numbers[j].typical && k < plain; ++k) {
      std::vector<std::vector<double>> alternative = alternatives[k];
      for (std::vector<double>& probe : alternative) probe[j] = *numbers[j].typical;
      alternatives.push_back(std::move(alternative));
    }
  return alternatives;
}

Cause named(std::string effect, std::string where, double prior) {
  Cause cause;
  cause.effect = std::move(effect);
  cause.where = std::move(where);
  cause.prior = prior;
  return cause;
}

SoughtCause sought(Cause cause, const std::vector<CauseNumber>& numbers) {
  std::vector<FreeValue> values;
  for (const CauseNumber& n : numbers) {
    cause.numbers.push_back(number_of(n));
    values.push_back(n.value);
  }
  cause.probes = probes_of(numbers);
  return {std::move(cause), std::move(values)};
}

}  // namespace servodx
