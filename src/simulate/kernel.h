// The run of one pack of candidates over one log. Included only by the translation units that instantiate it.
#pragma once
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/pack.h"
#include "base/sparse_dual.h"
#include "effects/registry.h"
#include "effects/sampled_lag.h"
#include "integrate/rodas3.h"
#include "model/derivative.h"
#include "simulate/scenario.h"

namespace servodx {

template <int N, class T>
struct PlainStates {
  const std::array<T, N>& y;
  template <int K>
  T get() const {
    return y[K];
  }
};
template <int N, class T>
struct DualStates {
  const std::array<T, N>& y;
  template <int K>
  Dual<T, Mask{1} << K> get() const {
    return seed<K>(y[K], T(1.0));
  }
};

// The model as the stepper sees it. Settling: spool, piston and measured pressures are held, and the current is free
// and finds the value that holds the spool; its fixed point is the initial state.
template <class T, class Effects, bool Settling>
struct System {
  static constexpr int n = n_base_states + Effects::n_states;
  static constexpr Mask time_mask = Mask{1} << n;
  using TimeDual = Dual<T, time_mask>;

  const T* p;
  const Derived<T>& d;
  Inputs<T> at, slope;                                    // at the start of the substep, and per second
  T hold_spool, hold_pressure, hold_piston, settle_rate;  // settling only: 1 held, 0 free

  template <class S, class In>
  inline __attribute__((always_inline)) auto evaluate(const S& s, const In& u) const {
    auto f = derivative<Effects, T>(s, u, p, d);
    if constexpr (!Settling) {
      return f;
    } else {
      // di/dt = -rate * (net spool force in terms of current) when the spool is held.
      const auto force = std::get<s_v_spool>(f) * (settle_rate * hold_spool);
      const T free_spool = T(1.0) - hold_spool, free_pressure = T(1.0) - hold_pressure,
              free_piston = T(1.0) - hold_piston;
      auto g = std::make_tuple(std::get<s_current>(f) * free_spool - force, std::get<1>(f), std::get<2>(f),
                               std::get<3>(f), std::get<4>(f), std::get<5>(f), std::get<s_x_spool>(f) * free_spool,
                               std::get<s_v_spool>(f) * free_spool, std::get<s_p_a>(f) * free_pressure,
                               std::get<s_p_b>(f) * free_pressure, std::get<s_x_piston>(f) * free_piston,
                               std::get<s_v_piston>(f) * free_piston);
      return std::tuple_cat(g, rest(f, std::make_integer_sequence<int, Effects::n_states>{}));
    }
  }
  template <class F, int... I>
  static auto rest(const F& f, std::integer_sequence<int, I...>) {
    return std::make_tuple(std::get<n_base_states + I>(f)...);
  }

  __attribute__((flatten)) void value(const std::array<T, n>& y, const T& t, std::array<T, n>& f) const {
    const Inputs<T> u{at.current + slope.current * t, at.supply_pressure + slope.supply_pressure * t,
                      at.return_pressure + slope.return_pressure * t, at.load_force + slope.load_force * t,
                      at.friction};
    const auto g = evaluate(PlainStates<n, T>{y}, u);
    unroll<n>([&](auto i) { f[i] = std::get<i>(g); });
  }

  using DualResult =
      decltype(std::declval<System>().evaluate(std::declval<DualStates<n, T>>(), std::declval<Inputs<TimeDual, T>>()));
  template <class X>
  struct MaskOf {
    static constexpr Mask value = 0;
  };
  template <class U, Mask M>
  struct MaskOf<Dual<U, M>> {
    static constexpr Mask value = M;
  };
  template <int I>
  static constexpr Mask mask_of() {
    return MaskOf<std::tuple_element_t<I, DualResult>>::value;
  }
  static constexpr Pattern<n> make_pattern() {
    Pattern<n> out;
    [&]<int... I>(std::integer_sequence<int, I...>) { ((out.row[I] = mask_of<I>() & ~time_mask), ...); }
    (std::make_integer_sequence<int, n>{});
    return out;
  }
  static constexpr Pattern<n> pattern = make_pattern();

  template <class W>
  __attribute__((flatten)) void value_and_jacobian(const std::array<T, n>& y, const T&, std::array<T, n>& f, W& w,
                                                   std::array<T, n>& f_t) const {
    using Lu = SparseLu<n, pattern>;
    const Inputs<TimeDual, T> u{seed<n>(at.current, slope.current), seed<n>(at.supply_pressure, slope.supply_pressure),
                                seed<n>(at.return_pressure, slope.return_pressure),
                                seed<n>(at.load_force, slope.load_force), at.friction};
    const auto g = evaluate(DualStates<n, T>{y}, u);
    unroll<n>([&](auto i) {
      constexpr Mask m = mask_of<i>();
      const auto& gi = std::get<i>(g);
      f[i] = gi.v;
      if constexpr (holds(m, n))
        f_t[i] = gi.d[slot(m, n)];
      else
        f_t[i] = T(0.0);
      unroll<n>([&](auto j) {
        if constexpr (Lu::plan.slot[i][j] >= 0) {
          if constexpr (holds(m, j))
            w[Lu::plan.slot[i][j]] = gi.d[slot(m, j)];
          else
            w[Lu::plan.slot[i][j]] = T(0.0);
        }
      });
    });
  }
};

// Current that the torque motor feels at each sample: null added, then the effects' memories in the order of the list.
template <class T, class Effects>
struct Drive;
template <class T, class... E>
struct Drive<T, EffectList<E...>> {
  template <class X>
  static auto memory_of(X) {
    if constexpr (requires { typename X::template Memory<T>; })
      return typename X::template Memory<T>{};
    else
      return Nothing{};
  }
  std::tuple<decltype(memory_of(E{}))...> memory;
  void rest([[maybe_unused]] const T& current, [[maybe_unused]] const T& spring, [[maybe_unused]] const T* p,
            [[maybe_unused]] const T& rated) {
    (
        [&] {
          if constexpr (requires { typename E::template Memory<T>; })
            E::rest(std::get<index_of<E>()>(memory), current, spring,
                    p + n_parameters + EffectList<E...>::template parameter_offset<E>(), rated);
        }(),
        ...);
  }
  template <class X>
  static constexpr int index_of() {
    int at = 0, found = -1;
    ((found = std::is_same_v<E, X> ? at : found, ++at), ...);
    return found;
  }
  T operator()([[maybe_unused]] double time, T current, [[maybe_unused]] const T& spring, [[maybe_unused]] const T* p,
               [[maybe_unused]] const T& rated) {
    (
        [&] {
          if constexpr (requires { typename E::template Memory<T>; })
            current = E::drive(std::get<index_of<E>()>(memory), time, current, spring,
                               p + n_parameters + EffectList<E...>::template parameter_offset<E>(), rated);
        }(),
        ...);
    return current;
  }
};

// What the sensors show: the effects that act on them, in the order of the list.
template <class T, class Effects>
struct Sensed;
template <class T, class... E>
struct Sensed<T, EffectList<E...>> {
  template <class X>
  static auto memory_of(X) {
    if constexpr (requires { typename X::template Sensors<T>; })
      return typename X::template Sensors<T>{};
    else
      return Nothing{};
  }
  std::tuple<decltype(memory_of(E{}))...> memory;
  static T behind([[maybe_unused]] int signal, T x, [[maybe_unused]] const T* p) {
    (
        [&] {
          if constexpr (requires { E::behind(signal, x, p); })
            x = E::behind(signal, x, p + n_parameters + EffectList<E...>::template parameter_offset<E>());
        }(),
        ...);
    return x;
  }
  void operator()([[maybe_unused]] double time, [[maybe_unused]] T* shown, [[maybe_unused]] const T* p) {
    (
        [&] {
          if constexpr (requires { typename E::template Sensors<T>; })
            E::observe(std::get<Drive<T, EffectList<E...>>::template index_of<E>()>(memory), time, shown,
                       p + n_parameters + EffectList<E...>::template parameter_offset<E>());
        }(),
        ...);
  }
};

// Ports joined by a tube: wide enough to drop 0.02 bar at 10 l/min. [m3/s/Pa]
inline constexpr double tube_conductance = 1e-7;
inline constexpr double drop_rounding = 1e-6;  // [m] of spool travel, where the drop passes to the other two edges

// Sees each step of a run before it is taken; here, nobody does.
struct Unwatched {
  void interval() {}  // the steps from one sample to the next begin, or begin again
  template <class... A>
  void step(const A&...) {}
  template <class... A>
  void dragged(const A&...) {}  // friction's anchors, before and after
  void sample() {}              // the next sample is reached
};

// Runs `lanes` candidates (at most the width of T) over the log and writes their trajectories.
template <class T, class Effects, class Watch>
void run_watched(const Scenario& in, const ParameterVector* const* candidates, Trajectory* const* results, int lanes,
                 const SimulateOptions& options, Watch&& watch) {
  constexpr int n = System<T, Effects, false>::n;
  constexpr int width = Lanes<T>::count;
  const std::size_t samples = in.time.size();

  std::array<T, n_candidate> p;
  for (int k = 0; k < n_candidate; ++k)
    for (int lane = 0; lane < width; ++lane) Lanes<T>::set(p[k], lane, (*candidates[lane < lanes ? lane : 0])[k]);
  if (in.command_slope) p[nuisance::command_slope] = T(*in.command_slope);
  if (in.current_measured) p[row::driver_bandwidth] = T(2e4);  // the amplifier is behind us
  if (!in.supply_pressure.empty()) p[effect_row<SupplyDroop>(0)] = T(0.0);  // what is measured holds the droop
  // On a test stand the piston is held and displaces nothing, and a tube takes the place of the seal's leakage.
  const bool on_stand = in.ports != Ports::actuator;
  if (on_stand) p[row::piston_area_a] = p[row::piston_area_b] = T(0.0);
  Derived<T> d = derive<T, Effects>(p.data(), in.oil);
  if (on_stand) d.leak = T(in.ports == Ports::free ? tube_conductance : 0.0);
  // A port that empties within a step overshoots return; free air would expand there and hold it below.
  if (on_stand) d.air = T(0.0);
  bool sticks = false;
  for (int lane = 0; lane < width; ++lane) sticks |= Lanes<T>::get(p[row::piston_stribeck_friction], lane) != 0.0;
  const T rated = T(in.rated_current), null = p[row::servovalve_null] * rated;

  const auto input = [&](const std::vector<double>& series, std::size_t k, const T& table) {
    return series.empty() ? table : T(series[k]);
  };
  const auto inputs_at = [&](std::size_t k, const T& current) {
    return Inputs<T>{saturate(current, p[row::current_limit], constants::current_rounding),
                     input(in.supply_pressure, k, p[row::supply_pressure]),
                     input(in.return_pressure, k, p[row::return_pressure]),
                     input(in.load_force, k, T(0.0)),
                     T(0.0),
                     T(0.0)};
  };

  // Far beyond its stops, or at pressures that oil does not know, a lane has diverged: not below 1.
  const T per_travel = T(0.1) / p[row::spool_stop];
  const auto excess = [&](const std::array<T, n>& state) {
    const T per_pressure = T(1e-9), x = state[s_x_spool] * per_travel, rod = state[s_x_piston] * T(1e-3),
            p_1 = state[s_p_pilot_1] * per_pressure, p_2 = state[s_p_pilot_2] * per_pressure,
            p_a = state[s_p_a] * per_pressure, p_b = state[s_p_b] * per_pressure;
    return (x * x + rod * rod) + (p_1 * p_1 + p_2 * p_2) + (p_a * p_a + p_b * p_b);
  };
  const auto is_sane = [](const T& beyond, int lane) { return Lanes<T>::get(beyond, lane) < 1.0; };
  // Lanes that are `due` (not below 0) take what `again` makes of them; the others keep what they have, so a lane's
  // bits do not depend on its company.
  std::array<T, n> y{};
  FrictionMemory<T> friction;
  const auto is_due = [](const T& due, int lane) { return !(Lanes<T>::get(due, lane) < 0.0); };
  const auto redo = [&](const std::array<T, n>& y_before, const FrictionMemory<T>& friction_before, const T& due,
                        auto&& again) {
    const auto y_first = std::exchange(y, y_before);
    const auto friction_first = std::exchange(friction, friction_before);
    again();
    for (int lane = 0; lane < width; ++lane) {
      if (is_due(due, lane)) continue;
      for (int j = 0; j < n; ++j) take_lane(y[j], y_first[j], lane);
      friction.take_lane(friction_first, lane);
    }
  };
  const auto any_due = [&](const T& due) {
    for (int lane = 0; lane < lanes; ++lane)
      if (results[lane]->ok && is_due(due, lane)) return true;
    return false;
  };
  const auto lost = [&] { return excess(y) - T(1.0); };
  // Whose rod would be in a stop after `dt` at its speed, and further in than now by more than the face is rough.
  const auto impacts = [&](double dt) {
    const T rough = T(constants::piston_stop_rounding), deep = d.half_stroke + rough;
    const T here = y[s_x_piston], there = here + y[s_v_piston] * T(dt);
    using std::min;
    return min(there * there - deep * deep, there * there - here * here - T(2.0) * d.half_stroke * rough);
  };
  for (int lane = 0; lane < lanes; ++lane) results[lane]->ok = true;

  // Initial state.
  Inputs<T> u = inputs_at(0, T(in.command[0]) + null);
  const T half = T(0.5) * (u.supply_pressure + u.return_pressure);
  y[s_p_filter] = u.supply_pressure;
  y[s_p_pilot_1] = y[s_p_pilot_2] = half;
  // Where measured: what stands behind the first sample, less the sensor's offset, and its noise put right.
  const auto start = [&](int signal, const std::optional<double>& measured, int offset, int error, const T& otherwise) {
    return measured ? Sensed<T, Effects>::behind(signal, T(*measured) - p[offset], p.data()) + p[error] : otherwise;
  };
  y[s_x_spool] = start(0, in.spool_start, nuisance::spool_offset, nuisance::spool_start, T(0.0));
  y[s_p_a] = start(2, in.pressure_a_start, nuisance::pressure_a_offset, nuisance::pressure_a_start, half);
  y[s_p_b] = start(3, in.pressure_b_start, nuisance::pressure_b_offset, nuisance::pressure_b_start, half);
  y[s_x_piston] = T(in.piston_start.value_or(0.0)) / p[row::position_sensor_gain];
  y[s_v_piston] = T(in.piston_velocity_start) + p[nuisance::piston_velocity_start];
  y[s_current] = u.current;
  {
    System<T, Effects, true> settling{p.data(),
                                      d,
                                      u,
                                      Inputs<T>{T(0.0), T(0.0), T(0.0), T(0.0)},
                                      T(in.spool_start ? 1.0 : 0.0),
                                      T(in.pressure_a_start && in.pressure_b_start ? 1.0 : 0.0),
                                      T(1.0),
                                      T(0.0)};
    // A spool out of balance by the force that one amp makes settles at this rate; the pilot's own poles are faster.
    constexpr double rate = 400.0;  // [1/s]
    const T force_per_amp =
        p[row::torque_motor_gain] * d.inverse_flapper_stiffness * d.spool_area * half / p[row::nozzle_gap];
    settling.settle_rate = T(rate) / (d.inverse_spool_mass * force_per_amp);
    const auto settle = [&](int finer) {
      for (int k = 0; k < 60 * finer; ++k) {
        settling.at.friction.rest(y[s_x_spool], y[s_x_piston]);
        effects_at_rest(y.data(), p.data(), Effects{});
        rodas3_step<T>(settling, y, (k < 20 * finer ? 2e-4 : 1e-3) / finer);
      }
    };
    const auto unsettled = y;
    settle(1);
    if (const T due = lost(); any_due(due)) redo(unsettled, friction, due, [&] { settle(16); });
    // The lines of a stand fill through the edges' leakage: some seconds.
    if (on_stand)
      for (int k = 0; k < 500; ++k) {
        settling.at.friction.rest(y[s_x_spool], y[s_x_piston]);
        effects_at_rest(y.data(), p.data(), Effects{});
        rodas3_step<T>(settling, y, 1e-2);
      }
  }
  effects_at_rest(y.data(), p.data(), Effects{});
  Drive<T, Effects> drive;
  const T spring_rate = p[row::flapper_stiffness] / p[row::torque_motor_gain];  // [A/m]
  const auto spring = [&] { return flapper_travel(y[s_x_flapper], p.data()) * spring_rate; };
  drive.rest(y[s_current], spring(), p.data(), rated);  // the history that ends at the current which holds the spool
  T current = drive(in.time[0], T(in.command[0]) + null, spring(), p.data(), rated);
  Sensed<T, Effects> sensed;
  SampledLag<T> position_lag;

  for (int lane = 0; lane < lanes; ++lane)
    for (int c = 0; c < n_simulated; ++c) {
      results[lane]->signals[c].clear();
      if (options.wanted[c]) results[lane]->signals[c].resize(samples);
    }
  const auto report = [&](std::size_t k, const Inputs<T>& now) {
    std::array<T, n_simulated> out{};
    out[0] = y[s_x_spool];
    out[1] = p[row::position_sensor_gain] *
             position_lag(in.time[k], y[s_x_piston], p[row::position_sensor_lag], y[s_v_piston]);
    out[2] = y[s_p_a];
    out[3] = y[s_p_b];
    out[4] = y[s_p_pilot_1];
    out[5] = y[s_p_pilot_2];
    if (options.wanted[6] || options.wanted[7] || options.wanted[10] || options.wanted[11]) {
      const auto flow = [&](const T& opening, const T& radius, const T& dp) {
        return std::get<0>(metering_edge(opening, radius, dp, d));
      };
      const T q_pa = flow(y[s_x_spool] - p[row::lap_pa], d.supply_edge, now.supply_pressure - y[s_p_a]);
      const T q_pb = flow(-y[s_x_spool] - p[row::lap_pb], d.supply_edge, now.supply_pressure - y[s_p_b]);
      const T q_at = flow(-y[s_x_spool] - p[row::lap_at], d.return_edge, y[s_p_a] - now.return_pressure);
      const T q_bt = flow(y[s_x_spool] - p[row::lap_bt], d.return_edge, y[s_p_b] - now.return_pressure);
      out[6] = q_pa - q_at;
      out[7] = q_pb - q_bt;
      out[10] = T(0.5) * (out[6] - out[7]);
      // In the return line; what passes the filter leaves through the nozzles.
      out[11] = q_at + q_bt + filter_flow(now.supply_pressure - y[s_p_filter], y[s_v_spool], d);
    }
    out[8] = y[s_p_a] - y[s_p_b];
    out[9] = now.supply_pressure - now.return_pressure - out[8] * smooth_sign(y[s_x_spool], T(drop_rounding));
    sensed(in.time[k], out.data(), p.data());
    out[0] = out[0] + p[nuisance::spool_offset];
    out[2] = out[2] + p[nuisance::pressure_a_offset];
    out[3] = out[3] + p[nuisance::pressure_b_offset];
    out[4] = out[4] + p[nuisance::pilot_pressure_1_offset];
    out[5] = out[5] + p[nuisance::pilot_pressure_2_offset];
    bool any = false;
    const T here = excess(y);
    for (int lane = 0; lane < lanes; ++lane) {
      if (!results[lane]->ok) continue;
      if (!is_sane(here, lane)) {
        results[lane]->ok = false;
        results[lane]->failed_at = in.time[k];
        continue;
      }
      any = true;
      for (int c = 0; c < n_simulated; ++c)
        if (options.wanted[c]) results[lane]->signals[c][k] = Lanes<T>::get(out[c], lane);
    }
    return any;
  };

  Inputs<T> now = inputs_at(0, current);
  System<T, Effects, false> live{p.data(), d, now, now, T(0.0), T(0.0), T(0.0), T(0.0)};
  System<T, Effects, true> stand{p.data(), d, now, now, T(0.0), T(0.0), T(1.0), T(0.0)};  // the piston alone is held
  if (!report(0, now)) return;
  const auto steps_of = [](double dt, double largest) {
    return std::max(1, static_cast<int>(std::ceil(dt / largest - 1e-6)));
  };
  // A linearly implicit step does not see a stop that it has not reached. After a jump the flapper crosses its gap in a
  // tenth of a millisecond, so the steps are short until the spool has answered. This schedule comes from the log alone:
  // every candidate takes the same steps. A rod that comes upon its stop is seen a sample before: that candidate takes
  // the sample in short steps too, or is thrown back at many times its speed, or not, by the last digit of its values.
  constexpr double jump = 0.03;         // of rated current
  constexpr double impact_time = 4e-3;  // [s]
  double impact_until = in.time[0] - 1.0;
  friction.rest(y[s_x_spool], y[s_x_piston]);
  // Slower than full stroke in a second, the valve's own dynamics stay settled, and an L-stable step passes over them.
  constexpr double creep = 1.0;         // [1/s] rated current per time
  constexpr double settle_time = 0.05;  // [s]
  double lively_until = in.time[0];
  for (std::size_t k = 0; k + 1 < samples; ++k) {
    const double dt = in.time[k + 1] - in.time[k];
    if (std::abs(in.command[k + 1] - in.command[k]) > jump * in.rated_current)
      impact_until = in.time[k + 1] + impact_time;
    if (std::abs(in.command[k + 1] - in.command[k]) > creep * in.rated_current * dt)
      lively_until = in.time[k + 1] + settle_time;
    const double usual = on_stand && in.time[k] >= lively_until ? options.creep_step : options.step;
    const double largest = in.time[k] < impact_until ? std::min(options.step, options.impact_step) : usual;
    const int substeps = steps_of(dt, largest);
    const T next_current = drive(in.time[k + 1], T(in.command[k + 1]) + null, spring(), p.data(), rated);
    const Inputs<T> next = inputs_at(k + 1, next_current);
    const T per = T(1.0 / dt);
    live.slope = {p[nuisance::command_slope] * (next.current - now.current) * per,
                  (next.supply_pressure - now.supply_pressure) * per,
                  (next.return_pressure - now.return_pressure) * per, (next.load_force - now.load_force) * per};
    const auto advance = [&](int steps) {
      const double h = dt / steps;
      watch.interval();
      for (int j = 0; j < steps; ++j) {
        const T t = T(h * j);
        live.at = {now.current + live.slope.current * t, now.supply_pressure + live.slope.supply_pressure * t,
                   now.return_pressure + live.slope.return_pressure * t, now.load_force + live.slope.load_force * t,
                   friction};
        const T spool_from = y[s_x_spool], rod_from = y[s_x_piston];
        if (on_stand) {
          stand.at = live.at;
          stand.slope = live.slope;
          rodas3_step<T>(stand, y, h);
        } else {
          watch.step(live, y, h);
          rodas3_step<T>(live, y, h);
        }
        friction.move(spool_from, y[s_x_spool], rod_from, y[s_x_piston], h, d.breakaway, sticks);
        watch.dragged(live.at.friction, friction);
      }
    };
    const auto y_before = y;
    const auto friction_before = friction;
    const T hit = impacts(dt);
    advance(substeps);
    if (const int finer = steps_of(dt, options.impact_step); !on_stand && finer > substeps && any_due(hit))
      redo(y_before, friction_before, hit, [&] { advance(finer); });
    for (int finer = substeps * 8; finer <= substeps * 64; finer *= 8) {
      const T due = lost();
      if (!any_due(due)) break;
      redo(y_before, friction_before, due, [&] { advance(finer); });
    }
    watch.sample();
    now = next;
    if (!report(k + 1, now)) return;
  }
}

template <class T, class Effects>
void run_pack(const Scenario& in, const ParameterVector* const* candidates, Trajectory* const* results, int lanes,
              const SimulateOptions& options) {
  run_watched<T, Effects>(in, candidates, results, lanes, options, Unwatched{});
}

using RunPack = void (*)(const Scenario&, const ParameterVector* const*, Trajectory* const*, int,
                         const SimulateOptions&);

struct Kernels {
  int width;
  const char* name;
  RunPack base, extended;  // without effects, with all that have names
  RunPack corrected;       // with a learnt curve too; plain doubles only: it is rare, and an instance is slow to build
};
Kernels kernels_scalar();
Kernels kernels_generic();
Kernels kernels_avx2();
Kernels kernels_avx512();
// Twice as many lanes, of floats: for ranking only.
Kernels kernels_avx2_floats();
Kernels kernels_avx512_floats();

}  // namespace servodx
