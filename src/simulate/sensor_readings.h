// What a run reports at a sample: states, and the flows that follow from them, as the sensors show them, with their
// lag, gain, effects and offsets. Values behind filters and recorders of the rig are made of whole trajectories later
// (signals/low_pass.h).
//
// Limits: flows are those of the edges at that instant, without what fills the hoses. The drop over the valve is that
// over the two edges that are open; near null it passes from one pair to the other within `drop_rounding`.
// Source: docs/model.md; SAE ARP490 for the flows and the drop of a test stand.
#pragma once
#include <array>
#include <tuple>

#include "base/smooth.h"
#include "effects/sampled_lag.h"
#include "model/derivative.h"
#include "model/derived.h"
#include "model/hooks.h"
#include "model/shown.h"
#include "model/state.h"
#include "parameters/list.h"
#include "simulate/effect_memories.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"

namespace servodx {

inline constexpr double drop_rounding = 1e-6;  // [m] of spool travel, where the drop passes to the other two edges

template <class T, class Effects>
struct SensorReadings {
  Sensed<T, Effects> effects;
  SampledLag<T> rod_lag;

  // y: states, now: inputs, both at `time` [s]; p: rows. Flows are made only where one is wanted.
  template <class States>
  auto operator()(double time, const States& y, const Inputs<T>& now, const T* p, const Derived<T>& d,
                  const std::array<bool, n_simulated>& wanted) {
    std::array<T, n_simulated> out{};
    out[shown::spool_position] = y[s_x_spool];
    out[shown::piston_position] =
        p[row::position_sensor_gain] * rod_lag(time, y[s_x_piston], p[row::position_sensor_lag], y[s_v_piston]);
    out[shown::pressure_a] = y[s_p_a];
    out[shown::pressure_b] = y[s_p_b];
    out[shown::pilot_pressure_1] = y[s_p_pilot_1];
    out[shown::pilot_pressure_2] = y[s_p_pilot_2];
    effects_measured(out.data(), y.data(), p, Effects{});
    if (wanted[shown::flow_a] || wanted[shown::flow_b] || wanted[shown::control_flow] || wanted[shown::leakage_flow])
      flows(y, now, p, d, out);
    out[shown::load_pressure] = out[shown::pressure_a] - out[shown::pressure_b];
    out[shown::valve_pressure_drop] = now.supply_pressure - now.return_pressure -
                                      out[shown::load_pressure] * smooth_sign(y[s_x_spool], T(drop_rounding));
    effects(time, out.data(), p);
    out[shown::spool_position] = out[shown::spool_position] + p[nuisance::spool_offset];
    out[shown::pressure_a] = out[shown::pressure_a] + p[nuisance::pressure_a_offset];
    out[shown::pressure_b] = out[shown::pressure_b] + p[nuisance::pressure_b_offset];
    out[shown::pilot_pressure_1] = out[shown::pilot_pressure_1] + p[nuisance::pilot_pressure_1_offset];
    out[shown::pilot_pressure_2] = out[shown::pilot_pressure_2] + p[nuisance::pilot_pressure_2_offset];
    return out;
  }
  // The rod stands elsewhere [m].
  void shift_rod(const T& by) {
    rod_lag.input = rod_lag.input + by;
    rod_lag.output = rod_lag.output + by;
  }

 private:
  template <class States>
  static void flows(const States& y, const Inputs<T>& now, const T* p, const Derived<T>& d,
                    std::array<T, n_simulated>& out) {
    const auto flow = [&](const T& opening, const auto& side, const T& dp) {
      return metering_edge(opening, side, dp, d).flow;
    };
    const auto from = from_supply<Effects>(d, now.supply_pressure);
    const auto to = to_return<Effects>(d, now.return_pressure);
    const T q_pa = flow(y[s_x_spool] - p[row::lap_pa], from, now.supply_pressure - y[s_p_a]);
    const T q_pb = flow(-y[s_x_spool] - p[row::lap_pb], from, now.supply_pressure - y[s_p_b]);
    const T q_at = flow(-y[s_x_spool] - p[row::lap_at], to, y[s_p_a] - now.return_pressure);
    const T q_bt = flow(y[s_x_spool] - p[row::lap_bt], to, y[s_p_b] - now.return_pressure);
    out[shown::flow_a] = q_pa - q_at;
    out[shown::flow_b] = q_pb - q_bt;
    out[shown::control_flow] = T(0.5) * (out[shown::flow_a] - out[shown::flow_b]);
    // In the return line; what passes the filter leaves through the nozzles.
    out[shown::leakage_flow] = q_at + q_bt + filter_flow(now.supply_pressure - y[s_p_filter], y[s_v_spool], d);
  }
};

}  // namespace servodx
