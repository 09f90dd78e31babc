// The coordinate in which the growth of a check is followed.
//
// The paper's positive figures in their logarithm, where what temperature does is a factor. A part lost (of a filter's
// area) by the drop over what is left, at the same flow, over that of the whole part: that is what a log tells, about
// equally well from clean to blocked, and what else is wrong in the pilot's path adds to it. Other parameters as they
// are. Limits: a drop ends at half of that over the whole part, and at `most_lost`; beyond it goes on straight.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "prognose/level.h"

namespace servodx {

struct ReadingScale {
  enum class Kind { plain, logarithm, drop };
  Kind kind = Kind::plain;
  double clean = 1;  // drop over the whole part, in that of the table's whole part

  static constexpr double most_lost = 0.999;  // nothing would flow at 1
  // Below half of the drop over the whole part a reading ends: from there on straight, so that every drop has a part.
  static constexpr double least_drop = 0.5;
  static double lost_at(double drop) {
    const double from = std::max(drop, least_drop);
    return 1 - 1 / std::sqrt(from) + (drop - from) * lost_per_drop(drop);
  }
  static double lost_per_drop(double drop) { return 0.5 * std::pow(std::max(drop, least_drop), -1.5); }
  static double drop_at(double lost) {
    const double from = std::clamp(lost, lost_at(least_drop), most_lost);
    return 1 / ((1 - from) * (1 - from)) + std::min(0.0, lost - from) / lost_per_drop(least_drop);
  }

  bool paper() const { return kind == Kind::logarithm; }
  bool of_drop() const { return kind == Kind::drop; }
  double in(double v) const { return paper() ? std::log(v) : of_drop() ? drop_at(v) / clean : v; }
  double out(double y) const { return paper() ? std::exp(y) : of_drop() ? lost_at(y * clean) : y; }
  // d out / d y at a value.
  double stretch(double v) const { return paper() ? std::abs(v) : of_drop() ? lost_per_drop(drop_at(v)) * clean : 1.0; }
  // How far a growth has come where its error matters as much at the first as at the last: of a drop its logarithm.
  double way(double grown) const { return of_drop() ? std::log1p(std::max(grown, 0.0)) : grown; }
  // The growth when a part of the way has been worn; of a drop it is the part lost that wears.
  double worn(double part, double grown) const {
    return of_drop() ? drop_at(part * lost_at(1 + std::max(grown, 0.0))) - 1 : part * grown;
  }
  std::optional<double> in(const std::optional<double>& v) const {
    return v && (!paper() || *v > 0) ? std::optional(in(*v)) : std::nullopt;
  }
  Level out(double lower, double upper) const { return {out(lower), out(upper)}; }
};

}  // namespace servodx
