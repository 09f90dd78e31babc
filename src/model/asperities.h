// Dry friction as what carries it: asperities are springs until they slip, and bear their whole share from then on
// (Dahl 1968; Prandtl's elastic-plastic element). Their anchor is dragged along between steps, so a stuck part stays
// where it is, no corner in speed upsets a linearly implicit step, and two candidates that differ in a last digit stay
// together. Left out: memory of the time at rest, damping while they hold.
#pragma once
#include <algorithm>
#include <array>
#include <iterator>

#include "base/smooth.h"
#include "model/constants.h"

namespace servodx {

// Share of the friction that is borne, -1..1. stretch: from the anchor, in presliding lengths. Beyond 1 all have
// slipped and the share is exactly 1, however far a step runs ahead of its anchor: else friction would depend on the
// step.
template <class T, class X>
auto asperities(const X& stretch) {
  return flat_step(stretch);
}

// Anchor [m] after a move to x [m].
template <class T>
T dragged_anchor(const T& anchor, const T& x, const T& presliding) {
  using std::max, std::min;
  return max(min(anchor, x + presliding), x - presliding);
}

// Share of the breakaway friction that is left at a speed [m/s]: 1 at rest, a half at that of 1 / `per_fall`
// (Stribeck's curve). The speed is the last step's: a force that falls as speed rises is negative damping, which no
// linearly implicit step bears.
template <class X, class T>
X stribeck(const X& speed, const T& per_fall) {
  const X ratio = speed * per_fall;
  return inverse(ratio * ratio + T(1.0));
}

// Of the rod's seals: how much more they hold than they drag.
template <class T>
struct Breakaway {
  T over_sliding;    // [-] breakaway friction above sliding friction over sliding friction; 0: none
  T per_film_speed;  // [s/m]
};

// What spool and rod remember of their way.
template <class T>
struct FrictionMemory {
  T spool_anchor{}, spool_speed{};                                     // [m], [m/s] mean over the last step
  std::array<T, std::size(constants::seal_presliding)> seal_anchor{};  // [m]
  T rod_speed{};                                                       // [m/s] relative to the body
  T seal_breakaway = T(1.0);                                           // share that is left of the breakaway friction
  T seal_per_reach = T(1.0);  // sliding friction over what the seals hold: they are no stiffer for holding on longer

  // At rest and unstretched: which way they came is not known.
  void rest(const T& x_spool, const T& x_rod) {
    spool_anchor = x_spool;
    seal_anchor.fill(x_rod);
    spool_speed = rod_speed = T(0.0);
    seal_breakaway = seal_per_reach = T(1.0);
  }
  // After a step of h [s] between two places [m]. `sticks` false where no breakaway is above 0: the same bits, sooner.
  void move(const T& spool_from, const T& x_spool, const T& rod_from, const T& x_rod, double h,
            const T& spool_presliding, const Breakaway<T>& breakaway, bool sticks = true) {
    spool_anchor = dragged_anchor(spool_anchor, x_spool, spool_presliding);
    spool_speed = (x_spool - spool_from) * T(1.0 / h);
    rod_speed = (x_rod - rod_from) * T(1.0 / h);
    T reach = T(1.0);
    if (sticks) {
      // Friction follows the speed as contacts are renewed, over the way on which they slip: without that lag (Rice &
      // Ruina 1983; Armstrong-Helouvry et al. 1994) a slow piston would hunt where a real one creeps.
      using std::max;
      const T renewed = max(x_rod - rod_from, rod_from - x_rod) * T(1.0 / constants::seal_renewal);
      seal_breakaway =
          (seal_breakaway + renewed * stribeck(rod_speed, breakaway.per_film_speed)) * inverse(T(1.0) + renewed);
      reach = T(1.0) + breakaway.over_sliding * seal_breakaway;
      seal_per_reach = T(1.0) / reach;
    }
    for (std::size_t i = 0; i < seal_anchor.size(); ++i)
      seal_anchor[i] = dragged_anchor(seal_anchor[i], x_rod, T(constants::seal_presliding[i]) * reach);
  }
  // One lane of another memory.
  void take_lane(const FrictionMemory& from, int lane) {
    servodx::take_lane(spool_anchor, from.spool_anchor, lane);
    servodx::take_lane(spool_speed, from.spool_speed, lane);
    for (std::size_t i = 0; i < seal_anchor.size(); ++i) servodx::take_lane(seal_anchor[i], from.seal_anchor[i], lane);
    servodx::take_lane(rod_speed, from.rod_speed, lane);
    servodx::take_lane(seal_breakaway, from.seal_breakaway, lane);
    servodx::take_lane(seal_per_reach, from.seal_per_reach, lane);
  }
};

}  // namespace servodx
