// The run of one pack of candidates over one log. Included only by the translation units that instantiate it.
#pragma once
#include <array>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

#include "base/pack.h"
#include "base/smooth.h"
#include "base/sparse_dual.h"
#include "effects/registry.h"
#include "effects/return_drop.h"
#include "effects/sampled_lag.h"
#include "effects/supply_droop.h"
#include "integrate/rodas3.h"
#include "integrate/sparse_lu.h"
#include "model/asperities.h"
#include "model/constants.h"
#include "model/derivative.h"
#include "model/derived.h"
#include "model/hooks.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/rig.h"
#include "simulate/fast_command.h"
#include "simulate/run_in_parts.h"
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
  Dual<T, only(K)> get() const {
    return seed<K>(y[K], T(1.0));
  }
};

// The model as the stepper sees it. Settling: spool, piston and measured pressures are held, and the current is free
// and finds the value that holds the spool; its fixed point is the initial state.
template <class T, class Effects, bool Settling>
struct System {
  static constexpr int n = n_base_states + Effects::n_states;
  static constexpr Mask time_mask = only(n);
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
    static constexpr Mask value{};
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
  static constexpr bool acts = (requires { typename E::template Memory<T>; } || ... || false);
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
  void take_lane([[maybe_unused]] const Drive& from, [[maybe_unused]] int lane) {
    (
        [&] {
          if constexpr (requires { typename E::template Memory<T>; })
            std::get<index_of<E>()>(memory).take_lane(std::get<index_of<E>()>(from.memory), lane);
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

// Sees the steps of a run; here, nobody does.
struct Unwatched {
  void interval() {}  // the steps from one sample to the next begin, or begin again
  template <class... A>
  void step(const A&...) {}  // one is about to be taken: the system, the state, its length, what rodas3_step tells
  template <class... A>
  void taken(const A&...) {}  // the state after it, friction's memory before and after
};

// Up to as many candidates as T has lanes on their way over a log; writes their trajectories. Idle lanes repeat the
// first candidate.
template <class T, class Effects>
class Run {
 public:
  using Live = System<T, Effects, false>;
  static constexpr int n = Live::n;
  static constexpr int width = Lanes<T>::count;

  // Ready at the first sample, which is reported.
  Run(const Scenario& in, const ParameterVector* const* candidates, Trajectory* const* results, int lanes,
      const SimulateOptions& options)
      : live{p_.data(), d_, {}, {}, T(0.0), T(0.0), T(0.0), T(0.0)},
        in_(in),
        options_(options),
        results_(results),
        lanes_(lanes),
        on_stand_(in.ports != Ports::actuator) {
    fill_rows(candidates);
    d_ = derive<T, Effects>(p_.data(), in.oil);
    if (on_stand_) {
      d_.leak = T(in.ports == Ports::free ? tube_conductance : 0.0);
      // A port that empties within a step overshoots return; free air would expand there and hold it below.
      d_.air = T(0.0);
    }
    for (int lane = 0; lane < width; ++lane) sticks |= Lanes<T>::get(p_[row::piston_stribeck_friction], lane) != 0.0;
    rated_ = T(in.rated_current);
    null_ = p_[row::servovalve_null] * rated_;
    for (int lane = 0; lane < lanes; ++lane) results[lane]->ok = true;
    settle();
    // The history that ends at the current which holds the spool.
    drive_.rest(y[s_current], spring(), p_.data(), rated_);
    now_ = inputs_at(0, drive_(in.time[0], T(first_command()) + null_, spring(), p_.data(), rated_));
    for (int lane = 0; lane < lanes; ++lane)
      for (int c = 0; c < n_simulated; ++c) {
        results[lane]->signals[c].clear();
        if (options.wanted[c]) results[lane]->signals[c].resize(in.time.size());
      }
    friction.rest(y[s_x_spool], y[s_x_piston]);
    lively_until_ = in.time[0];
    impact_until_ = in.time[0] - 1.0;
    any_left_ = report(now_);
  }
  Run(const Run&) = delete;

  bool under_way() const { return any_left_ && k_ + 1 < in_.time.size(); }

  // To the next sample, by the steps that the log, and stops that are near, ask for.
  template <class Watch>
  void next(Watch&& watch) {
    const double dt = begin();
    const int substeps = schedule(dt);
    const auto y_before = y;
    const auto friction_before = friction;
    const T struck = impacts(dt), seated = on_nozzle();
    advance(dt, substeps, watch);
    using std::max;
    const T due = max(struck, max(seated, on_nozzle()));
    if (const int finer = steps_of(dt, options_.impact_step); !on_stand_ && finer > substeps && any_due(due))
      redo(y_before, friction_before, due, [&] { advance(dt, finer, watch); });
    for (int finer = substeps * 8; finer <= substeps * 64; finer *= 8) {
      const T astray = lost();
      if (!any_due(astray)) break;
      const auto drive_first = drive_;
      redo(y_before, friction_before, astray, [&] {
        if (in_.fast) drive_ = drive_before_, felt_ = 0;  // what a lost flapper did to the iron
        advance(dt, finer, watch);
      });
      for (int lane = 0; in_.fast && lane < width; ++lane)
        if (!is_due(astray, lane)) drive_.take_lane(drive_first, lane);
    }
    end();
  }

  // The same in parts, for a run whose steps another takes in between: its inputs move on, up to the next sample; they
  // stand at a time after the last one; friction remembers a step; the sample is reported.
  double begin() {
    const double dt = in_.time[k_ + 1] - in_.time[k_];
    const T commanded = T(in_.command[k_ + 1]) + null_;
    if (in_.fast) drive_before_ = drive_;
    felt_ = 0, felt_per_second_ = std::min(steps_of(dt, options_.step), felt_parts) / dt;
    next_ = inputs_at(k_ + 1, in_.fast ? commanded : drive_(in_.time[k_ + 1], commanded, spring(), p_.data(), rated_));
    const T per = T(1.0 / dt);
    live.slope = {p_[nuisance::command_slope] * (next_.current - now_.current) * per,
                  (next_.supply_pressure - now_.supply_pressure) * per,
                  (next_.return_pressure - now_.return_pressure) * per, (next_.load_force - now_.load_force) * per};
    return dt;
  }
  T current(double after) const { return now_.current + live.slope.current * T(after); }
  // Of a fast log the line over the step from `after` on that is `h` long; of any other there is one to the sample.
  void take_command(double after, double h) {
    if (!in_.fast) return;
    const double t = in_.time[k_] + after;
    const CommandLines lines = in_.fast.over(k_, t, t + h);
    T off = null_;
    if constexpr (Drive<T, Effects>::acts) {
      const int part = std::min(static_cast<int>((after + 0.5 * h) * felt_per_second_), felt_parts - 1);
      feel(part);
      off = off + felt_off_[static_cast<std::size_t>(part)];
    }
    const auto at = [&](double held, double joined) {
      return saturate(T(held) + p_[nuisance::command_slope] * T(joined - held) + off, p_[row::current_limit],
                      constants::current_rounding);
    };
    const T from = at(lines.held.from, lines.joined.from), to = at(lines.held.to, lines.joined.to);
    live.slope.current = (to - from) * T(1.0 / h);
    now_.current = from - live.slope.current * T(after);
  }
  void stand_at(double after) {
    const T t = T(after);
    live.at = {now_.current + live.slope.current * t, now_.supply_pressure + live.slope.supply_pressure * t,
               now_.return_pressure + live.slope.return_pressure * t, now_.load_force + live.slope.load_force * t,
               friction};
  }
  void remember(const T& spool_from, const T& rod_from, double h) {
    friction.move(spool_from, y[s_x_spool], rod_from, y[s_x_piston], h, d_.spool_presliding, d_.breakaway, sticks);
  }
  void end() {
    now_ = next_;
    ++k_;
    any_left_ = report(now_);
  }

  // Of a log that comes in parts: the sample reached stands first in what the scenario now holds.
  void go_on() { k_ = 0; }
  // What the run remembers of its way: another of the same candidate that takes it over goes on from here.
  auto memory() {
    return std::tie(y, friction, drive_.memory, sensed_.memory, position_lag_, now_, lively_until_, impact_until_);
  }
  // The rod stands elsewhere [m]; all else goes on as it was.
  void shift_rod(const T& by) {
    y[s_x_piston] = y[s_x_piston] + by;
    for (T& anchor : friction.seal_anchor) anchor = anchor + by;
    position_lag_.input = position_lag_.input + by;
    position_lag_.output = position_lag_.output + by;
  }

  const T* p() const { return p_.data(); }
  const Derived<T>& derived() const { return d_; }
  const Inputs<T>& inputs() const { return now_; }  // at the last sample

  std::array<T, n> y{};
  FrictionMemory<T> friction;
  Live live;
  bool sticks = false;  // whether breakaway friction is followed; where there is none, the bits are the same

 private:
  // A linearly implicit step does not see a stop that it has not reached. After a jump the flapper crosses its gap in a
  // tenth of a millisecond, so the steps are short until the spool has answered. This schedule comes from the log
  // alone: every candidate takes the same steps. A rod that comes upon its stop is seen a sample before: that candidate
  // takes the sample in short steps too, or is thrown back at many times its speed, or not, by the last digit of its
  // values. So does one whose flapper lies on a nozzle.
  static constexpr double jump = 0.03;         // of rated current
  static constexpr double impact_time = 4e-3;  // [s]
  // Slower than full stroke in a second, the valve's own dynamics stay settled, and an L-stable step passes over them.
  static constexpr double creep = 1.0;         // [1/s] rated current per time
  static constexpr double settle_time = 0.05;  // [s]

  static int steps_of(double dt, double largest) {
    return std::max(1, static_cast<int>(std::ceil(dt / largest - 1e-6)));
  }
  int schedule(double dt) {
    const double moved = std::abs(in_.command[k_ + 1] - in_.command[k_]);
    const double jumped = in_.fast ? in_.fast.move[k_] : moved;
    if (jumped > jump * in_.rated_current) impact_until_ = in_.time[k_ + 1] + impact_time;
    if (std::max(moved, jumped) > creep * in_.rated_current * dt) lively_until_ = in_.time[k_ + 1] + settle_time;
    const double usual = on_stand_ && in_.time[k_] >= lively_until_ ? options_.creep_step : options_.step;
    return steps_of(dt, in_.time[k_] < impact_until_ ? std::min(options_.step, options_.impact_step) : usual);
  }

  template <class Watch>
  void advance(double dt, int steps, Watch& watch) {
    const double h = dt / steps;
    watch.interval();
    for (int j = 0; j < steps; ++j) {
      take_command(h * j, h);
      stand_at(h * j);
      const T spool_from = y[s_x_spool], rod_from = y[s_x_piston];
      if (on_stand_) {
        System<T, Effects, true> stand{p_.data(), d_, live.at, live.slope, T(0.0), T(0.0), T(1.0), T(0.0)};
        rodas3_step<T>(stand, y, h);  // the piston alone is held
      } else {
        rodas3_step<T>(live, y, h, [&](const auto&... stages) { watch.step(live, y, h, stages...); });
      }
      remember(spool_from, rod_from, h);
      watch.taken(y, live.at.friction, friction);
    }
  }

  void fill_rows(const ParameterVector* const* candidates) {
    for (int k = 0; k < n_candidate; ++k)
      for (int lane = 0; lane < width; ++lane) Lanes<T>::set(p_[k], lane, (*candidates[lane < lanes_ ? lane : 0])[k]);
    if (in_.command_slope) p_[nuisance::command_slope] = T(*in_.command_slope);
    if (in_.current_measured) p_[row::driver_bandwidth] = T(2e4);               // the amplifier is behind us
    if (!in_.supply_pressure.empty()) p_[effect_row<SupplyDroop>(0)] = T(0.0);  // what is measured holds the droop
    if (!in_.return_pressure.empty()) p_[effect_row<ReturnDrop>(0)] = T(0.0);
    // On a test stand the piston is held and displaces nothing, and a tube takes the place of the seal's leakage.
    if (on_stand_) p_[row::piston_area_a] = p_[row::piston_area_b] = T(0.0);
  }

  // [A] that stood before the log began.
  double first_command() const { return in_.fast ? in_.fast.samples->value[in_.fast.at[0]] : in_.command[0]; }
  // What the effects of the drive make of the command of a fast log, as what the motor feels beyond it: of the mean
  // over each usual step, at its middle, once the run is there. Finer steps over the same stretch find it as it was, so
  // a lane does not depend on another's.
  void feel(int part) {
    for (; felt_ <= part; ++felt_) {
      const double h = 1.0 / felt_per_second_, t = in_.time[k_] + h * felt_;
      const CommandLines lines = in_.fast.over(k_, t, t + h);
      const double held = 0.5 * (lines.held.from + lines.held.to), joined = 0.5 * (lines.joined.from + lines.joined.to);
      const T mean = T(held) + p_[nuisance::command_slope] * T(joined - held) + null_;
      felt_off_[static_cast<std::size_t>(felt_)] = drive_(t + 0.5 * h, mean, spring(), p_.data(), rated_) - mean;
    }
  }

  T input(const std::vector<double>& series, std::size_t k, const T& table) const {
    return series.empty() ? table : T(series[k]);
  }
  Inputs<T> inputs_at(std::size_t k, const T& current) const {
    return {saturate(current, p_[row::current_limit], constants::current_rounding),
            input(in_.supply_pressure, k, p_[row::supply_pressure]),
            input(in_.return_pressure, k, p_[row::return_pressure]),
            input(in_.load_force, k, T(0.0)),
            T(0.0),
            T(0.0)};
  }
  T spring() const {  // [A]
    return flapper_travel(y[s_x_flapper], p_.data()) * (p_[row::flapper_stiffness] / p_[row::torque_motor_gain]);
  }

  // Far beyond its stops, or at pressures that oil does not know, a lane has diverged: not below 1.
  T excess() const {
    const T per_travel = T(0.1) / p_[row::spool_stop];
    const T per_pressure = T(1e-9), x = y[s_x_spool] * per_travel, rod = y[s_x_piston] * T(1e-3),
            p_1 = y[s_p_pilot_1] * per_pressure, p_2 = y[s_p_pilot_2] * per_pressure, p_a = y[s_p_a] * per_pressure,
            p_b = y[s_p_b] * per_pressure;
    return (x * x + rod * rod) + (p_1 * p_1 + p_2 * p_2) + (p_a * p_a + p_b * p_b);
  }
  T lost() const { return excess() - T(1.0); }
  // Whose rod would be in a stop after `dt` at its speed, and further in than now by more than the face is rough.
  T impacts(double dt) const {
    const T rough = T(constants::piston_stop_rounding), deep = d_.half_stroke + rough;
    const T here = y[s_x_piston], there = here + y[s_v_piston] * T(dt);
    using std::min;
    return min(there * there - deep * deep, there * there - here * here - T(2.0) * d_.half_stroke * rough);
  }
  // Whose flapper lies on a nozzle. The spool slews then, for as long as filter and oil let it, and how the flapper
  // leaves is settled within a tenth of a millisecond: by longer steps the spool arrives anywhere.
  T on_nozzle() const { return y[s_x_flapper] * y[s_x_flapper] - p_[row::nozzle_gap] * p_[row::nozzle_gap]; }
  // Lanes that are `due` (not below 0) take what `again` makes of them; the others keep what they have, so a lane's
  // bits do not depend on its company.
  static bool is_due(const T& due, int lane) { return !(Lanes<T>::get(due, lane) < 0.0); }
  template <class Again>
  void redo(const std::array<T, n>& y_before, const FrictionMemory<T>& friction_before, const T& due, Again&& again) {
    const auto y_first = std::exchange(y, y_before);
    const auto friction_first = std::exchange(friction, friction_before);
    again();
    for (int lane = 0; lane < width; ++lane) {
      if (is_due(due, lane)) continue;
      for (int j = 0; j < n; ++j) take_lane(y[j], y_first[j], lane);
      friction.take_lane(friction_first, lane);
    }
  }
  bool any_due(const T& due) const {
    for (int lane = 0; lane < lanes_; ++lane)
      if (results_[lane]->ok && is_due(due, lane)) return true;
    return false;
  }

  // The initial state.
  void settle() {
    const Inputs<T> u = inputs_at(0, T(first_command()) + null_);
    const T half = T(0.5) * (u.supply_pressure + u.return_pressure);
    y[s_p_filter] = u.supply_pressure;
    y[s_p_pilot_1] = y[s_p_pilot_2] = half;
    // Where measured: what stands behind the first sample, less the sensor's offset, and its noise put right.
    const auto start = [&](int signal, const std::optional<double>& measured, int offset, int error,
                           const T& otherwise) {
      return measured ? Sensed<T, Effects>::behind(signal, T(*measured) - p_[offset], p_.data()) + p_[error]
                      : otherwise;
    };
    y[s_x_spool] = start(0, in_.spool_start, nuisance::spool_offset, nuisance::spool_start, T(0.0));
    y[s_p_a] = start(2, in_.pressure_a_start, nuisance::pressure_a_offset, nuisance::pressure_a_start, half);
    y[s_p_b] = start(3, in_.pressure_b_start, nuisance::pressure_b_offset, nuisance::pressure_b_start, half);
    y[s_x_piston] = T(in_.piston_start.value_or(0.0)) / p_[row::position_sensor_gain];
    y[s_v_piston] = T(in_.piston_velocity_start) + p_[nuisance::piston_velocity_start];
    y[s_current] = u.current;
    System<T, Effects, true> settling{p_.data(),
                                      d_,
                                      u,
                                      Inputs<T>{T(0.0), T(0.0), T(0.0), T(0.0)},
                                      T(in_.spool_start ? 1.0 : 0.0),
                                      T(in_.pressure_a_start && in_.pressure_b_start ? 1.0 : 0.0),
                                      T(1.0),
                                      T(0.0)};
    // A spool out of balance by the force that one amp makes settles at this rate; the pilot's own poles are faster.
    constexpr double rate = 400.0;  // [1/s]
    const T force_per_amp =
        p_[row::torque_motor_gain] * d_.inverse_flapper_stiffness * d_.spool_area * half / p_[row::nozzle_gap];
    settling.settle_rate = T(rate) / (d_.inverse_spool_mass * force_per_amp);
    const auto steps = [&](int count, auto&& length) {
      for (int k = 0; k < count; ++k) {
        settling.at.friction.rest(y[s_x_spool], y[s_x_piston]);
        effects_at_rest(y.data(), p_.data(), Effects{});
        rodas3_step<T>(settling, y, length(k));
      }
    };
    const auto settle_in = [&](int finer) {
      steps(60 * finer, [&](int k) { return (k < 20 * finer ? 2e-4 : 1e-3) / finer; });
    };
    const auto unsettled = y;
    settle_in(1);
    if (const T due = lost(); any_due(due)) redo(unsettled, friction, due, [&] { settle_in(16); });
    // The lines of a stand fill through the edges' leakage: some seconds.
    if (on_stand_) steps(500, [](int) { return 1e-2; });
    effects_at_rest(y.data(), p_.data(), Effects{});
  }

  // Writes the sample; false once no lane is left.
  bool report(const Inputs<T>& now) {
    std::array<T, n_simulated> out{};
    out[0] = y[s_x_spool];
    out[1] = p_[row::position_sensor_gain] *
             position_lag_(in_.time[k_], y[s_x_piston], p_[row::position_sensor_lag], y[s_v_piston]);
    out[2] = y[s_p_a];
    out[3] = y[s_p_b];
    out[4] = y[s_p_pilot_1];
    out[5] = y[s_p_pilot_2];
    if (options_.wanted[6] || options_.wanted[7] || options_.wanted[10] || options_.wanted[11]) {
      const auto flow = [&](const T& opening, const auto& side, const T& dp) {
        return metering_edge(opening, side, dp, d_).flow;
      };
      const auto from = from_supply<Effects>(d_, now.supply_pressure);
      const auto to = to_return<Effects>(d_, now.return_pressure);
      const T q_pa = flow(y[s_x_spool] - p_[row::lap_pa], from, now.supply_pressure - y[s_p_a]);
      const T q_pb = flow(-y[s_x_spool] - p_[row::lap_pb], from, now.supply_pressure - y[s_p_b]);
      const T q_at = flow(-y[s_x_spool] - p_[row::lap_at], to, y[s_p_a] - now.return_pressure);
      const T q_bt = flow(y[s_x_spool] - p_[row::lap_bt], to, y[s_p_b] - now.return_pressure);
      out[6] = q_pa - q_at;
      out[7] = q_pb - q_bt;
      out[10] = T(0.5) * (out[6] - out[7]);
      // In the return line; what passes the filter leaves through the nozzles.
      out[11] = q_at + q_bt + filter_flow(now.supply_pressure - y[s_p_filter], y[s_v_spool], d_);
    }
    out[8] = y[s_p_a] - y[s_p_b];
    out[9] = now.supply_pressure - now.return_pressure - out[8] * smooth_sign(y[s_x_spool], T(drop_rounding));
    sensed_(in_.time[k_], out.data(), p_.data());
    out[0] = out[0] + p_[nuisance::spool_offset];
    out[2] = out[2] + p_[nuisance::pressure_a_offset];
    out[3] = out[3] + p_[nuisance::pressure_b_offset];
    out[4] = out[4] + p_[nuisance::pilot_pressure_1_offset];
    out[5] = out[5] + p_[nuisance::pilot_pressure_2_offset];
    bool any = false;
    const T here = excess();
    for (int lane = 0; lane < lanes_; ++lane) {
      if (!results_[lane]->ok) continue;
      if (!(Lanes<T>::get(here, lane) < 1.0)) {
        results_[lane]->ok = false;
        results_[lane]->failed_at = in_.time[k_];
        continue;
      }
      any = true;
      for (int c = 0; c < n_simulated; ++c)
        if (options_.wanted[c]) results_[lane]->signals[c][k_] = Lanes<T>::get(out[c], lane);
    }
    return any;
  }

  const Scenario& in_;
  const SimulateOptions& options_;
  Trajectory* const* results_;
  int lanes_;
  bool on_stand_;
  std::array<T, n_candidate> p_;
  Derived<T> d_;
  T rated_, null_;
  Drive<T, Effects> drive_, drive_before_;  // the other: of a fast log at the last point
  Sensed<T, Effects> sensed_;
  SampledLag<T> position_lag_;
  Inputs<T> now_, next_;
  // Of a fast log (feel): a point is three usual steps from the next, or as far as a gap is long.
  static constexpr int felt_parts = 4;
  std::array<T, felt_parts> felt_off_{};  // [A]
  int felt_ = 0;                          // parts that are known
  double felt_per_second_ = 0;
  std::size_t k_ = 0;
  bool any_left_ = false;
  double impact_until_, lively_until_;
};

template <class T, class Effects>
void run_pack(const Scenario& in, const ParameterVector* const* candidates, Trajectory* const* results, int lanes,
              const SimulateOptions& options) {
  Run<T, Effects> run(in, candidates, results, lanes, options);
  while (run.under_way()) run.next(Unwatched{});
}

using MakeRunInParts = std::unique_ptr<RunInParts> (*)(const Scenario&, const ParameterVector&, Trajectory&,
                                                       const SimulateOptions&);
using RunPack = void (*)(const Scenario&, const ParameterVector* const*, Trajectory* const*, int,
                         const SimulateOptions&);

struct Kernels {
  int width;
  const char* name;
  RunPack base, extended;  // without effects, with all that have names but long lines
  RunPack lined;           // with these too
  RunPack corrected;       // with a learnt curve too; plain doubles only: it is rare, and an instance is slow to build
  // One candidate over a log that comes in parts, the same four.
  MakeRunInParts base_in_parts = nullptr, extended_in_parts = nullptr, lined_in_parts = nullptr,
                 corrected_in_parts = nullptr;
};
// A run, and candidates near it that follow its steps (step_derivative.h). It leads by a stretch of samples; they
// follow over the one before the last turn.
class NearRuns {
 public:
  virtual ~NearRuns() = default;
  virtual int followers() const = 0;      // packs of candidates
  virtual bool lead(int steps) = 0;       // to the sample behind so many; false at the end of the run
  virtual void follow(int follower) = 0;  // any order, any thread, beside `lead`
  virtual void turn() = 0;                // alone, between stretches
  virtual void end() = 0;                 // alone, at last: a run that failed takes its followers along
};
struct NearKernels {
  using Make = std::unique_ptr<NearRuns> (*)(const Scenario&, const ParameterVector& base, Trajectory& of_base,
                                             const ParameterVector* const*, Trajectory* const*, int,
                                             const SimulateOptions&);
  Make base = nullptr, extended = nullptr;  // null: there are none
};

Kernels kernels_scalar();
Kernels kernels_generic();
Kernels kernels_avx2();
Kernels kernels_avx512();
// Twice as many lanes, of floats (Arithmetic).
Kernels kernels_avx2_floats();
Kernels kernels_avx512_floats();
NearKernels kernels_avx2_near();
NearKernels kernels_avx512_near();

}  // namespace servodx
