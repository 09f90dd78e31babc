// Magnetic hysteresis of the torque motor: play operators between command and torque (Prandtl-Ishlinskii; see
// Visintin, Differential Models of Hysteresis, 1994), each with half the threshold of the last. Iron has domains of all
// sizes, so loops of all amplitudes open, and small ones cost gain: where each play's loop is half as wide as the last
// one's the width grows with the amplitude (Rayleigh 1887); less fading is iron that opens early. The armature's flux
// follows its angle too: a slewing flapper drives the iron beyond where the current alone would. Rate-independent,
// exact at the samples but for the angle, which is the last sample's; adds no state to the equations. Leaves out the
// pinching of the loop near saturation.
#pragma once
#include "base/pack.h"
#include "effects/effect.h"

namespace servodx {

struct MagneticHysteresis {
  static constexpr const char* name = "magnetic_hysteresis";
  static constexpr const char* place = "drive";
  static constexpr const char* meaning = "torque lags the current by a loop that does not depend on rate";
  static constexpr Freed freed = Freed::everywhere;
  static constexpr const char* best_test = "slow triangles of several amplitudes: a loop of the same width at any rate";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 4;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"hysteresis_width", "-", 0.0, 0.0, 0.06, 0.012,
       "full width of the loop of a large cycle, fraction of rated current"},
      {"hysteresis_reach", "-", 0.5, 0.02, 1.0, 0.5,
       "amplitude from which the loop has its full width, fraction of rated current; further where so wide a loop "
       "would leave small motions no gain",
       false},
      {"hysteresis_fading", "-", 0.5, 0.2, 1.5, 0.5,
       "width of the loop of each play over that of the play with twice its threshold", false},
      {"magnetic_spring", "-", 1.0, 0.0, 2.0, 1.0,
       "the magnets' spring over the armature's net stiffness: how much the iron's flux follows the angle", false},
  };
  static constexpr int elements = 7;            // down to 1/64 of the reach
  static constexpr double largest_loss = 0.45;  // of the gain at small loops; with the spring at its bound still stable

  template <class T>
  struct Memory {
    T play[elements];
    void take_lane(const Memory& from, int lane) {
      for (int j = 0; j < elements; ++j) servodx::take_lane(play[j], from.play[j], lane);
    }
  };
  // History that ends here with the loop closed. spring: current [A] that holds the flapper where it is against the
  // armature's net stiffness; q: own parameters; rated [A].
  template <class T>
  static void rest(Memory<T>& m, const T& current, const T& spring, const T* q, const T&) {
    for (T& x : m.play) x = current + q[3] * spring;
  }
  // [A] what the torque motor feels.
  template <class T>
  static T drive(Memory<T>& m, double, const T& current, const T& spring, const T* q, const T& rated) {
    using std::max;
    using std::min;
    const T flux = current + q[3] * spring;  // [A]
    T share = T(1.0), slope = T(1.0), shares = T(0.0), slopes = T(0.0);
    for (int j = 0; j < elements; ++j) {
      shares = shares + share;
      slopes = slopes + slope;
      share = share * q[2];
      slope = slope * T(2.0) * q[2];
    }
    const T weight = q[0] * rated * T(0.5) / shares;  // [A]
    // A loop too wide for its reach opens later.
    T threshold = max(q[1] * rated, weight * slopes * T(1.0 / largest_loss)), sum = T(0.0);
    share = T(1.0);
    for (int j = 0; j < elements; ++j) {
      m.play[j] = max(flux - threshold, min(flux + threshold, m.play[j]));
      sum = sum + share / threshold * (m.play[j] - flux);
      threshold = threshold * T(0.5);
      share = share * q[2];
    }
    return current + weight * sum;
  }
};

}  // namespace servodx
