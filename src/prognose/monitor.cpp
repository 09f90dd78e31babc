#include "prognose/monitor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "fit/candidate_of.h"
#include "fit/nominal.h"
#include "parameters/list.h"
#include "prognose/valve_geometry.h"
#include "servodx/valve_numbers.h"
#include "simulate/scenario.h"
#include "valve_maps/high_fidelity.h"
#include "valve_maps/registry.h"

namespace servodx {
namespace {

double mean_or(const std::vector<double>& x, double otherwise) {
  double sum = 0;
  for (double v : x) sum += v;
  return x.empty() ? otherwise : sum / static_cast<double>(x.size());
}

// Root of a rising function by regula falsi (Illinois), from a guess; `width` is the first bracket's half.
template <class F>
double rising_root(const F& f, double guess, double width, double tolerance) {
  double a = guess - width, b = guess + width, fa = f(a), fb = f(b);
  for (; fa > 0; width *= 4) b = a, fb = fa, a -= 4 * width, fa = f(a);
  for (; fb < 0; width *= 4) a = b, fa = fb, b += 4 * width, fb = f(b);
  int side = 0;
  for (int k = 0; k < 100 && b - a > tolerance && fa != fb; ++k) {
    const double x = (a * fb - b * fa) / (fb - fa), fx = f(x);
    if (fx == 0) return x;
    if (fx > 0) {
      b = x, fb = fx;
      if (side == 1) fa /= 2;
      side = 1;
    } else {
      a = x, fa = fx;
      if (side == -1) fb /= 2;
      side = -1;
    }
  }
  return (a * fb - b * fa) / (fb - fa != 0 ? fb - fa : 1);
}

}  // namespace

Supply supply_of(const LogData& log, const Table& table) {
  return {mean_or(log.scenario.supply_pressure, table[row::supply_pressure].nominal),
          mean_or(log.scenario.return_pressure, table[row::return_pressure].nominal), log.scenario.oil,
          log.scenario.rated_current};
}

MonitorParameters monitor_parameters(const Table& table, const Supply& at) {
  const auto value = [&](int row) { return table[row].nominal; };
  const auto area = [](double diameter) { return std::numbers::pi / 4 * diameter * diameter; };
  const double drop = at.supply - at.return_, root = std::sqrt(2 / at.oil.density);
  MonitorParameters p;
  p.pressure_limit = drop;
  p.motor_gain = value(row::torque_motor_gain);
  p.flapper_stiffness = value(row::flapper_stiffness) + value(row::feedback_wire_stiffness);
  p.flapper_limit = value(row::nozzle_gap);
  p.spool_limit = value(row::spool_stop);

  // Pilot bridge, flapper centred: filter, fixed orifice and nozzle in series share the drop.
  const double gap = value(row::nozzle_gap), curtain = value(row::hydraulic_amplifier_gain);
  const double g_nozzle = nominal::cd_nozzle * root * curtain;
  const double g_orifice = nominal::cd_orifice * root * area(value(row::fixed_orifice_diameter));
  const double clean = 1 - 0.5 * (value(row::filter_blockage_positive) + value(row::filter_blockage_negative));
  const double over_nozzle = std::pow(g_orifice / (g_nozzle * gap), 2);
  const double over_filter = 1 / std::pow(nominal::clean_filter_area_ratio * std::max(clean, 1e-3), 2);
  const double over_orifice = drop / (1 + over_nozzle + over_filter);
  const double pilot = over_nozzle * over_orifice;  // nozzle pressure above return
  const double spool_area = area(value(row::spool_diameter));
  p.first_stage_gain = g_nozzle * std::sqrt(pilot) / spool_area;

  // Flow force on the open spool is a spring; the pilot pressure that balances it turns the flapper and presses on it.
  const double spring = nominal::jet_angle_factor * value(row::flow_force_coefficient) * value(row::port_width) * drop;
  const double ratio = 1 / over_nozzle;
  const double pilot_gain = 4 * (pilot + over_orifice) * ratio / (gap * std::pow(1 + ratio, 2));  // [Pa/m], both sides
  const double nozzle_area = area(curtain / std::numbers::pi);
  p.spool_force_gain = (nozzle_area + p.flapper_stiffness / pilot_gain) / spool_area;
  p.wire_stiffness = value(row::feedback_wire_stiffness) + spring * p.spool_force_gain;

  valve_maps::HighFidelity valve(geometry_of(candidate_of(table), at));
  const valve_maps::ValveNumbers numbers = valve.measure(drop);
  p.pressure_gain = numbers.null_slope;
  p.flow_gain = numbers.flow_gain;
  p.piston_area = 0.5 * (value(row::piston_area_a) + value(row::piston_area_b));
  p.viscous = value(row::piston_viscous_friction) * std::sqrt(at.oil.viscosity_ratio);
  p.mass = value(row::moving_mass);
  p.piston_limit = 0.5 * value(row::piston_stroke);
  p.null_current = value(row::servovalve_null) * at.rated_current;
  return p;
}

PressureLaw linear_pressure(const MonitorParameters& p) {
  return [gain = p.pressure_gain, slope = p.pressure_gain / p.flow_gain, limit = p.pressure_limit](double x, double q) {
    return std::clamp(gain * x - slope * q, -limit, limit);
  };
}

void require_pressure_law(const std::string& name) {
  if (valve_maps::find_map(name)) return;
  std::string names;
  for (const valve_maps::MapInfo& map : valve_maps::map_list()) names += (names.empty() ? "" : ", ") + map.name;
  throw InputError({.file = "--model"}, "there is no pressure model '" + name + "'", "use one of " + names);
}

PressureLaw pressure_law(const std::string& name, const Table& table, const Supply& at) {
  require_pressure_law(name);
  const valve_maps::MapInfo* info = valve_maps::find_map(name);
  const double drop = at.supply - at.return_;
  valve_maps::HighFidelity valve(geometry_of(candidate_of(table), at));
  const valve_maps::ValveNumbers numbers = valve.measure(drop);
  const valve_maps::Map map = info->make(numbers, valve);
  if (name == "linear" || name == "A")
    return [=](double x, double q) { return std::clamp(map(x, q, drop), -drop, drop); };
  return [=](double x, double q) { return map(x, q, drop); };
}

Monitor::Monitor(const MonitorParameters& parameters, PressureLaw law) : p_(parameters), law_(std::move(law)) {}

void Monitor::start(double spool, double piston) {
  spool_ = std::clamp(spool, -p_.spool_limit, p_.spool_limit);
  piston_ = std::clamp(piston, -p_.piston_limit, p_.piston_limit);
  speed_ = pressure_ = 0;
}

void Monitor::step(double current, double load, double h) {
  // XF = (TM - KSF XS) / KFt within +-XFM; dXS/dt = GQF/ASV XF.
  const double torque = p_.motor_gain * (current + p_.null_current);
  const double fastest = p_.first_stage_gain * p_.flapper_limit;
  double left = h, error = torque - p_.wire_stiffness * spool_;  // [N] on the flapper
  const double held = p_.flapper_stiffness * p_.flapper_limit;   // [N] that drives it to its stop
  if (std::abs(error) > held) {
    const double sign = error > 0 ? 1 : -1;
    const double slew = p_.wire_stiffness > 0 ? (std::abs(error) - held) / (p_.wire_stiffness * fastest) : left;
    const double time = std::min(slew, left);
    spool_ += sign * fastest * time;
    left -= time;
    error = torque - p_.wire_stiffness * spool_;
  }
  if (left > 0) {
    const double rate = p_.first_stage_gain * p_.wire_stiffness / p_.flapper_stiffness;  // [1/s]
    const double lever = rate > 0 ? -std::expm1(-rate * left) / rate : left;             // [s]
    spool_ += p_.first_stage_gain / p_.flapper_stiffness * error * lever;
  }
  spool_ = std::clamp(spool_, -p_.spool_limit, p_.spool_limit);

  // Backward Euler: M (v - v0) / h = AJ P12(XS, AJ v) - CJ v - load.
  const double pull = h / p_.mass, before = speed_;
  const auto balance = [&](double v) {
    return v - before - pull * (p_.piston_area * law_(spool_, p_.piston_area * v) - p_.viscous * v - load);
  };
  // Near the unloaded speed; the bracket is what the flow gain makes of a tenth of the saturation travel.
  const double guess = std::clamp(before, -1e3, 1e3);
  speed_ = rising_root(balance, guess, 1e-3, 1e-9);
  piston_ += h * speed_;
  if (std::abs(piston_) >= p_.piston_limit) {
    piston_ = std::clamp(piston_, -p_.piston_limit, p_.piston_limit);
    if (speed_ * piston_ > 0) speed_ = 0;
  }
  pressure_ = law_(spool_, p_.piston_area * speed_);
}

namespace {

template <class Current>
MonitorRun run(Monitor& monitor, const LogData& log, const Current& current) {
  const Scenario& s = log.scenario;
  MonitorRun run;
  const std::size_t n = s.time.size();
  for (auto* v : {&run.spool, &run.piston, &run.pressure}) v->reserve(n);
  for (std::size_t k = 0; k < n; ++k) {
    run.spool.push_back(monitor.spool());
    run.piston.push_back(monitor.piston());
    run.pressure.push_back(monitor.pressure());
    if (k + 1 < n) monitor.step(current(k), s.load_force.empty() ? 0.0 : s.load_force[k], s.time[k + 1] - s.time[k]);
  }
  return run;
}

}  // namespace

MonitorRun run_monitor(const MonitorParameters& parameters, const PressureLaw& law, const LogData& log,
                       std::optional<double> rest) {
  const Scenario& s = log.scenario;
  MonitorParameters p = parameters;
  if (rest) p.null_current = 0;
  Monitor monitor(p, law);
  monitor.start(rest ? 0.0
                     : s.spool_start.value_or(p.motor_gain * (s.command.front() + p.null_current) /
                                              std::max(p.wire_stiffness, 1e-9)),
                s.piston_start.value_or(0.0));
  return run(monitor, log, [&](std::size_t k) { return s.command[k] - rest.value_or(0.0); });
}

MonitorRun run_monitor_loop(const MonitorParameters& parameters, const PressureLaw& law, const LogData& log,
                            const std::vector<double>& setpoint) {
  Monitor monitor(parameters, law);
  monitor.start(log.scenario.spool_start.value_or(0.0), log.scenario.piston_start.value_or(0.0));
  return run(monitor, log, [&](std::size_t k) { return monitor.demand(setpoint[k]); });
}

}  // namespace servodx
