// Lag of the flow meters of a test stand: a gear or turbine meter and its filter follow a change of flow within some
// tenths of a second, so that the two branches of a sweep part by rate times lag, which looks like hysteresis and is
// none. First order, from sample to sample.
#pragma once
#include "effects/effect.h"
#include "effects/sampled_lag.h"
#include "model/shown.h"

namespace servodx {

struct FlowMeterLag {
  static constexpr const char* name = "flow_meter_lag";
  static constexpr const char* place = "sensor:leakage_flow";
  static constexpr const char* meaning = "flow meters of a test stand follow late";
  static constexpr bool stand_only = true;
  static constexpr Freed freed = Freed::on_stands;
  static constexpr SoughtAs sought_as = SoughtAs::meter_by_meter;
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 2;
  static constexpr int shown_at[n_parameters] = {shown::control_flow, shown::leakage_flow};
  static constexpr EffectParameter parameters[n_parameters] = {
      {"control_flow_lag", "s", 0.0, 0.0, 5.0, 0.3, "time constant of the control flow meter"},
      {"leakage_flow_lag", "s", 0.0, 0.0, 5.0, 0.3, "time constant of the leakage flow meter"},
  };

  template <class T>
  struct Sensors {
    SampledLag<T> meter[n_parameters];
  };
  template <class T>
  static void observe(Sensors<T>& m, double time, T* shown, const T* q) {
    for (int k = 0; k < n_parameters; ++k) shown[shown_at[k]] = m.meter[k](time, shown[shown_at[k]], q[k]);
  }
};

}  // namespace servodx
