#include "prognose/performance_limits.h"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "fit/nominal.h"
#include "parameters/list.h"
#include "prognose/check_name.h"
#include "prognose/constants.h"
#include "prognose/loop_margins.h"
#include "prognose/monitor.h"
#include "prognose/track.h"
#include "prognose/trend_options.h"
#include "servodx/monitor.h"
#include "simulate/scenario.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// A margin's unit says whether it is one of gain or of phase.
constexpr std::array<std::pair<LimitKind, const char*>, 5> names = {{{LimitKind::bandwidth, "bandwidth"},
                                                                     {LimitKind::gain, "gain"},
                                                                     {LimitKind::hysteresis, "hysteresis"},
                                                                     {LimitKind::phase_margin, "phase_margin"},
                                                                     {LimitKind::loop_gain_margin, "margin"}}};
const Place where{.file = "--limit"};
constexpr const char* known =
    "use bandwidth=0.5, gain=0.5, hysteresis=0.04, phase_margin=45, margin=6dB or margin=45deg";

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
  const bool phase = limit.kind == LimitKind::phase_margin || limit.kind == LimitKind::loop_phase_margin;
  const double most = phase ? 90 : limit.kind == LimitKind::loop_gain_margin ? most_gain_margin : 1;
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

void require_loop(double loop) {
  if (!(loop > 0)) throw InputError(where, "a margin needs the position loop's velocity gain", "--loop 15");
}

// Part of the bandwidth at which the position loop keeps a phase margin [deg].
double part_of_bandwidth(double margin, const Table& tuned, double loop) {
  require_loop(loop);
  const MonitorParameters m = monitor_parameters(tuned, supply_of(tuned));
  const double bandwidth = m.first_stage_gain * m.wire_stiffness / m.flapper_stiffness;  // [1/s]
  const double part = loop / std::tan((90 - margin) * std::numbers::pi / 180) / bandwidth;
  if (!(part > 0 && part < 1))
    throw InputError(where, "the healthy valve does not hold this phase margin", "check --loop, or ask for less");
  return part;
}

// Every degradation that a check tracks and that brings the margin down to the limit by itself.
void add_margin(MarginKind kind, double wanted, const Table& tuned, double loop, TrendSettings& options) {
  require_loop(loop);
  const Supply at = supply_of(tuned);
  const PositionLoop position(tuned, at, loop);
  const double amplitude = judged_amplitude(tuned, at);
  const Margins healthy = position.margins(position.healthy(), amplitude);
  if ((kind == MarginKind::gain ? healthy.gain : healthy.phase) < wanted)
    throw InputError(where, "the healthy valve does not hold this margin", "check --loop, or ask for less");
  for (const Progressive& p : progressive_faults()) {
    const auto severity = severity_at_margin(position, *p.fault, kind, wanted, amplitude);
    if (!severity) continue;  // its own level stays
    ParameterVector worn = position.healthy();
    p.fault->apply(worn.data(), *severity);
    const double level = worn[static_cast<std::size_t>(p.row)];
    OneOrTwoLevels& levels = options.failure[CheckName::of_row(p.row)];
    levels = {};
    (level > position.healthy()[static_cast<std::size_t>(p.row)] ? levels.second : levels.first) = level;
  }
}

// "6dB" or "45deg" behind `margin=`.
PerformanceLimit read_margin(const std::string& value, const std::string& text) {
  for (const auto& [unit, kind] :
       {std::pair{"dB", LimitKind::loop_gain_margin}, std::pair{"deg", LimitKind::loop_phase_margin}})
    if (value.ends_with(unit))
      if (const auto number = parse_number(value.substr(0, value.size() - std::strlen(unit))))
        return {kind, *number, text};
  throw InputError(where, "'" + text + "' has no value in dB or deg", known);
}

}  // namespace

double fidelity_of_slower(double slower) {
  double cross = 0, square = 0;
  for (int k = 0; k < fidelity_steps; ++k) {
    const double u = fidelity_span * (k + 0.5) / fidelity_steps;
    const double model = -std::expm1(-u), spool = -std::expm1(-u / slower);
    cross += model * spool, square += spool * spool;
  }
  return cross / square;
}

PerformanceLimit read_limit(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) throw InputError(where, "'" + text + "' is not NAME=VALUE", known);
  const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
  for (const auto& [kind, called] : names) {
    if (name != called) continue;
    if (kind == LimitKind::loop_gain_margin) return read_margin(value, text);
    if (const auto number = parse_number(value)) return {kind, *number, text};
    throw InputError(where, "'" + text + "' is not NAME=VALUE", known);
  }
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
    case LimitKind::loop_gain_margin:
      return add_margin(MarginKind::gain, limit.value, tuned, loop, options);
    case LimitKind::loop_phase_margin:
      return add_margin(MarginKind::phase, limit.value, tuned, loop, options);
    case LimitKind::phase_margin:
      return add_bandwidth(part_of_bandwidth(limit.value, tuned, loop), tuned, options);
  }
}

}  // namespace servodx
