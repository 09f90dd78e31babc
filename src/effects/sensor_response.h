// Gain error and first-order lag of the spool and pressure sensors; the piston's have rows of the table (29, 34).
// Reported as sensor_gain_error and sensor_lag at sensor:SIGNAL. Gain and lag act on what the sensor shows, before its
// offset.
#pragma once
#include "effects/effect.h"
#include "effects/sampled_lag.h"
#include "model/shown.h"

namespace servodx {

struct SensorResponse {
  static constexpr const char* name = "sensor_response";
  static constexpr const char* place = "sensor";
  static constexpr const char* meaning = "gain error and lag of the spool and pressure sensors";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr SoughtAs sought_as = SoughtAs::sensor_by_sensor;
  static constexpr int n_states = 0;
  static constexpr int channels = 3;
  static constexpr int shown_at[channels] = {shown::spool_position, shown::pressure_a, shown::pressure_b};
  static constexpr int n_parameters = 2 * channels;
  static constexpr double transmitter_class = 0.01;  // of industrial pressure transmitters with what they drift
  static constexpr EffectParameter parameters[n_parameters] = {
      {"spool_sensor_gain", "-", 1.0, 0.5, 1.5, 1.05, "indicated over true spool travel", true, false},
      {"spool_sensor_lag", "s", 0.0, 0.0, 0.02, 1e-3, "time constant of the spool sensor", true, false},
      {"pressure_a_sensor_gain", "-", 1.0, 0.5, 1.5, 1.05, "indicated over true pressure A", true, true,
       transmitter_class},
      {"pressure_a_sensor_lag", "s", 0.0, 0.0, 0.02, 2e-3, "time constant of the sensor of pressure A"},
      {"pressure_b_sensor_gain", "-", 1.0, 0.5, 1.5, 1.05, "indicated over true pressure B", true, true,
       transmitter_class},
      {"pressure_b_sensor_lag", "s", 0.0, 0.0, 0.02, 2e-3, "time constant of the sensor of pressure B"},
  };

  template <class T>
  struct Sensors {
    SampledLag<T> lag[channels];
  };
  template <class T>
  static void observe(Sensors<T>& m, double time, T* shown, const T* q) {
    for (int k = 0; k < channels; ++k) {
      T& x = shown[shown_at[k]];
      x = m.lag[k](time, x * q[2 * k], q[2 * k + 1]);
    }
  }
  // What stands behind a sensor at rest that shows `x`.
  template <class T>
  static T behind(int signal, const T& x, const T* q) {
    for (int k = 0; k < channels; ++k)
      if (signal == shown_at[k]) return x / q[2 * k];
    return x;
  }
};

}  // namespace servodx
