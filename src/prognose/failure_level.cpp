#include "prognose/failure_level.h"

#include <cmath>
#include <optional>

#include "faults/fault.h"
#include "parameters/list.h"
#include "prognose/reading_scale.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

// The value of a fault's row where it has failed: for severities that multiply, of what it was.
std::optional<double> failed_row(const Fault& fault) {
  if (!fault.failed) return {};
  const double healthy = fault.log_scale ? 1.0 : 0.0;
  ParameterVector v(n_candidate, healthy), moved = v;
  fault.apply(moved.data(), *fault.failed);
  for (int i = 0; i < n_parameters; ++i)
    if (moved[i] != v[i]) return moved[i];
  return {};
}

// What the model's form leaves open of a severity at a value of its row, in the coordinate of the growth: it reads a
// level, whoever set it, no better than that.
double left_open(const Fault& fault, double value) {
  return fault.log_scale ? fault.spread * std::abs(value) : fault.spread;
}

// How well a level is known at a value of the row: as who set it says, else as the model's form allows.
double known_to(const CheckSeries& s, const TrendSettings& options, double value, double unit) {
  const auto stated = options.failure_spread.find(s.name);
  if (stated != options.failure_spread.end()) return stated->second * unit;
  if (!s.curve.empty()) return s.curve.spread(s.scale.in(value)) * s.scale.stretch(value);
  return s.fault ? left_open(*s.fault, value) : 0.0;
}

FailureAt given_level(const CheckSeries& s, const TrendSettings& options, const OneOrTwoLevels& given) {
  FailureAt at;
  at.lower = s.scale.in(given.first), at.upper = s.scale.in(given.second);
  if (const auto& level = at.upper ? at.upper : at.lower; level && s.fault)
    at.sd = known_to(s, options, s.scale.out(*level), 1);
  return at;
}

FailureAt given_current(const CheckSeries& s, const TrendSettings& options, double current) {
  FailureAt at;
  at.upper = current / *s.per_newton;
  at.sd = known_to(s, options, *at.upper, 1 / *s.per_newton);
  return at;
}

FailureAt given_ratio(const CheckSeries& s, const TrendSettings& options, double ratio) {
  FailureAt at;
  auto& side = ratio > 1 ? at.upper : at.lower;
  if (s.fault && s.fault->log_scale && s.tuned) {  // its healthy checks may hardly see it: the tuning logs saw more
    side = ratio * *s.tuned;
    at.sd = known_to(s, options, ratio * *s.tuned, *s.tuned);
    return at;
  }
  at.of = s.scale.paper() ? FailureAt::Of::beyond_base : FailureAt::Of::times_base;
  side = s.scale.paper() ? std::log(ratio) : ratio;
  return at;
}

}  // namespace

FailureAt own_failure(const CheckSeries& s) {
  FailureAt at;
  const auto failed = s.fault ? failed_row(*s.fault) : std::nullopt;
  if (!failed) return at;
  auto& side = *failed > (s.fault->log_scale ? 1 : 0) ? at.upper : at.lower;
  // A severity that multiplies does so to the tuned value; what the estimate errs by in health it errs by later.
  if (s.fault->log_scale && s.tuned) {
    at.of = FailureAt::Of::beyond_base;
    at.sd = left_open(*s.fault, *failed * *s.tuned);
    side = (*failed - 1) * *s.tuned;
    return at;
  }
  if (s.fault->log_scale) at.of = FailureAt::Of::times_base;
  // Of what was open at the beginning: how large a clean filter is stands on no data sheet, and no log tells it.
  if (s.fault->part_lost) at.of = FailureAt::Of::beyond_base;
  if (!s.fault->log_scale) at.sd = left_open(*s.fault, *failed);
  side = s.fault->part_lost ? ReadingScale::drop_at(*failed) - 1 : s.scale.in(*failed);
  return at;
}

FailureAt failure_of(const CheckSeries& s, const TrendSettings& options) {
  if (const auto given = options.failure.find(s.name); given != options.failure.end())
    return given_level(s, options, given->second);
  if (const auto current = options.failure_current.find(s.name);
      current != options.failure_current.end() && s.per_newton)
    return given_current(s, options, current->second);
  if (const auto ratio = options.failure_ratio.find(s.name); ratio != options.failure_ratio.end())
    return given_ratio(s, options, ratio->second);
  return own_failure(s);
}

}  // namespace servodx
