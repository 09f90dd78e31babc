#include "online/residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "base/two_pi.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "fit/log_gaps.h"
#include "online/constants.h"
#include "parameters/list.h"
#include "servodx/error.h"
#include "signals/usual_step.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = online_constants;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

double first_present(std::span<const Sample> part, Signal s) {
  for (const Sample& x : part)
    if (!std::isnan(x[s])) return x[s];
  return none;
}
std::optional<double> start_of(std::span<const Sample> part, Signal s) {
  const double x = first_present(part, s);
  return std::isnan(x) ? std::nullopt : std::optional(x);
}

// Least squares; 0 of fewer than three samples.
double slope_of(std::span<const Sample> part, Signal s) {
  double n = 0, st = 0, sx = 0, stt = 0, stx = 0;
  for (const Sample& x : part) {
    if (std::isnan(x[s])) continue;
    const double t = x.time - part.front().time;
    ++n, st += t, sx += x[s], stt += t * t, stx += t * x[s];
  }
  const double spread = n * stt - st * st;
  return n >= 3 && spread > 0 ? (n * stx - st * sx) / spread : 0.0;
}

StepperInputs inputs_of(const Sample& s, Signal drive) {
  return {s.time, s[drive], s[Signal::supply_pressure], s[Signal::return_pressure], s[Signal::load_force]};
}

}  // namespace

Residuals::Residuals(const WatchedModel& model, const std::vector<Signal>& recorded)
    : model_(model), recorded_(recorded) {
  by_current_ = records(Signal::coil_current);
  const bool pressures = records(Signal::pressure_a) && records(Signal::pressure_b);
  options_.outputs.clear();
  for (const ChannelError& c : model.error.channels) {
    if (!records(c.signal) || simulated_index(c.signal) < 0) continue;
    if (pressures && (c.signal == Signal::load_pressure || c.signal == Signal::valve_pressure_drop)) continue;
    options_.outputs.push_back(c.signal);
  }
  if (options_.outputs.empty())
    throw InputError({.file = "the log"}, "holds no signal that the table was tuned with",
                     "log what the tuning logs hold: spool or piston position, both chamber pressures or a flow");
  options_.command_is_current = by_current_;
  channels_ = options_.outputs;
  if (by_current_ && records(Signal::command)) channels_.push_back(Signal::coil_current);
  memory_.resize(channels_.size());
}

bool Residuals::records(Signal s) const { return std::find(recorded_.begin(), recorded_.end(), s) != recorded_.end(); }

void Residuals::begin(std::span<const Sample> part) {
  StepperInputs first = inputs_of(part.front(), by_current_ ? Signal::coil_current : Signal::command);
  const auto fill = [&](double& x, Signal s) {
    if (std::isnan(x)) x = first_present(part, s);
  };
  fill(first.command, by_current_ ? Signal::coil_current : Signal::command);
  if (std::isnan(first.command)) first.command = last_command_;
  fill(first.supply_pressure, Signal::supply_pressure);
  fill(first.return_pressure, Signal::return_pressure);
  fill(first.load_force, Signal::load_force);
  const StepperStart start{start_of(part, Signal::spool_position), start_of(part, Signal::piston_position),
                           start_of(part, Signal::pressure_a), start_of(part, Signal::pressure_b),
                           slope_of(part, Signal::piston_position)};
  if (const double kelvin = first_present(part, Signal::oil_temperature); !std::isnan(kelvin))
    options_.oil_temperature = kelvin;
  stepper_.emplace(model_.table, model_.rig, first, start, options_);
  for (Memory& m : memory_) m = {};
  driver_current_ = first.command;
  unknown_until_ = -1e300;
  settled_from_ = part.front().time + k::settling;
  ++restarts_;
}

std::span<const Residual> Residuals::take(std::span<const Sample> part) {
  out_.resize(part.size());
  for (Residual& r : out_) r.comparable = false, r.value.assign(channels_.size(), none);
  for (std::size_t i = 0; i < part.size(); ++i) out_[i].time = part[i].time;
  if (part.empty()) return out_;
  const bool anew = !stepper_ || !stepper_->ok() || part.front().time <= last_time_ ||
                    part.front().time - last_time_ > k::longest_gap;
  if (anew) begin(part);
  const std::span<const Sample> rest = part.subspan(anew ? 1 : 0);
  const double since = anew ? part.front().time : last_time_;
  inputs_.clear();
  for (const Sample& s : rest) inputs_.push_back(inputs_of(s, by_current_ ? Signal::coil_current : Signal::command));
  const bool ok = stepper_->step(inputs_);
  double before = since;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double dt = rest[i].time - before;
    Residual& to = out_[i + (anew ? 1 : 0)];
    if (usual_step_ > 0 && dt > gap_over_step * usual_step_)
      unknown_until_ = std::max(unknown_until_, rest[i].time + std::min(dt, gap_memory));
    // The usual step is found in a few samples, from whatever it is at first, and does not follow single gaps.
    usual_step_ = usual_step_ > 0 ? usual_step_ * (dt > usual_step_ ? 1.02 : dt < 0.98 * usual_step_ ? 0.9 : 1.0) : dt;
    if (dt < usual_step_ && dt > 0.9 * usual_step_) usual_step_ = dt;
    compare(i, rest[i], dt, to);
    to.comparable = ok && rest[i].time >= settled_from_ && rest[i].time >= unknown_until_;
    before = rest[i].time;
    if (const double u = rest[i][Signal::command]; !std::isnan(u)) last_command_ = u;
  }
  if (ok) draw_rod(rest, part.back().time - since);
  last_time_ = part.back().time;
  return out_;
}

void Residuals::compare(std::size_t at, const Sample& sample, double dt, Residual& to) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const Signal s = channels_[c];
    if (s == Signal::coil_current) {
      to.value[c] = driver_residual(sample, dt);
      continue;
    }
    const auto shown = stepper_->outputs(s);
    if (at >= shown.size()) continue;
    const double sigma = sigma_of(c, shown[at], dt);
    to.value[c] = (sample[s] - shown[at]) / sigma;
  }
}

double Residuals::sigma_of(std::size_t channel, double shown, double dt) {
  Memory& m = memory_[channel];
  if (m.begun) {
    const double keep = std::exp(-dt / activity_time), speed = std::abs(shown - m.shown) / dt * 1e-3;
    m.activity = std::sqrt(keep * m.activity * m.activity + (1 - keep) * speed * speed);
  }
  m.begun = true, m.shown = shown;
  const Signal s = channels_[channel];
  double floor = k::driver_floor * model_.rated_current, per_activity = k::driver_timing;
  if (s != Signal::coil_current) {
    const ChannelError* error = model_.error.find(s);
    floor = error->floor, per_activity = error->per_activity;
  }
  const auto noise = model_.noise.find(s);
  return std::hypot(noise == model_.noise.end() ? 0.0 : noise->second, floor, per_activity * m.activity);
}

double Residuals::driver_residual(const Sample& sample, double dt) {
  const double rate = two_pi * model_.base[row::driver_bandwidth];
  driver_current_ += (1 - std::exp(-rate * dt)) * (last_command_ - driver_current_);
  const std::size_t channel = channels_.size() - 1;
  return (sample[Signal::coil_current] - driver_current_) / sigma_of(channel, driver_current_, dt);
}

// First order, below the corner: what is left of the difference is the difference above it.
void Residuals::draw_rod(std::span<const Sample> part, double seconds) {
  if (!records(Signal::piston_position)) return;
  const auto shown = stepper_->outputs(Signal::piston_position);
  double sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < part.size() && i < shown.size(); ++i)
    if (const double x = part[i][Signal::piston_position]; !std::isnan(x)) sum += x - shown[i], ++n;
  if (n == 0) return;
  const double share = 1 - std::exp(-two_pi * piston_high_pass * seconds);
  stepper_->shift_rod(share * sum / n / model_.base[row::position_sensor_gain]);
}

nlohmann::json Residuals::state() const {
  nlohmann::json out;
  out["stepper"] = stepper_ ? nlohmann::json(stepper_->state()) : nlohmann::json();
  out["temperature"] = options_.oil_temperature;
  for (const Memory& m : memory_) out["memory"].push_back({m.shown, m.activity, m.begun});
  out["numbers"] = {last_time_, last_command_, driver_current_, usual_step_, unknown_until_, settled_from_};
  out["restarts"] = restarts_;
  return out;
}

bool Residuals::resume(const nlohmann::json& state) {
  const auto& numbers = state.at("numbers");
  last_time_ = numbers.at(0), last_command_ = numbers.at(1), driver_current_ = numbers.at(2);
  usual_step_ = numbers.at(3), unknown_until_ = numbers.at(4), settled_from_ = numbers.at(5);
  restarts_ = state.at("restarts");
  options_.oil_temperature = state.at("temperature");
  for (std::size_t c = 0; c < memory_.size(); ++c) {
    const auto& m = state.at("memory").at(c);
    memory_[c] = {m.at(0), m.at(1), m.at(2)};
  }
  stepper_.reset();
  if (state.at("stepper").is_null()) return true;
  try {
    stepper_.emplace(Stepper::resume(model_.table, model_.rig, state.at("stepper").get<std::string>(), options_));
  } catch (const InputError&) {
    return false;
  }
  return true;
}

}  // namespace servodx
