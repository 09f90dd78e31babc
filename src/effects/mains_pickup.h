// Mains pick-up: an alternating voltage of the mains' frequency on a line. On a sensor's it adds to what is shown and
// moves nothing; on the command's the valve follows it. As cosine and sine, so that the size is linear and the phase
// needs no search; the phase counts from the log's time zero and belongs to that log. Leaves out: harmonics, and a
// mains frequency that wanders in the log.
#pragma once
#include <cmath>
#include <numbers>

#include "base/pack.h"
#include "effects/effect.h"
#include "model/shown.h"

namespace servodx {

struct MainsPickup {
  static constexpr const char* name = "mains_pickup";
  static constexpr const char* place = "sensor";
  static constexpr const char* meaning = "the mains' frequency on the line of a sensor or of the command";
  static constexpr SoughtAs sought_as = SoughtAs::line_by_line;
  static constexpr const char* best_test = "rest: a line at the mains frequency with the valve still";
  static constexpr int n_states = 0;
  // Spool, piston, pressure a, pressure b: the first of what the model shows.
  static constexpr int sensors = shown::pressure_b + 1;
  static constexpr int current = sensors, channels = sensors + 1;
  static constexpr int n_parameters = 3 * channels;  // cosine and sine of each channel, then each one's frequency
  static constexpr EffectParameter parameters[n_parameters] = {
      {"mains_spool_cos", "m", 0.0, -5e-5, 5e-5, 3e-6, "pick-up of the spool sensor, cosine"},
      {"mains_spool_sin", "m", 0.0, -5e-5, 5e-5, 3e-6, "sine"},
      {"mains_piston_cos", "m", 0.0, -5e-3, 5e-3, 5e-5, "pick-up of the piston sensor, cosine"},
      {"mains_piston_sin", "m", 0.0, -5e-3, 5e-3, 5e-5, "sine"},
      {"mains_pressure_a_cos", "Pa", 0.0, -2e6, 2e6, 5e4, "pick-up of pressure A, cosine"},
      {"mains_pressure_a_sin", "Pa", 0.0, -2e6, 2e6, 5e4, "sine"},
      {"mains_pressure_b_cos", "Pa", 0.0, -2e6, 2e6, 5e4, "pick-up of pressure B, cosine"},
      {"mains_pressure_b_sin", "Pa", 0.0, -2e6, 2e6, 5e4, "sine"},
      {"mains_current_cos", "-", 0.0, -0.1, 0.1, 3e-3, "pick-up of the command, fraction of rated current, cosine"},
      {"mains_current_sin", "-", 0.0, -0.1, 0.1, 3e-3, "sine"},
      {"mains_spool_frequency", "Hz", 50.0, 45.0, 65.0, 50.0, "of the mains, as the spool sensor shows it", false},
      {"mains_piston_frequency", "Hz", 50.0, 45.0, 65.0, 50.0, "as the piston sensor shows it", false},
      {"mains_pressure_a_frequency", "Hz", 50.0, 45.0, 65.0, 50.0, "as the sensor of pressure A shows it", false},
      {"mains_pressure_b_frequency", "Hz", 50.0, 45.0, 65.0, 50.0, "as the sensor of pressure B shows it", false},
      {"mains_current_frequency", "Hz", 50.0, 45.0, 65.0, 50.0, "as the command has it", false},
  };

  // What channel k picks up; q: own parameters.
  template <class T>
  static T picked_up(const T* q, int k, double time) {
    T out = T(0.0);
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
      const double a = Lanes<T>::get(q[2 * k], lane), b = Lanes<T>::get(q[2 * k + 1], lane);
      if (a == 0 && b == 0) continue;
      const double turn = 2.0 * std::numbers::pi * Lanes<T>::get(q[2 * channels + k], lane) * time;
      Lanes<T>::set(out, lane, a * std::cos(turn) + b * std::sin(turn));
    }
    return out;
  }
  template <class T>
  struct Sensors {};
  template <class T>
  static void observe(Sensors<T>&, double time, T* shown, const T* q) {
    for (int k = 0; k < sensors; ++k) shown[k] = shown[k] + picked_up(q, k, time);
  }
  template <class T>
  struct Memory {
    void take_lane(const Memory&, int) {}
  };
  template <class T>
  static void rest(Memory<T>&, const T&, const T&, const T*, const T&) {}
  // [A] what the torque motor feels.
  template <class T>
  static T drive(Memory<T>&, double time, const T& felt, const T&, const T* q, const T& rated) {
    return felt + picked_up(q, current, time) * rated;
  }
};

}  // namespace servodx
