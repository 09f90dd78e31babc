// The public Stepper: a scenario of the samples of one call, and a run in parts over it.
#include "servodx/stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/celsius.h"
#include "base/json_text.h"
#include "base/sha256.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/oil_of.h"
#include "model/state.h"
#include "online/hex.h"
#include "servodx/data_sheet.h"
#include "servodx/error.h"
#include "servodx/instruction_set.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "simulate/run_in_parts.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

constexpr int state_schema = 1;
constexpr const char* place = "the stepper";

void require(bool holds, const std::string& rule, const std::string& mend) {
  if (!holds) throw InputError({.file = place}, rule, mend);
}

struct Series {
  Signal signal;
  std::vector<double> Scenario::*of;
  double StepperInputs::*from;
  std::string name() const { return std::string(name_of(signal)); }
};
constexpr Series optional_series[] = {
    {Signal::supply_pressure, &Scenario::supply_pressure, &StepperInputs::supply_pressure},
    {Signal::return_pressure, &Scenario::return_pressure, &StepperInputs::return_pressure},
    {Signal::load_force, &Scenario::load_force, &StepperInputs::load_force}};

SimulateOptions run_options(const StepperOptions& options) {
  SimulateOptions to;
  to.threads = 1;
  if (options.step) {
    to.step = *options.step;
    to.impact_step = std::min(to.impact_step, *options.step);
  }
  to.wanted.fill(false);
  for (Signal s : options.outputs) to.wanted[static_cast<std::size_t>(simulated_index(s))] = true;
  return to;
}

Scenario scenario_of(const Rig& rig, const StepperInputs& first, const StepperStart& start,
                     const StepperOptions& options) {
  Scenario s;
  s.time = {first.time};
  s.command = {first.command};
  for (const Series& series : optional_series)
    if (!std::isnan(first.*series.from)) s.*series.of = {first.*series.from};
  s.current_measured = options.command_is_current;
  s.ports = rig.ports;
  s.rated_current = rig.fact("valve.rated_current").value_or(s.rated_current);
  if (rig.command_hold) s.command_slope = *rig.command_hold == CommandHold::linear ? 1.0 : 0.0;
  s.oil = oil_of(rig.fluid, options.oil_temperature);
  s.spool_start = start.spool_position;
  s.piston_start = start.piston_position;
  s.pressure_a_start = start.pressure_a;
  s.pressure_b_start = start.pressure_b;
  s.piston_velocity_start = start.piston_velocity;
  return s;
}

}  // namespace

void StepperOptions::validate() const {
  require(!step || (*step > 0 && *step <= 0.1), "the step must lie between 0 and 0.1 s", "give it in seconds: 3e-4");
  require(std::isfinite(oil_temperature) && oil_temperature > 0, "the oil temperature must be above 0 K",
          fmt::format("give it in kelvin: {}", reference_oil_temperature));
  for (Signal s : outputs)
    require(simulated_index(s) >= 0, fmt::format("the model does not report '{}'", name_of(s)),
            "ask for a position, a pressure or a flow");
}

struct Stepper::Parts {
  StepperOptions options;
  SimulateOptions how;
  ParameterVector candidate;
  Scenario scenario;
  Trajectory shown;
  std::unique_ptr<RunInParts> run;
  std::size_t first_shown = 0;  // of the trajectory: 1 where its first sample ended the call before

  Parts(const Table& table, const Rig& rig, const StepperInputs& first, const StepperStart& start,
        const StepperOptions& asked)
      : options(asked), how(run_options(asked)), candidate(candidate_of(apply_rig_facts(table, rig))) {
    scenario = scenario_of(rig, first, start, options);
    begin();
  }
  void begin() { run = run_in_parts(scenario, candidate, shown, how); }

  // What a state belongs to.
  std::string kind() const {
    std::string bytes = fmt::format("{} {} {}", SERVODX_VERSION, instruction_set(), how.step);
    const auto add = [&](const auto& x) { bytes.append(reinterpret_cast<const char*>(&x), sizeof(x)); };
    for (double x : candidate) add(x);
    for (bool wanted : how.wanted) add(wanted);
    add(scenario.current_measured), add(scenario.ports), add(scenario.rated_current), add(how.impact_step);
    add(scenario.oil.density), add(scenario.oil.dynamic_viscosity);
    add(scenario.command_slope.value_or(-1.0));
    return sha256(bytes);
  }

  void require_order(std::span<const StepperInputs> next) const {
    double last = scenario.time.back();
    for (const StepperInputs& in : next) {
      if (!(in.time > last) || !std::isfinite(in.time))
        throw InputError({.file = place}, fmt::format("time {} s does not come after {} s", in.time, last),
                         "give the samples in the order of their time, each once");
      last = in.time;
    }
  }
  void take(std::span<const StepperInputs> next) {
    const auto last = [](std::vector<double>& x) { x.erase(x.begin(), x.end() - 1); };
    last(scenario.time), last(scenario.command);
    for (const Series& series : optional_series)
      if (!(scenario.*series.of).empty()) last(scenario.*series.of);
    for (const StepperInputs& in : next) {
      scenario.time.push_back(in.time);
      const auto add = [](std::vector<double>& to, double x) { to.push_back(std::isfinite(x) ? x : to.back()); };
      add(scenario.command, in.command);
      for (const Series& series : optional_series)
        if (!(scenario.*series.of).empty()) add(scenario.*series.of, in.*series.from);
    }
    for (int c = 0; c < n_simulated; ++c)
      if (how.wanted[static_cast<std::size_t>(c)])
        shown.signals[static_cast<std::size_t>(c)].resize(scenario.time.size());
  }
};

Stepper::Stepper(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;
Stepper& Stepper::operator=(Stepper&&) noexcept = default;

Stepper::Stepper(const Table& table, const Rig& rig, const StepperInputs& first, const StepperStart& start,
                 const StepperOptions& options) {
  options.validate();
  require(std::isfinite(first.time) && std::isfinite(first.command), "the first sample lacks its time or its command",
          "begin with a sample that has both");
  parts_ = std::make_unique<Parts>(table, rig, first, start, options);
}

bool Stepper::step(const StepperInputs& next) { return step(std::span(&next, 1)); }

bool Stepper::step(std::span<const StepperInputs> next) {
  if (next.empty()) return ok();
  parts_->require_order(next);
  parts_->take(next);
  parts_->first_shown = 1;
  return parts_->run->go_on();
}

double Stepper::time() const { return parts_->scenario.time.back(); }
bool Stepper::ok() const { return parts_->shown.ok; }

std::span<const double> Stepper::outputs(Signal signal) const {
  const int at = simulated_index(signal);
  if (at < 0 || !parts_->how.wanted[static_cast<std::size_t>(at)]) return {};
  return std::span(parts_->shown.signals[static_cast<std::size_t>(at)]).subspan(parts_->first_shown);
}
double Stepper::output(Signal signal) const {
  const auto all = outputs(signal);
  return all.empty() ? std::numeric_limits<double>::quiet_NaN() : all.back();
}

void Stepper::shift_rod(double by) { parts_->run->shift_rod(by); }

std::string Stepper::state() const {
  nlohmann::ordered_json out{{"schema", state_schema}, {"kind", parts_->kind()}, {"ok", parts_->shown.ok}};
  const Scenario& s = parts_->scenario;
  out["time"] = s.time.back(), out["command"] = s.command.back();
  for (const Series& series : optional_series)
    if (const auto& x = s.*series.of; !x.empty()) out[series.name()] = x.back();
  nlohmann::ordered_json shown = nlohmann::ordered_json::array();
  for (const auto& x : parts_->shown.signals)
    shown.push_back(x.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(x.back()));
  out["shown"] = shown;
  out["memory"] = hex_of(parts_->run->memory());
  return out.dump();
}

Stepper Stepper::resume(const Table& table, const Rig& rig, const std::string& state, const StepperOptions& options) {
  options.validate();
  const std::string mend = "begin anew, or give what it was saved with";
  const auto json = json_or_discarded<nlohmann::json>(state);
  require(has_schema(json, state_schema), "this is no state of a stepper", mend);
  try {
    StepperInputs first{.time = json.at("time"), .command = json.at("command")};
    for (const Series& series : optional_series) first.*series.from = json.value(series.name(), first.*series.from);
    Stepper out(std::make_unique<Parts>(table, rig, first, StepperStart{}, options));
    Parts& parts = *out.parts_;
    require(json.at("kind") == parts.kind(),
            "the state was saved with another table, rig file, option, version or processor", mend);
    require(parts.run->recall(bytes_of_hex(json.at("memory").get<std::string>())), "the state is damaged", mend);
    parts.shown.ok = json.at("ok");
    const auto& shown = json.at("shown");
    for (std::size_t c = 0; c < parts.shown.signals.size(); ++c)
      if (!parts.shown.signals[c].empty() && shown.at(c).is_number()) parts.shown.signals[c].back() = shown.at(c);
    return out;
  } catch (const nlohmann::json::exception&) {
    throw InputError({.file = place}, "the state is damaged", mend);
  }
}

}  // namespace servodx
