// Magnetic hysteresis of the torque motor, as four play operators between command and torque (Prandtl-Ishlinskii; see
// Visintin, Differential Models of Hysteresis, 1994). Rate-independent, exact at the samples, adds no state to the
// equations. Leaves out: dependence on the armature's angle, and the pinching of the loop near saturation.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct MagneticHysteresis {
  static constexpr const char* name = "magnetic_hysteresis";
  static constexpr const char* place = "drive";
  static constexpr const char* meaning = "torque lags the current by a loop that does not depend on rate";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 2;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"hysteresis_width", "-", 0.0, 0.0, 0.06, 0.012,
       "full width of the loop of a large cycle, fraction of rated current"},
      {"hysteresis_reach", "-", 0.1, 0.01, 0.6, 0.1,
       "amplitude from which the loop has its full width, fraction of rated current", false},
  };
  static constexpr int elements = 4;
  static constexpr double spacing[elements] = {0.125, 0.25, 0.5, 1.0};  // thresholds over reach
  static constexpr double spacing_sum = 1.875;

  template <class T>
  struct Memory {
    T play[elements];
  };
  // History that ends at `current` with the loop closed.
  template <class T>
  static void rest(Memory<T>& m, const T& current) {
    for (T& x : m.play) x = current;
  }
  // [A] what the torque motor feels; q: own parameters, rated [A].
  template <class T>
  static T drive(Memory<T>& m, double, const T& current, const T* q, const T& rated) {
    using std::max;
    using std::min;
    const T reach = q[1] * rated;
    const T weight = q[0] * rated * T(0.5 / spacing_sum) / reach;
    T sum = T(0.0);
    for (int j = 0; j < elements; ++j) {
      const T r = reach * T(spacing[j]);
      m.play[j] = max(current - r, min(current + r, m.play[j]));
      sum = sum + (m.play[j] - current);
    }
    return current + weight * sum;
  }
};

}  // namespace servodx
