#include "rig/rig_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/celsius.h"
#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "rig/fluid.h"
#include "rig/plant.h"
#include "rig/sensors.h"
#include "servodx/rig.h"

namespace servodx::rig {
namespace {

constexpr double settling = 0.3;      // [s] before the log, held centred by a slow loop
constexpr double compensating = 1.5;  // [s] the same, where the loop must find the null to compensate
constexpr double centring = 25.0;     // [1/m] of rated current, of that loop

// Logged unless the run names its channels. Pilot pressures and coil current are there for those who ask.
const std::vector<std::string>& usual(Ports ports) {
  static const std::vector<std::string> actuator{"spool_position",  "piston_position", "pressure_a", "pressure_b",
                                                 "supply_pressure", "return_pressure", "load_force", "oil_temperature"};
  static const std::vector<std::string> blocked{"spool_position",  "load_pressure",   "leakage_flow",
                                                "supply_pressure", "return_pressure", "oil_temperature"};
  static const std::vector<std::string> free{"spool_position",  "valve_pressure_drop", "control_flow",
                                             "supply_pressure", "return_pressure",     "oil_temperature"};
  return ports == Ports::actuator ? actuator : ports == Ports::blocked ? blocked : free;
}

void check(const RigRun& run) {
  const auto range = [](const char* option, double value, double low, double high, const char* unit) {
    if (!(value >= low && value <= high)) {
      throw InputError({"", 0, option}, fmt::format("{} is outside {} to {} {}", value, low, high, unit),
                       "give a value within");
    }
  };
  range("--duration", run.duration, 0.01, 1e5, "s");
  range("--rate", run.rate, 10.0, 5e4, "Hz");
  range("--temperature", run.temperature - zero_celsius, -40.0, 100.0, "degC");
  range("--air", run.air, 0.0, 0.2, "(fraction)");
  range("--viscosity", run.viscosity, 0.05, 20.0, "(factor)");
  range("--amplitude", run.amplitude, 0.0, 1.2, "(fraction)");
  range("--frequency", run.frequency, 0.0, 500.0, "Hz");
  range("--jitter", run.jitter, 0.0, 0.25 / run.rate, "s");
  if (run.step != 0.0) range("step", run.step, 1e-7, 1e-4, "s");
}

std::vector<SensorChain> chosen_sensors(const RigModel& model, const RigRun& run) {
  const auto& wanted = run.channels.empty() ? usual(model.ports) : run.channels;
  std::vector<SensorChain> chains;
  std::string names;
  std::size_t found = 0;
  for (Sensor sensor : model.sensors) {
    names += (names.empty() ? "" : ", ") + sensor.signal;
    if (std::find(wanted.begin(), wanted.end(), sensor.signal) == wanted.end()) continue;
    ++found;
    if (!run.noise) sensor = {.signal = sensor.signal, .unit = sensor.unit};
    chains.emplace_back(sensor, run.seed, 100 + static_cast<std::uint32_t>(index(*find_signal(sensor.signal))),
                        model.mains_frequency);
  }
  if (found != wanted.size()) {
    throw InputError({"", 0, "--channels"}, "a channel is unknown or named twice", "the rig measures " + names);
  }
  return chains;
}

FaultSet with_onset(const RigRun& run) {
  FaultSet faults = run.faults;
  for (auto& [name, course] : faults)
    if (!course.changes()) course.start = run.onset;
  return faults;
}

// A fault that begins behind the log's end would be in its truth alone.
void check_onsets(const RigRun& run) {
  for (const auto& [name, course] : with_onset(run))
    if (course.start >= run.duration)
      throw InputError(
          {.file = "--fault"},
          fmt::format("{} begins at {} s, and the log ends at {} s", label_of(name), course.start, run.duration),
          "begin it within the log, or give a longer --duration");
}

bool any_changes(const FaultSet& faults) {
  return std::any_of(faults.begin(), faults.end(), [](const auto& fault) { return fault.second.changes(); });
}

nlohmann::json time_or_null(double time) { return time >= 0.0 ? nlohmann::json(time) : nlohmann::json(nullptr); }

nlohmann::json truth_of(const RigModel& model, const RigRun& run, double h) {
  nlohmann::json faults = nlohmann::json::array();
  std::string label;
  double onset = -1.0;
  for (const auto& [name, course] : with_onset(run)) {
    faults.push_back({{"label", label_of(name)},
                      {"severity", course.severity},
                      {"start", time_or_null(course.start)},
                      {"end", time_or_null(course.end)}});
    if (name != label_of(name)) faults.back()["name"] = name;
    if (!label.empty()) label += '+';
    label += label_of(name);
    if (course.changes() && (onset < 0.0 || course.start < onset)) onset = course.start;
  }
  nlohmann::json truth{
      {"tool", "servodx"},
      {"command", "rig"},
      {"rig", model.name},
      {"seed", run.seed},
      {"excitation", run.excitation},
      {"duration", run.duration},
      {"rate", run.rate},
      {"temperature", run.temperature - zero_celsius},
      {"air", run.air},
      {"faults", faults},
      {"label", label.empty() ? "healthy" : label},
      {"onset_time", time_or_null(onset)},
      {"null", model.armature_null + model.armature_null_drift * (run.temperature - zero_celsius - 40.0)},
      {"step", h}};
  if (run.viscosity != 1.0) truth["viscosity"] = run.viscosity;
  if (run.amplitude > 0.0) truth["amplitude"] = run.amplitude;
  if (run.frequency > 0.0) truth["frequency"] = run.frequency;
  if (run.jitter > 0.0) truth["jitter"] = run.jitter;
  if (run.offset) truth["offset"] = "three terms, Borello 2009";
  if (!model.changed.empty()) truth["changed"] = model.changed;
  return truth;
}

// How well oil and energy balance over a log: what came in less what is stored more, over what was moved.
class Balance {
 public:
  explicit Balance(const VirtualRig& rig)
      : start_(rig.state()), oil_(rig.plant().stored_oil(start_)), energy_(rig.plant().stored_energy(start_)) {}
  nlohmann::json closed_by(const VirtualRig& rig) const {
    const State& s = rig.state();
    const auto gained = [&](Var v) { return s[v] - start_[v]; };
    const double oil = gained(oil_in) - gained(oil_out) - (rig.plant().stored_oil(s) - oil_);
    const double energy = gained(energy_in) - gained(energy_lost) - (rig.plant().stored_energy(s) - energy_);
    return {{"oil_error", oil / gained(oil_in)}, {"energy_error", energy / gained(energy_lost)}};
  }

 private:
  State start_;
  double oil_, energy_;
};

// The recording of one run: the rig, its sensors and the loop of the control computer around them.
class Recorder {
 public:
  Recorder(const RigModel& model, const RigRun& run, const Stimulus& stimulus)
      : run_(run),
        stimulus_(stimulus),
        faults_(with_onset(run)),
        changes_(any_changes(faults_)),
        rig_(model, {run.temperature, run.air, wear_of(faults_, 0.0), run.viscosity}),
        sensors_(chosen_sensors(model, run)),
        loop_sensor_(Sensor{"piston_position", "mm"}, run.seed, 99),
        unit_(find_unit("mA")) {
    if (run.offset) offset_ = borello_offset(run.seed, run.duration);
    for (const auto& sensor : model.sensors) {
      if (sensor.signal == "piston_position" && run.noise) {
        loop_sensor_ = SensorChain(sensor, run.seed, 99, model.mains_frequency);
      }
    }
    const double tick = 1.0 / run.rate, largest = run.step > 0.0 ? run.step : model.solver_step;
    steps_ = static_cast<int>(std::ceil(tick / largest - 1e-9));
    h_ = tick / steps_;
  }

  double step_size() const { return h_; }

  RigLog record(const Observer& observe) {
    settle();
    const auto rows = static_cast<std::size_t>(std::floor(run_.duration * run_.rate + 1e-9));
    std::vector<double> time(rows), command(rows), setpoint;
    std::vector<std::vector<double>> columns(sensors_.size(), std::vector<double>(rows));
    Random jitter(run_.seed, 98);
    const Balance start(rig_);
    for (std::size_t k = 0; k < rows; ++k) {
      if (run_.stop && *run_.stop) {
        stopped_ = true;
        for (auto* column : {&time, &command}) column->resize(k);
        for (auto& column : columns) column.resize(k);
        break;
      }
      if (run_.progress && k % 64 == 0) run_.progress(static_cast<double>(k) / static_cast<double>(rows));
      const double tick = static_cast<double>(k) / run_.rate;
      const double u = quantised(stimulus_.command(tick, loop_sensor_.read()) + compensation_);
      if (stimulus_.setpoint) setpoint.push_back(stimulus_.setpoint(tick));
      int late = 0;  // steps after the tick at which the row is taken
      if (run_.jitter > 0.0) {
        late = static_cast<int>(std::lround(std::fabs(jitter.normal()) * run_.jitter / h_));
        late = std::min(late, steps_ - 1);
      }
      for (int i = 0; i <= steps_; ++i) {
        if (i == late) {
          time[k] = tick + late * h_;
          command[k] = u;
          for (std::size_t c = 0; c < sensors_.size(); ++c) columns[c][k] = sensors_[c].read();
          if (observe) observe(time[k], u, rig_);
        }
        if (i == 0) begin_tick(tick);
        if (i < steps_) advance(tick + i * h_, u);
      }
      check_finite(tick);
    }
    RigLog log;
    log.truth = nlohmann::json::object();
    if (!changes_) log.truth["balance"] = start.closed_by(rig_);
    if (stopped_) log.truth["interrupted"] = true;
    log.columns.push_back({Signal::time, "s", std::move(time)});
    log.columns.push_back({Signal::command, "mA", std::move(command)});
    if (!setpoint.empty()) {
      for (double& x : setpoint) x = find_unit("mm")->to_si(rounded(x * 1e3, 0.01));
      log.columns.push_back({Signal::setpoint, "mm", std::move(setpoint)});
    }
    for (std::size_t c = 0; c < sensors_.size(); ++c) {
      log.columns.push_back({sensors_[c].signal(), sensors_[c].unit(), std::move(columns[c])});
    }
    return log;
  }

 private:
  // The control computer itself counts in converter steps, so the log shows what was sent.
  double quantised(double command) const {
    return unit_->to_si(rounded(unit_->from_si(command), rig_.model().driver_quantum * 1e3));
  }

  Seen seen(const Load& load) const {
    return {load.force + load.stiffness * rig_.state()[x_surface], run_.temperature};
  }

  void settle() {
    const auto steps = static_cast<long>(std::ceil((stimulus_.compensated ? compensating : settling) / h_));
    const double to_centre = centring * rig_.model().driver_rated_current;  // [A/m]
    const Load load = stimulus_.load ? stimulus_.load(0.0) : Load{};
    if (offset_) rig_.set_offset(offset_(0.0));
    for (long i = 0; i < steps; ++i) {
      rig_.step(-to_centre * rig_.piston_position(), load.force, load.stiffness, h_);
    }
    check_finite(0.0);
    if (stimulus_.compensated) compensation_ = -to_centre * rig_.piston_position();
    for (auto& sensor : sensors_) sensor.reset(rig_, seen(load));
    loop_sensor_.reset(rig_, seen(load));
  }

  // An explicit solver that meets a rate above its limit runs away: thin friction, small volumes, hot oil.
  void check_finite(double time) const {
    const State& s = rig_.state();
    if (std::all_of(s.begin(), s.end(), [](double x) { return std::isfinite(x); })) return;
    throw InputError({"", 0, "solver.step"},
                     fmt::format("the rig's equations ran away at {:.4g} s with steps of {:.3g} s", time, h_),
                     "take smaller steps with --set solver.step=..., or parameters that are less stiff");
  }

  // Wear and offset move slowly against a tick.
  void begin_tick(double tick) {
    if (changes_) rig_.set_wear(wear_of(faults_, tick));
    if (offset_) rig_.set_offset(offset_(tick));
  }

  void advance(double time, double command) {
    const Load load = stimulus_.load ? stimulus_.load(time) : Load{};
    rig_.step(command, load.force, load.stiffness, h_);
    const Seen now = seen(load);
    for (auto& sensor : sensors_) sensor.follow(rig_, now, h_);
    loop_sensor_.follow(rig_, now, h_);
  }

  RigRun run_;
  Stimulus stimulus_;
  FaultSet faults_;
  bool changes_;
  std::function<double(double)> offset_;  // [1] of rated current against time; empty: none
  VirtualRig rig_;
  std::vector<SensorChain> sensors_;
  SensorChain loop_sensor_;
  const Unit* unit_;
  int steps_ = 1;
  double h_ = 0.0;
  double compensation_ = 0.0;  // [A] current that held the spool at null before the log
  bool stopped_ = false;
};

}  // namespace

RigLog run_rig(const RigModel& model, const RigRun& run, const Stimulus& stimulus, const Observer& observe) {
  check(run);
  check_onsets(run);
  Recorder recorder(model, run, stimulus);
  RigLog log = recorder.record(observe);
  nlohmann::json truth = truth_of(model, run, recorder.step_size());
  truth.update(log.truth);
  log.truth = std::move(truth);
  log.comments.push_back(fmt::format("virtual rig '{}', excitation {}, seed {}", model.name, run.excitation, run.seed));
  return log;
}

RigLog run_rig(const RigModel& model, const RigRun& run, const Observer& observe) {
  check(run);
  const Shape shape{run.duration, run.amplitude, run.frequency, run.seed};
  return run_rig(model, run, make_stimulus(run.excitation, model, shape), observe);
}

}  // namespace servodx::rig
