// Where a run starts: the state at the log's first sample. What was measured is held there, and the model's own
// equations are stepped until all else has found its place; the current is free and finds the value that holds the
// spool.
//
// Limits: the valve was at rest before the log; the piston's speed is the log's and is held like its place. Without a
// measured spool or pressure the states settle where the first command puts them.
// Source: the fixed point of the equations in docs/model.md; lengths and numbers of the steps were chosen by hand.
#pragma once
#include <array>
#include <optional>

#include "effects/registry.h"
#include "integrate/rodas3.h"
#include "model/derived.h"
#include "model/hooks.h"
#include "model/shown.h"
#include "model/state.h"
#include "parameters/list.h"
#include "simulate/effect_memories.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"
#include "simulate/system.h"

namespace servodx {

// Where measured: what stands behind the first sample, less the sensor's offset, and its noise put right. The pilot
// halfway, and the rest at nought. u: inputs before the log.
template <class T, class Effects>
auto measured_state(const Scenario& in, const T* p, const Inputs<T>& u) {
  std::array<T, System<T, Effects, true>::n> y{};
  const T half = T(0.5) * (u.supply_pressure + u.return_pressure);
  y[s_p_filter] = u.supply_pressure;
  y[s_p_pilot_1] = y[s_p_pilot_2] = half;
  const auto start = [&](int signal, const std::optional<double>& measured, int offset, int error, const T& otherwise) {
    return measured ? Sensed<T, Effects>::behind(signal, T(*measured) - p[offset], p) + p[error] : otherwise;
  };
  y[s_x_spool] = start(shown::spool_position, in.spool_start, nuisance::spool_offset, nuisance::spool_start, T(0.0));
  y[s_p_a] =
      start(shown::pressure_a, in.pressure_a_start, nuisance::pressure_a_offset, nuisance::pressure_a_start, half);
  y[s_p_b] =
      start(shown::pressure_b, in.pressure_b_start, nuisance::pressure_b_offset, nuisance::pressure_b_start, half);
  y[s_x_piston] = T(in.piston_start.value_or(0.0)) / p[row::position_sensor_gain];
  y[s_v_piston] = T(in.piston_velocity_start) + p[nuisance::piston_velocity_start];
  // The wire's balance: from the first command, far off where it has jumped, a first stage may swing for good.
  y[s_current] =
      in.spool_start ? p[row::feedback_wire_stiffness] * y[s_x_spool] / p[row::torque_motor_gain] : u.current;
  return y;
}

template <class T, class Effects>
class Settling {
 public:
  using States = std::array<T, System<T, Effects, true>::n>;

  Settling(const Scenario& in, const T* p, const Derived<T>& d, const Inputs<T>& u)
      : p_(p),
        system_{p,
                d,
                u,
                Inputs<T>{T(0.0), T(0.0), T(0.0), T(0.0)},
                T(in.spool_start ? 1.0 : 0.0),
                T(in.pressure_a_start && in.pressure_b_start ? 1.0 : 0.0),
                T(1.0),
                T(0.0)} {
    // A spool out of balance by the force that one amp makes settles at this rate; the pilot's own poles are faster.
    constexpr double rate = 400.0;  // [1/s]
    const T half = T(0.5) * (u.supply_pressure + u.return_pressure);
    const T force_per_amp =
        p[row::torque_motor_gain] * d.inverse_flapper_stiffness * d.spool_area * half / p[row::nozzle_gap];
    system_.settle_rate = T(rate) / (d.inverse_spool_mass * force_per_amp);
  }

  // Forty-four milliseconds, in steps that are `finer` times as short as usual.
  void settle(States& y, int finer) {
    steps(y, 60 * finer, [&](int k) { return (k < 20 * finer ? 2e-4 : 1e-3) / finer; });
  }
  // The lines of a test stand fill through the edges' leakage: some seconds.
  void fill_lines(States& y) {
    steps(y, 500, [](int) { return 1e-2; });
  }

 private:
  template <class Length>
  void steps(States& y, int count, Length&& length) {
    for (int k = 0; k < count; ++k) {
      system_.at.friction.rest(y[s_x_spool], y[s_x_piston]);
      effects_at_rest(y.data(), p_, Effects{});
      rodas3_step<T>(system_, y, length(k));
    }
  }

  const T* p_;
  System<T, Effects, true> system_;
};

}  // namespace servodx
