// Mains pick-up: an alternating voltage of the mains' frequency on a sensor's line. Adds to what the sensor shows and
// moves nothing. As cosine and sine, so that the size is linear and the phase needs no search; the phase counts from
// the log's time zero and belongs to that log. Leaves out: harmonics, and a mains frequency that wanders in the log.
#pragma once
#include <cmath>

#include "base/pack.h"
#include "effects/effect.h"

namespace servodx {

struct MainsPickup {
  static constexpr const char* name = "mains_pickup";
  static constexpr const char* place = "sensor";
  static constexpr const char* meaning = "the mains' frequency on a sensor's line";
  static constexpr int n_states = 0;
  static constexpr int channels = 4;  // spool, piston, pressure a, pressure b: the first of what the model reports
  static constexpr int n_parameters = 2 * channels + 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"mains_spool_cos", "m", 0.0, -5e-5, 5e-5, 3e-6, "pick-up of the spool sensor, cosine"},
      {"mains_spool_sin", "m", 0.0, -5e-5, 5e-5, 3e-6, "sine"},
      {"mains_piston_cos", "m", 0.0, -5e-3, 5e-3, 5e-5, "pick-up of the piston sensor, cosine"},
      {"mains_piston_sin", "m", 0.0, -5e-3, 5e-3, 5e-5, "sine"},
      {"mains_pressure_a_cos", "Pa", 0.0, -2e6, 2e6, 5e4, "pick-up of pressure A, cosine"},
      {"mains_pressure_a_sin", "Pa", 0.0, -2e6, 2e6, 5e4, "sine"},
      {"mains_pressure_b_cos", "Pa", 0.0, -2e6, 2e6, 5e4, "pick-up of pressure B, cosine"},
      {"mains_pressure_b_sin", "Pa", 0.0, -2e6, 2e6, 5e4, "sine"},
      {"mains_frequency", "Hz", 50.0, 45.0, 65.0, 50.0, "of the mains", false},
  };

  template <class T>
  struct Sensors {};
  // Adds to what the sensors show; q: own parameters.
  template <class T>
  static void observe(Sensors<T>&, double time, T* shown, const T* q) {
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
      const double turn = 2.0 * 3.14159265358979323846 * Lanes<T>::get(q[2 * channels], lane) * time;
      double c = 0, s = 0;
      for (int k = 0; k < channels; ++k) {
        const double a = Lanes<T>::get(q[2 * k], lane), b = Lanes<T>::get(q[2 * k + 1], lane);
        if (a == 0 && b == 0) continue;
        if (c == 0 && s == 0) c = std::cos(turn), s = std::sin(turn);
        Lanes<T>::set(shown[k], lane, Lanes<T>::get(shown[k], lane) + a * c + b * s);
      }
    }
  }
};

}  // namespace servodx
