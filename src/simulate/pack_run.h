// The run of one pack of candidates over one log: it settles at the first sample (simulate/initial_state.h), goes from
// sample to sample by the steps that the log (simulate/step_schedule.h) and its candidates (simulate/shorter_steps.h)
// ask for, and reports what the sensors show there (simulate/sensor_readings.h).
//
// A lane's bits do not depend on its company: shorter steps that one lane asks for are taken by all and kept by that
// lane alone. A lane that leaves the finite numbers is marked and reports no more; the others go on. Nothing throws.
// Included only by the translation units that instantiate it.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#include "base/pack.h"
#include "integrate/rodas3.h"
#include "model/asperities.h"
#include "model/derived.h"
#include "model/hooks.h"
#include "model/state.h"
#include "servodx/rig.h"
#include "simulate/candidate_rows.h"
#include "simulate/effect_memories.h"
#include "simulate/initial_state.h"
#include "simulate/logged_inputs.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"
#include "simulate/sensor_readings.h"
#include "simulate/shorter_steps.h"
#include "simulate/step_schedule.h"
#include "simulate/system.h"

namespace servodx {

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
        on_stand_(in.ports != Ports::actuator),
        p_(candidate_rows<T>(in, candidates, lanes)),
        d_(derived_numbers<T, Effects>(in, p_.data())),
        inputs_(in, options, p_.data()),
        schedule_(in.time[0]) {
    sticks = any_breakaway(p_.data());
    for (int lane = 0; lane < lanes; ++lane) results[lane]->ok = true;
    settle();
    inputs_.begin_at_rest(y);
    for (int lane = 0; lane < lanes; ++lane)
      for (int c = 0; c < n_simulated; ++c) {
        results[lane]->signals[c].clear();
        if (options.wanted[c]) results[lane]->signals[c].resize(in.time.size());
      }
    friction.rest(y[s_x_spool], y[s_x_piston]);
    any_left_ = report();
  }
  Run(const Run&) = delete;

  bool under_way() const { return any_left_ && k_ + 1 < in_.time.size(); }

  // To the next sample, by the steps that the log, and stops that are near, ask for.
  template <class Watch>
  void next(Watch&& watch) {
    const double dt = begin();
    const int substeps = schedule_.steps(in_, options_, k_, dt);
    const auto y_before = y;
    const auto friction_before = friction;
    const T struck = impacts(y, d_, dt), seated = on_nozzle(y, p());
    advance(dt, substeps, watch);
    using std::max;
    const T due = max(struck, max(seated, on_nozzle(y, p())));
    if (const int finer = steps_of(dt, options_.impact_step); !on_stand_ && finer > substeps && any_due(due))
      redo(y_before, friction_before, due, [&] { advance(dt, finer, watch); });
    for (int finer = substeps * 8; finer <= substeps * 64; finer *= 8) {
      const T astray = lost(y, p());
      if (!any_due(astray)) break;
      const auto drive_first = inputs_.drive;
      redo(y_before, friction_before, astray, [&] {
        inputs_.begin_again();
        advance(dt, finer, watch);
      });
      for (int lane = 0; lane < width; ++lane)
        if (!is_due(astray, lane)) inputs_.keep_lane(drive_first, lane);
    }
    end();
  }

  // The same in parts, for a run whose steps another takes in between: its inputs move on, up to the next sample; they
  // stand at a time after the last one; friction remembers a step; the sample is reported.
  double begin() { return inputs_.begin(k_, y, live.slope); }
  T current(double after) const { return inputs_.now.current + live.slope.current * T(after); }
  void take_command(double after, double h) { inputs_.take_command(k_, after, h, y, live.slope); }
  void stand_at(double after) { live.at = inputs_.at(after, live.slope, friction); }
  void remember(const T& spool_from, const T& rod_from, double h) {
    friction.move(spool_from, y[s_x_spool], rod_from, y[s_x_piston], h, d_.spool_presliding, d_.breakaway, sticks);
  }
  void end() {
    inputs_.arrive();
    ++k_;
    any_left_ = report();
  }

  // Of a log that comes in parts: the sample reached stands first in what the scenario now holds.
  void go_on() { k_ = 0; }
  // What the run remembers of its way: another of the same candidate that takes it over goes on from here.
  auto memory() {
    return std::tie(y, friction, inputs_.drive.memory, sensors_.effects.memory, sensors_.rod_lag, inputs_.now,
                    schedule_);
  }
  // The rod stands elsewhere [m]; all else goes on as it was.
  void shift_rod(const T& by) {
    y[s_x_piston] = y[s_x_piston] + by;
    for (T& anchor : friction.seal_anchor) anchor = anchor + by;
    sensors_.shift_rod(by);
  }

  const T* p() const { return p_.data(); }
  const Derived<T>& derived() const { return d_; }
  const Inputs<T>& inputs() const { return inputs_.now; }  // at the last sample

  std::array<T, n> y{};
  FrictionMemory<T> friction;
  Live live;
  bool sticks = false;  // whether breakaway friction is followed; where there is none, the bits are the same

 private:
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

  // Lanes that are `due` (not below 0) take what `again` makes of them; the others keep what they have, so a lane's
  // bits do not depend on its company.
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
    const Inputs<T> u = inputs_.before();
    y = measured_state<T, Effects>(in_, p(), u);
    Settling<T, Effects> settling(in_, p(), d_, u);
    const auto unsettled = y;
    settling.settle(y, 1);
    if (const T due = lost(y, p()); any_due(due)) redo(unsettled, friction, due, [&] { settling.settle(y, 16); });
    if (on_stand_) settling.fill_lines(y);
    effects_at_rest(y.data(), p(), Effects{});
  }

  // Writes the sample; false once no lane is left.
  bool report() {
    const auto out = sensors_(in_.time[k_], y, inputs_.now, p(), d_, options_.wanted);
    bool any = false;
    const T here = excess(y, p());
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
  LoggedInputs<T, Effects> inputs_;
  SensorReadings<T, Effects> sensors_;
  std::size_t k_ = 0;
  bool any_left_ = false;
  StepSchedule schedule_;
};

template <class T, class Effects>
void run_pack(const Scenario& in, const ParameterVector* const* candidates, Trajectory* const* results, int lanes,
              const SimulateOptions& options) {
  Run<T, Effects> run(in, candidates, results, lanes, options);
  while (run.under_way()) run.next(Unwatched{});
}

}  // namespace servodx
