#include "prognose/loop_margins.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/two_pi.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "model/state.h"
#include "parameters/list.h"
#include "prognose/constants.h"
#include "prognose/valve_geometry.h"
#include "servodx/monitor.h"
#include "servodx/valve_numbers.h"
#include "simulate/linearise.h"
#include "valve_maps/high_fidelity.h"

namespace servodx {
namespace {

using Complex = std::complex<double>;
using namespace prognose_constants::loop;
constexpr int drive_place = 0, spool_place = 1;  // in missing_places

double frequency_at(int k) { return lowest * std::pow(highest / lowest, k / (frequencies - 1.0)); }

// Share of the wire's stiffness that a dead zone leaves at an amplitude.
double left_by_dead_zone(double half_width, double amplitude) {
  const double r = half_width / amplitude;
  return r >= 1 ? 0.0 : 1 - 2 / std::numbers::pi * (std::asin(r) + r * std::sqrt(1 - r * r));
}

Scenario at_rest(const Supply& at, std::size_t count) {
  Scenario s;
  for (std::size_t k = 0; k < count; ++k) s.time.push_back(interval * static_cast<double>(k));
  s.command.assign(count, 0.0);
  s.supply_pressure.assign(count, at.supply);
  s.return_pressure.assign(count, at.return_);
  s.oil = at.oil;
  s.rated_current = at.rated_current;
  s.spool_start = s.piston_start = 0.0;
  return s;
}

void take_off_laps(ParameterVector& candidate) {
  for (const int lap : {row::lap_pa, row::lap_pb, row::lap_at, row::lap_bt})
    candidate[static_cast<std::size_t>(lap)] = 0;
}

// Crossing of zero between two values, as a share of the way.
double crossing(double from, double to) { return from / (from - to); }

}  // namespace

PositionLoop::PositionLoop(const Table& tuned, const Supply& at, double velocity_gain, double delay)
    : at_(at), delay_(delay), healthy_(candidate_of(tuned)) {
  const std::vector<Response> r = responses(healthy_, 1);
  const double speed_per_current = std::abs(r.front().piston_per_current) * two_pi * lowest;  // [m/s/A]
  gain_ = velocity_gain / (speed_per_current * over_null_slope(healthy_, std::nullopt));
}

double PositionLoop::over_null_slope(const ParameterVector& candidate, std::optional<double> amplitude) const {
  const double drop = at_.supply - at_.return_;
  valve_maps::HighFidelity valve(geometry_of(candidate, at_));
  const valve_maps::ValveNumbers numbers = valve.measure(drop);
  const auto first_harmonic = [&](const valve_maps::HighFidelity& of, double size) {
    double sum = 0;
    for (int k = 0; k < harmonic_points; ++k) {
      const double sine = std::sin(std::numbers::pi * (k + 0.5) / harmonic_points);
      sum += 2.0 / harmonic_points * of.no_load_flow(size * sine, drop) * sine;
    }
    return sum / size;
  };
  ParameterVector lapped_off = candidate;
  take_off_laps(lapped_off);
  const double at_null = first_harmonic(valve_maps::HighFidelity(geometry_of(lapped_off, at_)),
                                        null_amplitude * candidate[row::radial_clearance]);
  return (amplitude ? first_harmonic(valve, *amplitude) : numbers.flow_gain) / at_null;
}

std::vector<PositionLoop::Response> PositionLoop::responses(const ParameterVector& candidate, double wire) const {
  ParameterVector smooth = candidate;
  smooth[row::feedback_wire_stiffness] *= std::max(wire, least_wire);
  smooth[row::valve_glitch] = 0;
  take_off_laps(smooth);
  for (const int friction : {row::spool_friction, row::piston_coulomb_friction, row::piston_stribeck_friction})
    smooth[static_cast<std::size_t>(friction)] *= no_friction;
  const Linearisation linear = linearise(at_rest(at_, samples), smooth);
  if (!linear.ok || linear.transition.empty())
    throw InputError({.file = "--loop"}, "the model finds no rest at this table's values",
                     "check the table against the rig's data sheet");
  const Eigen::MatrixXd& step = linear.transition.back();
  const int n = linear.states - n_missing_places;  // the inputs' states are constant
  const Eigen::MatrixXd own = step.topLeftCorner(n, n);
  Eigen::MatrixXd inputs(n, 2);
  inputs << step.block(0, n + drive_place, n, 1), step.block(0, n + spool_place, n, 1);
  const double driver_rate = -std::log(step(s_current, s_current)) / interval;
  std::vector<Response> out;
  for (int k = 0; k < frequencies; ++k) {
    const Complex jw(0, two_pi * frequency_at(k)), z = std::exp(jw * interval);
    const Complex held = (1.0 - 1.0 / z) / (jw * interval);  // the step takes its input as held
    const Eigen::MatrixXcd x =
        (z * Eigen::MatrixXcd::Identity(n, n) - own.cast<Complex>()).partialPivLu().solve(inputs.cast<Complex>()) /
        held;
    const Complex driver = 1.0 / (1.0 + jw / driver_rate);
    out.push_back({x(s_x_spool, 0) * driver, x(s_x_piston, 0) * driver, x(s_x_spool, 1), x(s_x_piston, 1)});
  }
  return out;
}

std::vector<PositionLoop::Response> PositionLoop::moving(const ParameterVector& candidate, double amplitude) const {
  const double half_backlash = 0.5 * candidate[row::valve_glitch];
  std::vector<Response> r = responses(candidate, left_by_dead_zone(half_backlash, amplitude));
  const Complex per_travel(0, 4 * candidate[row::spool_friction] / (std::numbers::pi * amplitude));
  const double flow = over_null_slope(candidate, amplitude);
  for (Response& at : r) {
    const Complex spool = at.spool_per_current / (1.0 + per_travel * at.spool_per_force);
    at.piston_per_current = flow * (at.piston_per_current - at.piston_per_force * per_travel * spool);
    at.spool_per_current = spool;
  }
  return r;
}

// The worst of all crossings: a resonance may bring the loop to one a second time.
Margins PositionLoop::margins_of(const std::vector<Response>& responses) const {
  constexpr double endless = std::numeric_limits<double>::infinity();
  Margins m{endless, 0, 180, 0};
  std::vector<Complex> loop;
  for (int k = 0; k < frequencies; ++k)
    loop.push_back(gain_ * responses[static_cast<std::size_t>(k)].piston_per_current *
                   std::exp(Complex(0, -two_pi * frequency_at(k) * delay_)));
  for (int k = 1; k < frequencies; ++k) {
    const Complex a = loop[static_cast<std::size_t>(k - 1)], b = loop[static_cast<std::size_t>(k)];
    const auto at = [&](double part) {
      return frequency_at(k - 1) * std::pow(frequency_at(k) / frequency_at(k - 1), part);
    };
    if (a.imag() * b.imag() < 0 && a.real() + b.real() < 0) {
      const double part = crossing(a.imag(), b.imag());
      const double gain = -20 * std::log10(std::abs(a + part * (b - a)));
      if (gain < m.gain) m.gain = gain, m.gain_frequency = at(part);
    }
    const double log_a = std::log(std::abs(a)), log_b = std::log(std::abs(b));
    if (log_a * log_b < 0) {
      const double part = crossing(log_a, log_b);
      const double phase = std::arg(-(a + part * (b - a))) * 360 / two_pi;
      if (phase < m.phase) m.phase = phase, m.phase_frequency = at(part);
    }
  }
  return m;
}

Margins PositionLoop::margins(const ParameterVector& candidate, double amplitude) const {
  return margins_of(moving(candidate, amplitude));
}

std::optional<LimitCycle> PositionLoop::limit_cycle(const ParameterVector& candidate, double largest) const {
  const double least = std::max(0.5 * candidate[row::valve_glitch], least_cycle) * beyond_backlash;
  if (!(largest > least)) return {};
  const auto gain_at = [&](double amplitude) { return margins(candidate, amplitude).gain; };
  double stable = largest;
  if (gain_at(stable) < 0) return {};  // it grows beyond what is asked for
  double cycling = 0;
  for (int k = 1; k <= cycles_scanned && cycling == 0; ++k) {
    const double amplitude = largest * std::pow(least / largest, k / static_cast<double>(cycles_scanned));
    (gain_at(amplitude) < 0 ? cycling : stable) = amplitude;
  }
  if (cycling == 0) return {};
  for (int k = 0; k < cycle_halvings; ++k) {
    const double middle = std::sqrt(stable * cycling);
    (gain_at(middle) < 0 ? cycling : stable) = middle;
  }
  const std::vector<Response> r = moving(candidate, cycling);
  const double f = margins_of(r).gain_frequency;
  const auto k =
      static_cast<std::size_t>(std::lround((frequencies - 1) * std::log(f / lowest) / std::log(highest / lowest)));
  return LimitCycle{f, cycling, cycling * std::abs(r[k].piston_per_current / r[k].spool_per_current)};
}

double judged_amplitude(const Table& tuned, const Supply& at) {
  const MonitorParameters m = monitor_parameters(tuned, at);
  return judged_share * at.rated_current * m.motor_gain / m.wire_stiffness;
}

std::optional<double> severity_at_margin(const PositionLoop& loop, const Fault& fault, MarginKind kind, double wanted,
                                         double amplitude) {
  const auto to_spare = [&](double severity) {
    ParameterVector worn = loop.healthy();
    fault.apply(worn.data(), severity);
    const Margins m = loop.margins(worn, amplitude);
    return (kind == MarginKind::gain ? m.gain : m.phase) - wanted;
  };
  const auto severity_of = [&](double part) { return severity_between(fault, fault.healthy, fault.worst, part); };
  for (int k = 1; k <= severities_scanned; ++k) {
    double good = (k - 1.0) / severities_scanned, bad = k / static_cast<double>(severities_scanned);
    if (to_spare(severity_of(bad)) >= 0) continue;
    for (int i = 0; i < severity_halvings; ++i) {
      const double middle = 0.5 * (good + bad);
      (to_spare(severity_of(middle)) < 0 ? bad : good) = middle;
    }
    return severity_of(0.5 * (good + bad));
  }
  return {};
}

}  // namespace servodx
