// Whether a figure grows, how, and when it will pass a level: Bayesian regression averaged over growth laws.
//
//   y(t) = base + temperature terms + (a + d1 z + d2 z2) g((t - t0) / (now - t0)) + wander + noise,   g(1) = 1
//
// z, z2: the first two features (log of viscosity and its square): wear that acts through the oil shows more or less of
// itself in the cold, or, as likely beforehand, does not; it may do so differently from check to check. g: power laws
// s^p (p = 1 is the linear one), exponentials; t0: onsets from the first check on. Wander is a Wiener process: no law
// is quite the wear's. Given law, onset, noise and wander all else is linear and Gaussian, so each is integrated in
// closed form (a Rao-Blackwellised particle filter whose particles are a fixed grid: deterministic, and no degeneracy).
// Their evidences weigh them. The same without growth is the null hypothesis, and the Bayes factor between the two is
// the trend test: under the null a Bayes factor exceeds 1/alpha with probability alpha at most, however often one looks
// (Ville 1939).
//
// Of a part that is being lost (a filter's area) the drop over it is followed, at the same flow, over that of the whole
// one as the model has it:
//
//   y(t) = base(z) + m (R(t) - 1) + (d1 z + d2 z2) R(t) + noise,   R = 1 / (1 - lost g)^2
//
// What else is wrong in the flow's path adds to the drop, and how large the part is in thick oil multiplies it. `lost`
// is on the grid, m about 1. Limits: one growth, monotone but for its wander; what changes its law later is seen late.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "prognose/life.h"

namespace servodx {

struct GrowthPoint {
  double time = 0;  // [h]
  double y = 0;
  double variance = 0;           // [y^2] of the figure by its own standard error
  std::vector<double> features;  // of the conditions: what temperature does, as known before any fit
  double exposed = 0;            // [y] growth so far, as neighbours show it, times the first feature's size
  double stretch = 1;            // y per unit of what wears, here
  double base_shown = 1;         // part of the base that shows at these conditions
  bool at_most = false;          // the figure's scale ends here: `y` or less
};

struct GrowthPrior {
  double base = 0, base_sd = 1;                  // of y
  std::vector<double> feature_mean, feature_sd;  // of the features' coefficients
  double noise = 1;                              // [y] about which the noise level is searched, 1/10 to 10 times
  double scale = 1;                              // [y] size of a growth that matters, one standard deviation
  int direction = 0;                             // +1, -1: growth to one side; 0: either
  double tilt = 0;                               // spread of d1 over the growth so far; of d2 a third (a drop: as d1)
  double size_sd = 0.25;                         // of a drop: of that over the whole part, as the model has it
  double scatter = 0;                            // spread of one check over what is `exposed`, or, as likely, none
  bool coarse = false;                           // fewer onsets and parts lost: for a first look
  bool of_drop = false;                          // y is a drop over a part that is being lost, see above
};

struct Growth {
  double log_bayes_factor = 0;       // of growth over none
  double probability = 0;            // of growth, even odds before
  double now = 0, now_sd = 0;        // of y at reference conditions, at the last check
  double base = 0, base_sd = 0;      // without growth
  double slope = 0;                  // [y/h] at the last check, mean
  double grown = 0, grown_sd = 0;    // to the last check, wander included
  double size = 1;                   // of a drop over the whole part, as the model has it: m above
  std::vector<double> coefficients;  // of the features
  double noise = 0;                  // [y] of one check
  double null_noise = 0;             // the same without growth
};

// Where y has failed: at these values, at these multiples of where it began, or so far from there.
struct FailureAt {
  enum class Of { value, times_base, beyond_base };
  std::optional<double> upper, lower;
  Of of = Of::value;
  double sd = 0;  // of the level itself, in what wears: of a drop in the part that is lost
  // `size`: of what is followed, in what the model takes for one; a drop's only.
  double level(double given, double base, double size = 1) const {
    return of == Of::times_base ? given * base : of == Of::beyond_base ? base + given * size : given;
  }
};

struct GrowthComponent;

class GrowthModel {
 public:
  GrowthModel(std::vector<GrowthPoint> points, const GrowthPrior& prior);
  const Growth& growth() const { return growth_; }
  // What a check at this time would have read at reference conditions: features zero.
  double at_reference(const GrowthPoint& point) const;
  // What such a check reads, noise apart.
  double expected(const GrowthPoint& point) const;
  // Hours until y at reference conditions passes a level; `upper` counts for growth upwards. Given growth.
  Life life(const FailureAt& level, std::uint64_t seed) const;

  ~GrowthModel();
  GrowthModel(GrowthModel&&) noexcept;
  GrowthModel& operator=(GrowthModel&&) noexcept;

 private:
  double by_conditions(const GrowthPoint& point) const;
  std::vector<GrowthComponent> components_;
  std::vector<std::size_t> added_;  // features that add
  double now_ = 0, length_ = 0;     // [h] of the last point, and since the first
  Growth growth_;
};

}  // namespace servodx
