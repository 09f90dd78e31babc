// Lag of the flow meters of a test stand: a gear or turbine meter and its filter follow a change of flow within some
// tenths of a second, so that the two branches of a sweep part by rate times lag, which looks like hysteresis and is
// none. First order, stepped from sample to sample (implicit Euler): true for lags above half a sample.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct FlowMeterLag {
  static constexpr const char* name = "flow_meter_lag";
  static constexpr const char* place = "sensor:leakage_flow";
  static constexpr const char* meaning = "flow meters of a test stand follow late";
  static constexpr bool stand_only = true;
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 2;
  static constexpr int shown_at[n_parameters] = {10, 11};  // control flow, leakage flow
  static constexpr EffectParameter parameters[n_parameters] = {
      {"control_flow_lag", "s", 0.0, 0.0, 5.0, 0.3, "time constant of the control flow meter"},
      {"leakage_flow_lag", "s", 0.0, 0.0, 5.0, 0.3, "time constant of the leakage flow meter"},
  };

  template <class T>
  struct Sensors {
    T last[n_parameters];
    double time = 0;
    bool begun = false;
  };
  template <class T>
  static void observe(Sensors<T>& m, double time, T* shown, const T* q) {
    for (int k = 0; k < n_parameters; ++k) {
      T& x = shown[shown_at[k]];
      if (m.begun) x = x - q[k] / (q[k] + T(time - m.time)) * (x - m.last[k]);
      m.last[k] = x;
    }
    m.time = time;
    m.begun = true;
  }
};

}  // namespace servodx
