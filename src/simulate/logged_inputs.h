// What the log puts into a run between its samples: the current that the torque motor feels, pressures at the ports and
// load force, as lines over time. Pressures and force run straight from sample to sample; the current is what the
// nuisance `command_slope` makes of the command, with null, limit, and what the effects of the drive remember.
//
// Of a log that is sampled faster than its run steps the current is a line over each step instead
// (simulate/fast_command.h), and the effects of the drive act on the means of usual steps.
// Left out: what pressures and force do between samples. Source: docs/model.md.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "base/pack.h"
#include "base/smooth.h"
#include "model/asperities.h"
#include "model/constants.h"
#include "model/hooks.h"
#include "model/state.h"
#include "parameters/list.h"
#include "simulate/effect_memories.h"
#include "simulate/fast_command.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"
#include "simulate/step_schedule.h"

namespace servodx {

// y: the states of the pack, of which the flapper's and the coil's are used; k: the last sample that was reached.
template <class T, class Effects>
class LoggedInputs {
 public:
  // p: rows of the pack.
  LoggedInputs(const Scenario& in, const SimulateOptions& options, const T* p)
      : in_(in), options_(options), p_(p), rated_(T(in.rated_current)), null_(p[row::servovalve_null] * rated_) {}

  Drive<T, Effects> drive;
  Inputs<T> now;  // at the last sample

  // What stood before the log began.
  Inputs<T> before() const { return at_sample(0, T(first_command()) + null_); }
  // At the first sample, after a history that ended at the current which holds the spool.
  template <class States>
  void begin_at_rest(const States& y) {
    drive.rest(y[s_current], spring(y), p_, rated_);
    now = at_sample(0, drive(in_.time[0], T(first_command()) + null_, spring(y), p_, rated_));
  }
  // From sample k on to the next, [s] later; `slope` per second of it.
  template <class States>
  double begin(std::size_t k, const States& y, Inputs<T>& slope) {
    const double dt = in_.time[k + 1] - in_.time[k];
    const T commanded = T(in_.command[k + 1]) + null_;
    if (in_.fast) drive_before_ = drive;
    felt_ = 0, felt_per_second_ = std::min(steps_of(dt, options_.step), felt_parts) / dt;
    next_ = at_sample(k + 1, in_.fast ? commanded : drive(in_.time[k + 1], commanded, spring(y), p_, rated_));
    const T per = T(1.0 / dt);
    slope = {p_[nuisance::command_slope] * (next_.current - now.current) * per,
             (next_.supply_pressure - now.supply_pressure) * per, (next_.return_pressure - now.return_pressure) * per,
             (next_.load_force - now.load_force) * per};
    return dt;
  }
  // Of a fast log the line over the step from `after` [s] past sample k on that is `h` long; of any other there is one
  // to the sample.
  template <class States>
  void take_command(std::size_t k, double after, double h, const States& y, Inputs<T>& slope) {
    if (!in_.fast) return;
    const double t = in_.time[k] + after;
    const CommandLines lines = in_.fast.over(k, t, t + h);
    T off = null_;
    if constexpr (Drive<T, Effects>::acts) {
      const int part = std::min(static_cast<int>((after + 0.5 * h) * felt_per_second_), felt_parts - 1);
      feel(k, part, y);
      off = off + felt_off_[static_cast<std::size_t>(part)];
    }
    const auto at = [&](double held, double joined) {
      return saturate(T(held) + p_[nuisance::command_slope] * T(joined - held) + off, p_[row::current_limit],
                      constants::current_rounding);
    };
    const T from = at(lines.held.from, lines.joined.from), to = at(lines.held.to, lines.joined.to);
    slope.current = (to - from) * T(1.0 / h);
    now.current = from - slope.current * T(after);
  }
  // `after` [s] past the last sample.
  Inputs<T> at(double after, const Inputs<T>& slope, const FrictionMemory<T>& friction) const {
    const T t = T(after);
    return {now.current + slope.current * t, now.supply_pressure + slope.supply_pressure * t,
            now.return_pressure + slope.return_pressure * t, now.load_force + slope.load_force * t, friction};
  }
  // The way from the sample is taken anew: what a lost flapper did to the iron is undone. Lanes that were not lost keep
  // the drive that they had.
  void begin_again() {
    if (in_.fast) drive = drive_before_, felt_ = 0;
  }
  void keep_lane(const Drive<T, Effects>& had, int lane) {
    if (in_.fast) drive.take_lane(had, lane);
  }
  void arrive() { now = next_; }

 private:
  // [A] that stood before the log began.
  double first_command() const { return in_.fast ? in_.fast.samples->value[in_.fast.at[0]] : in_.command[0]; }
  // What the effects of the drive make of the command of a fast log, as what the motor feels beyond it: of the mean
  // over each usual step, at its middle, once the run is there. Finer steps over the same stretch find it as it was, so
  // a lane does not depend on another's.
  template <class States>
  void feel(std::size_t k, int part, const States& y) {
    for (; felt_ <= part; ++felt_) {
      const double h = 1.0 / felt_per_second_, t = in_.time[k] + h * felt_;
      const CommandLines lines = in_.fast.over(k, t, t + h);
      const double held = 0.5 * (lines.held.from + lines.held.to), joined = 0.5 * (lines.joined.from + lines.joined.to);
      const T mean = T(held) + p_[nuisance::command_slope] * T(joined - held) + null_;
      felt_off_[static_cast<std::size_t>(felt_)] = drive(t + 0.5 * h, mean, spring(y), p_, rated_) - mean;
    }
  }
  T input(const std::vector<double>& series, std::size_t k, const T& table) const {
    return series.empty() ? table : T(series[k]);
  }
  Inputs<T> at_sample(std::size_t k, const T& current) const {
    return {saturate(current, p_[row::current_limit], constants::current_rounding),
            input(in_.supply_pressure, k, p_[row::supply_pressure]),
            input(in_.return_pressure, k, p_[row::return_pressure]),
            input(in_.load_force, k, T(0.0)),
            T(0.0),
            T(0.0)};
  }
  template <class States>
  T spring(const States& y) const {  // [A]
    return flapper_travel(y[s_x_flapper], p_) * (p_[row::flapper_stiffness] / p_[row::torque_motor_gain]);
  }

  const Scenario& in_;
  const SimulateOptions& options_;
  const T* p_;
  T rated_, null_;
  Drive<T, Effects> drive_before_;  // of a fast log at the last point
  Inputs<T> next_;
  // Of a fast log (feel): a point is three usual steps from the next, or as far as a gap is long.
  static constexpr int felt_parts = 4;
  std::array<T, felt_parts> felt_off_{};  // [A]
  int felt_ = 0;                          // parts that are known
  double felt_per_second_ = 0;
};

}  // namespace servodx
