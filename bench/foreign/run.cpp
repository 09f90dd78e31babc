#include "run.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/random.h"

namespace servodx::foreign {
namespace {

constexpr double centring = 0.15;  // [1] of rated current per half stroke, in open loop; part of the logged command
constexpr double mains = 50.0;     // [Hz]
constexpr double jitter = 0.2;     // [1] of a sample's time, either way

// Lags of all sensors, read at the integration's pace.
class Sensors {
 public:
  Sensors(const Design& d, const Condition& c, double h)
      : d_(&d), pickup_(c.pickup), broken_(c.sensor), frozen_(c.frozen), noise_(c.noise) {
    for (int i = 0; i < n_channels; ++i) {
      gain_[i] = d.sensors[i].gain * (i == ch_piston ? c.position_gain : 1.0);
      const double lag = d.sensors[i].lag + (i == ch_piston ? c.position_lag : 0.0);
      part_[i] = lag > 0.0 ? -std::expm1(-h / lag) : 1.0;
    }
  }
  void take_over(const Sensors& other) { shown_ = other.shown_, still_ = other.shown_; }
  void start(const std::array<double, n_channels>& truth) {
    for (int i = 0; i < n_channels; ++i) shown_[i] = gain_[i] * truth[i];
    still_ = shown_;
  }
  void pass(const std::array<double, n_channels>& truth) {
    for (int i = 0; i < n_channels; ++i) shown_[i] += part_[i] * (gain_[i] * truth[i] - shown_[i]);
  }
  double shown(Channel c) const { return shown_[c]; }
  double recorded(int c, double t, Random& r, bool quiet) const {
    if (quiet) return shown_[c];
    const Sensor& s = d_->sensors[c];
    const double normal = r.normal(0.0, s.noise);
    if (c == broken_ && frozen_) return s.step > 0.0 ? std::round(still_[c] / s.step) * s.step : still_[c];
    double value = shown_[c] + (c == broken_ ? noise_ : 1.0) * normal;
    // Each line picks up its own phase; sensors of slow or external quantities are left alone.
    if (c <= ch_pressure_b) value += pickup_ * s.noise * std::sin(2 * std::numbers::pi * mains * t + 1.3 * c);
    return s.step > 0.0 ? std::round(value / s.step) * s.step : value;
  }

 private:
  const Design* d_;
  double pickup_;
  int broken_;
  bool frozen_;
  double noise_;
  std::array<double, n_channels> gain_{}, part_{}, shown_{}, still_{};
};

class Bench {
 public:
  Bench(const Design& d, const Job& job)
      : d_(d),
        job_(job),
        substeps_(static_cast<int>(std::ceil(job.finer / (d.control_rate * d.step)))),
        h_(1.0 / (d.control_rate * substeps_)),
        machine_(d, job.condition),
        sensors_(d, job.condition, h_),
        now_(job.condition),
        random_(d.seed, 2, job.noise),
        stamps_(d.seed, 3, job.noise),
        state_(machine_.rest()) {}

  Recording run() {
    settle();
    const auto ticks = static_cast<long>(std::floor(job_.excitation.duration * d_.control_rate));
    next_sample();
    for (long tick = 0; tick <= ticks; ++tick) {
      turn_at_onset(static_cast<double>(tick) / d_.control_rate);
      ask(tick);
      for (int k = 0; k < substeps_; ++k) {
        const double t = (static_cast<double>(tick) + static_cast<double>(k) / substeps_) / d_.control_rate;
        if (t + 0.5 * h_ >= due_) record(t);
        advance(tick, t);
      }
      if (!std::isfinite(state_[x_piston]) || !std::isfinite(state_[p_pilot_1]))
        throw std::runtime_error("foreign rig: the integration left the finite");
    }
    return std::move(made_);
  }

 private:
  std::array<double, n_channels> truth() const {
    std::array<double, n_channels> y{};
    const bool valve = d_.lines.taps_at_valve;
    y[ch_spool] = state_[x_spool];
    y[ch_piston] = state_[x_piston] - state_[x_body];
    y[ch_pressure_a] = state_[valve ? p_valve_a : p_chamber_a];
    y[ch_pressure_b] = state_[valve ? p_valve_b : p_chamber_b];
    y[ch_supply] = state_[p_supply];
    y[ch_return] = state_[p_return];
    y[ch_load] = drive_.force + drive_.spring * state_[x_piston] + drive_.drag * state_[v_piston];
    y[ch_temperature] = now_.celsius;
    y[ch_coil] = state_[current];
    return y;
  }

  double hold(double setpoint) const {
    const double asked = d_.position_gain * d_.rated_current / d_.speed * (setpoint - sensors_.shown(ch_piston));
    return std::clamp(asked, -d_.rated_current, d_.rated_current);
  }

  void settle() {
    sensors_.start(truth());
    const Excitation& e = job_.excitation;
    drive_.force = 0.0;
    drive_.spring = e.spring;
    drive_.drag = e.drag;
    const auto ticks = static_cast<long>(job_.settling * d_.control_rate);
    for (long tick = 0; tick < ticks; ++tick) {
      drive_.demand = hold(e.closed ? e.demand.front() : 0.0);
      for (int k = 0; k < substeps_; ++k) {
        machine_.step(state_, drive_, h_);
        sensors_.pass(truth());
      }
    }
    before_ = drive_.demand;
  }

  void turn_at_onset(double t) {
    if (turned_ || !job_.later || t < job_.onset) return;
    turned_ = true;
    now_ = *job_.later;
    machine_ = Machine(d_, now_);
    Sensors next(d_, now_, h_);
    next.take_over(sensors_);
    sensors_ = next;
  }

  void ask(long tick) {
    const Excitation& e = job_.excitation;
    const auto at = std::min(static_cast<std::size_t>(tick), e.demand.size() - 1);
    double demand = e.closed ? hold(e.demand[at])
                             : d_.rated_current *
                                   (e.demand[at] - centring * sensors_.shown(ch_piston) / (0.5 * d_.actuator.stroke));
    demand = std::clamp(demand, -d_.rated_current, d_.rated_current);
    asked_.push_back(std::round(demand / d_.rated_current * 32768.0) / 32768.0 * d_.rated_current);
    if (!e.turbulence.empty()) drive_.force = e.turbulence[std::min(at, e.turbulence.size() - 1)];
  }

  void advance(long tick, double t) {
    const double past = (t + 0.5 * h_ - now_.delay) * d_.control_rate;
    const double asked = past < 0.0 ? before_ : asked_[std::min(static_cast<std::size_t>(past), asked_.size() - 1)];
    const double most = now_.driver_limit * d_.rated_current;
    drive_.demand = std::clamp(now_.driver * asked, -most, most);
    if (job_.watch && t * d_.control_rate <= static_cast<double>(tick)) {
      State ds;
      Flows flows;
      machine_.rates(state_, drive_, ds, flows);
      job_.watch(t, state_, flows);
    }
    machine_.step(state_, drive_, h_);
    sensors_.pass(truth());
  }

  void record(double t) {
    const bool drop = job_.excitation.dropped && lose();
    if (!drop) {
      made_.time.push_back(t);
      made_.command.push_back(asked_.back());
      for (int c = 0; c < n_channels; ++c) made_.channel[c].push_back(sensors_.recorded(c, t, random_, job_.quiet));
    }
    ++taken_;
    next_sample();
  }

  // A hundredth of the samples begins a gap of one to thirty.
  bool lose() {
    if (lost_ > 0) return --lost_ >= 0;
    if (taken_ > 5 && stamps_.uniform() < 0.008) lost_ = static_cast<int>(stamps_.below(20)) + 1;
    return lost_ > 0;
  }

  void next_sample() {
    const double off = job_.excitation.jittered && taken_ > 0 ? stamps_.uniform(-jitter, jitter) : 0.0;
    due_ = (static_cast<double>(taken_) + off) / d_.rate;
  }

  const Design& d_;
  const Job& job_;
  int substeps_;
  double h_;
  Machine machine_;
  Sensors sensors_;
  Condition now_;
  Random random_, stamps_;
  State state_;
  Drive drive_;
  Recording made_;
  std::vector<double> asked_;
  double before_ = 0.0, due_ = 0.0;
  long taken_ = 0;
  int lost_ = 0;
  bool turned_ = false;
};

}  // namespace

Recording run(const Design& design, const Job& job) { return Bench(design, job).run(); }

}  // namespace servodx::foreign
