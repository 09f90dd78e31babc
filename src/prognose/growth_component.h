// One growth among those that a model averages over: a law, an onset, a noise and a wander, and what the points then
// say of its size. Growth is told as y, and of a part that is lost as the drop over it.
#pragma once
#include <Eigen/Dense>

#include "prognose/growth.h"
#include "prognose/growth_law.h"
#include "prognose/growth_regression.h"

namespace servodx {

struct GrowthComponent {
  double weight = 0;
  GrowthLaw law;
  bool of_drop = false;
  double lost = 0;             // to now, of a part
  double onset = 0, span = 1;  // [h]
  int direction = 0;
  double noise = 0, wander = 0;            // wander: of what wears
  double a = 0, a_sd = 0;                  // growth to now
  Eigen::Vector2d d;                       // of it per unit of the first features; of a drop all of it
  double base = 0, base_sd = 0, tilt = 0;  // given a: base - tilt (a' - a), with this spread
  double strayed = 0, strayed_sd = 0;      // wander to now, of what wears
  Terms mean;

  double along(double time) const { return law.at((time - onset) / span); }
  double grown(double time) const;            // growth at a time, as a part of that to now
  double by_oil(const GrowthPoint& p) const;  // what the oil makes of it
  double size() const { return of_drop && lost > 0 ? a / drop_beyond_whole(lost) : 1.0; }
  double slope_now() const;
  // Part of the span from the onset on at which the curve reaches a level, with what wears astray by so much.
  double reaches(double level, double from, double growth, double astray) const;
};

}  // namespace servodx
