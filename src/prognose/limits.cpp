#include "prognose/limits.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "fit/nominal.h"
#include "parameters/list.h"
#include "prognose/check_name.h"
#include "prognose/monitor.h"
#include "prognose/trend_options.h"

namespace servodx {
namespace {

constexpr std::array<std::pair<LimitKind, const char*>, 4> names = {{{LimitKind::bandwidth, "bandwidth"},
                                                                     {LimitKind::gain, "gain"},
                                                                     {LimitKind::hysteresis, "hysteresis"},
                                                                     {LimitKind::phase_margin, "phase_margin"}}};
const Place where{.file = "--limit"};
constexpr const char* known = "use bandwidth=0.5, gain=0.5, hysteresis=0.04 or phase_margin=45";

// Blocked fraction of the filter at which the first stage has `part` of its bandwidth: it goes with the root of the
// pilot pressure, and filter, orifice and nozzle share the supply in series.
double blockage_for(const Table& tuned, double part) {
  const double curtain = nominal::cd_nozzle * tuned[row::hydraulic_amplifier_gain].nominal;
  const double orifice =
      nominal::cd_orifice * std::numbers::pi / 4 * std::pow(tuned[row::fixed_orifice_diameter].nominal, 2);
  const double nozzle = std::pow(orifice / (curtain * tuned[row::nozzle_gap].nominal), 2);
  const double clean = 1 / std::pow(nominal::clean_filter_area_ratio, 2);
  const double filter = (1 + nozzle + clean) / (part * part) - 1 - nozzle;
  return 1 - 1 / (nominal::clean_filter_area_ratio * std::sqrt(filter));
}

Supply supply_of(const Table& tuned) {
  constexpr double rated = 0.02;  // [A] of the table's valve
  return {tuned[row::supply_pressure].nominal, tuned[row::return_pressure].nominal, {}, rated};
}

// A part lies between 0 and 1, a phase margin between 0 and 90 deg.
void require_range(const PerformanceLimit& limit) {
  const double most = limit.kind == LimitKind::phase_margin ? 90 : 1;
  if (!(limit.value > 0 && limit.value < most)) throw InputError(where, "'" + limit.text + "' is out of range", known);
}

void add_gain(double part, const Table& tuned, TrendSettings& options) {
  options.failure[CheckName::of_row(row::torque_motor_gain)] = {part * tuned[row::torque_motor_gain].nominal,
                                                                std::nullopt};
  options.failure_ratio[CheckName::of_fidelity()] = 1 / part;
}

void add_hysteresis(double part, const Table& tuned, TrendSettings& options) {
  const Supply at = supply_of(tuned);
  const MonitorParameters m = monitor_parameters(tuned, at);
  const double force = part * at.rated_current * m.motor_gain;  // [N] at the flapper
  options.failure[CheckName::of_row(row::valve_glitch)] = {std::nullopt, force / m.wire_stiffness};
  options.failure[CheckName::of_row(row::spool_friction)] = {std::nullopt, force / (2 * m.spool_force_gain)};
}

void add_bandwidth(double part, const Table& tuned, TrendSettings& options) {
  options.failure[CheckName::of_row(row::filter_blockage_positive)] = {std::nullopt, blockage_for(tuned, part)};
  options.failure_ratio[CheckName::of_fidelity()] = fidelity_of_slower(1 / part);
}

// Part of the bandwidth at which the position loop keeps a phase margin [deg].
double part_of_bandwidth(double margin, const Table& tuned, double loop) {
  if (!(loop > 0)) throw InputError(where, "a phase margin needs the position loop's velocity gain", "--loop 15");
  const MonitorParameters m = monitor_parameters(tuned, supply_of(tuned));
  const double bandwidth = m.first_stage_gain * m.wire_stiffness / m.flapper_stiffness;  // [1/s]
  const double part = loop / std::tan((90 - margin) * std::numbers::pi / 180) / bandwidth;
  if (!(part > 0 && part < 1))
    throw InputError(where, "the healthy valve does not hold this phase margin", "check --loop, or ask for less");
  return part;
}

}  // namespace

double fidelity_of_slower(double slower) {
  double cross = 0, square = 0;
  constexpr int steps = 3000;
  for (int k = 0; k < steps; ++k) {
    const double u = 3.0 * (k + 0.5) / steps;  // 95 % at three time constants
    const double model = -std::expm1(-u), spool = -std::expm1(-u / slower);
    cross += model * spool, square += spool * spool;
  }
  return cross / square;
}

PerformanceLimit read_limit(const std::string& text) {
  const auto equals = text.find('=');
  const auto value = equals == std::string::npos ? std::nullopt : parse_number(text.substr(equals + 1));
  if (!value) throw InputError(where, "'" + text + "' is not NAME=VALUE", known);
  const std::string name = text.substr(0, equals);
  for (const auto& [kind, called] : names)
    if (name == called) return {kind, *value, text};
  throw InputError(where, "unknown limit '" + name + "'", known);
}

void add_limit(const PerformanceLimit& limit, const Table& tuned, double loop, TrendSettings& options) {
  require_range(limit);
  switch (limit.kind) {
    case LimitKind::gain:
      return add_gain(limit.value, tuned, options);
    case LimitKind::hysteresis:
      return add_hysteresis(limit.value, tuned, options);
    case LimitKind::bandwidth:
      return add_bandwidth(limit.value, tuned, options);
    case LimitKind::phase_margin:
      return add_bandwidth(part_of_bandwidth(limit.value, tuned, loop), tuned, options);
  }
}

}  // namespace servodx
