#include "prognose/limits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/units.h"
#include "fit/nominal.h"
#include "prognose/monitor.h"

namespace servodx {
namespace {

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

void add_limit(const std::string& text, const Table& tuned, double loop, TrendOptions& options) {
  const auto equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const auto value = equals == std::string::npos ? std::nullopt : parse_number(text.substr(equals + 1));
  const Place where{.file = "--limit"};
  if (!value) throw InputError(where, "'" + text + "' is not NAME=VALUE", known);
  const auto within = [&](double low, double high) {
    if (!(*value > low && *value < high)) throw InputError(where, "'" + text + "' is out of range", known);
  };
  Supply at{tuned[row::supply_pressure].nominal, tuned[row::return_pressure].nominal, {}, 0.02};
  const MonitorParameters m = monitor_parameters(tuned, at);
  double part = *value;
  if (name == "gain") {
    within(0, 1);
    options.failure["parameter:3"] = {part * tuned[row::torque_motor_gain].nominal, std::nullopt};
    options.failure_ratio["fidelity"] = 1 / part;
    return;
  }
  if (name == "hysteresis") {
    within(0, 1);
    const double force = part * at.rated_current * m.motor_gain;  // [N] at the flapper
    options.failure["parameter:9"] = {std::nullopt, force / m.wire_stiffness};
    options.failure["parameter:14"] = {std::nullopt, force / (2 * m.spool_force_gain)};
    return;
  }
  if (name == "phase_margin") {
    within(0, 90);
    if (!(loop > 0)) throw InputError(where, "a phase margin needs the position loop's velocity gain", "--loop 15");
    const double bandwidth = m.first_stage_gain * m.wire_stiffness / m.flapper_stiffness;  // [1/s]
    part = loop / std::tan((90 - *value) * std::numbers::pi / 180) / bandwidth;
    if (!(part > 0 && part < 1))
      throw InputError(where, "the healthy valve does not hold this phase margin", "check --loop, or ask for less");
  } else if (name == "bandwidth") {
    within(0, 1);
  } else {
    throw InputError(where, "unknown limit '" + name + "'", known);
  }
  options.failure["parameter:1"] = {std::nullopt, blockage_for(tuned, part)};
  options.failure_ratio["fidelity"] = fidelity_of_slower(1 / part);
}

}  // namespace servodx
