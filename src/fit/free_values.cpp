#include "fit/free_values.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "effects/effect.h"
#include "effects/registry.h"
#include "effects/viscosity_change.h"
#include "fit/chart.h"
#include "fit/constants.h"
#include "fit/log_data.h"
#include "fit/log_start.h"
#include "fit/oil_of.h"
#include "fit/own_air.h"
#include "model/state.h"
#include "parameters/coordinate.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

using namespace fit_constants::freed;

std::string name_of_row(int at) { return std::string(parameter_list[static_cast<std::size_t>(at)].name); }

// Position of a table row in a candidate.
int candidate_position(const Table& table, int row) {
  if (row < n_parameters) return row;
  for (const EffectInfo& e : effect_list())
    for (std::size_t j = 0; j < e.parameters.size(); ++j)
      if (table[row].name == e.parameters[j].name) return e.first + static_cast<int>(j);
  return -1;
}

// Width of a row's weak prior, of its range: an effect is likely to be of its typical size, whose bounds have to hold
// the odd valve as well; of a row its bounds say what is likely.
double prior_width(const Row& r, int at) {
  if (at < n_parameters) return half_of_range;
  const EffectParameter& e = parameter_at(at);
  const double likely = e.likely > 0 ? e.likely : std::abs(e.start - e.off);
  return e.switches && likely > 0 ? std::min(half_of_range, likely / (r.upper - r.lower)) : half_of_range;
}

// What a drawing says, and how well it holds, relative. The motor's frequency is not held: valves answer as with half
// to four fifths of their sheet's, so the row stands for lags as well.
struct Drawing {
  int row;
  const char* fact;
  double tolerance;
};
constexpr Drawing drawings[] = {{row::hydraulic_amplifier_gain, "valve.nozzle_diameter", bores},
                                {row::fixed_orifice_diameter, "valve.fixed_orifice_diameter", bores},
                                {row::nozzle_gap, "valve.nozzle_gap", gap},
                                {row::radial_clearance, "valve.radial_clearance", clearance}};

// What no drawing states and a valve's kind says, one standard deviation of its logarithm.
struct Likely {
  int row;
  double spread;
};
constexpr Likely likely[] = {{row::driver_bandwidth, driver_bandwidth}, {row::spool_friction, spool_friction}};

bool is_stated(int row, const RigFile& rig) {
  if (row == row::port_width) return states_width(rig);
  return std::any_of(std::begin(drawings), std::end(drawings),
                     [&](const Drawing& d) { return d.row == row && rig.fact(d.fact); });
}

bool log_nuisance(int position) { return position == row::servovalve_null || position == row::air_fraction; }

}  // namespace

std::vector<FreeValue> shared_values(const Table& table) {
  std::vector<FreeValue> out;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Row& r = table.rows[i];
    const int at = candidate_position(table, static_cast<int>(i));
    if (!r.estimate || at < 0 || log_nuisance(at) || !(r.upper > r.lower)) continue;
    out.push_back({r.name, at, r.lower, r.upper, r.log_scale, r.nominal, prior_width(r, at), -1});
  }
  return out;
}

void hold_to_sheet(std::vector<FreeValue>& shared, const Table& table, const RigFile& rig,
                   const std::map<std::string, double>& asked) {
  // To so much of the row's range, in its logarithm or not.
  const auto hold = [&](int row, double spread, double widest) {
    for (FreeValue& f : shared)
      if (f.at == row && !asked.contains(f.name))
        f.prior_sd = std::min(widest, spread / (f.log_scale ? std::log(f.upper / f.lower) : f.upper - f.lower));
  };
  for (const Drawing& d : drawings)
    if (rig.fact(d.fact)) hold(d.row, d.tolerance, 1);
  for (const Likely& l : likely) hold(l.row, l.spread, half_of_range);
  if (rig.fact("valve.phase_lag_90_frequency")) {
    // K_v is as 1 / (k_f + k_w).
    const double soft = table[row::feedback_wire_stiffness].nominal / table[row::flapper_stiffness].nominal;
    hold(row::flapper_stiffness, loop_gain * (1 + soft), half_of_range);
  }
  const auto flow = rig.fact("valve.rated_flow"), supply = rig.fact("supply.pressure");
  if (flow && supply) hold(row::cross_piston_leakage, piston_leak * *flow / *supply, half_of_range);
}

bool states_width(const RigFile& rig) {
  return rig.fact("valve.spool_stroke") && (rig.fact("valve.rated_flow") || rig.fact("valve.no_load_flow"));
}

std::vector<OffDrawing> rows_off_drawing(const Table& tuned, const Table& nominal, const RigFile& rig) {
  std::vector<OffDrawing> out;
  for (int at = 0; at < n_parameters; ++at) {
    const Row& r = tuned[at];
    if (!r.estimate || !is_stated(at, rig)) continue;
    const double from_end = std::min(r.nominal - r.lower, r.upper - r.nominal);
    if (from_end <= wall_width * (r.upper - r.lower)) out.push_back({r.name, r.nominal / nominal[at].nominal});
  }
  return out;
}

double times_drawing(int row, const Table& tuned, const RigFile& rig) {
  for (const Drawing& d : drawings)
    if (const auto stated = rig.fact(d.fact); stated && d.row == row) return tuned[row].nominal / *stated;
  return 1;
}

namespace {

// Oil of a temperature that nobody measured, by how thick it is. An oil that is thicker is colder: it is stiffer too,
// and the ports pass less of it, by the root of its density.
FreeValue unknown_oil(const LogData& log, const ParameterVector& base, int l) {
  constexpr int at = effect_row<ViscosityChange>(0);
  FreeValue out{ViscosityChange::parameters[0].name,
                at,
                thinnest,
                thickest,
                true,
                std::clamp(base[at], thinnest, thickest),
                std::log(usual_factor) / std::log(thickest / thinnest),
                l};
  out.apply = [fluid = log.fluid, taken = log.scenario.oil, usual = out.start](double* candidate, double factor) {
    const Oil oil = oil_of(fluid, kelvin_where(fluid, taken.viscosity_ratio * factor / usual));
    candidate[at] = factor;
    candidate[row::bulk_modulus] *= oil.stiffness_ratio / taken.stiffness_ratio;
    candidate[row::port_width] *= std::sqrt(taken.density / oil.density);
  };
  return out;
}

}  // namespace

std::vector<FreeValue> nuisance_values(const LogData& log, int l, const ParameterVector& base, double null_limit) {
  std::vector<FreeValue> out;
  const auto has = [&](Signal s) {
    return std::any_of(log.channels.begin(), log.channels.end(), [&](const FitChannel& c) { return c.signal == s; });
  };
  const bool pressures = has(Signal::pressure_a) && has(Signal::pressure_b);
  const double null = base[row::servovalve_null];
  out.push_back({name_of_row(row::servovalve_null), row::servovalve_null, null - null_limit, null + null_limit, false,
                 null, null_spread / (2 * null_limit), l});
  const auto add = [&](int at) {
    const NuisanceInfo& n = nuisance_info(at);
    out.push_back({std::string(n.name), at, n.lower, n.upper, false, n.prior_mean, n.prior_sd, l});
  };
  if (!log.scenario.command_slope) {
    add(nuisance::command_slope);
    if (log.command_slope) {
      FreeValue& slope = out.back();
      slope.start = log.command_slope->usual;
      slope.prior_sd = std::min(slope.prior_sd, log.command_slope->spread / (slope.upper - slope.lower));
    }
  }
  if (!log.scenario.oil_known) out.push_back(unknown_oil(log, base, l));
  if (pressures)
    out.push_back({name_of_row(row::air_fraction), row::air_fraction, least_own_air, most_own_air, true, usual_air,
                   air_spread, l});
  if (has(Signal::spool_position)) add(nuisance::spool_offset);
  if (pressures) add(nuisance::pressure_a_offset), add(nuisance::pressure_b_offset);
  if (has(Signal::pilot_pressure_1)) add(nuisance::pilot_pressure_1_offset);
  if (has(Signal::pilot_pressure_2)) add(nuisance::pilot_pressure_2_offset);
  return out;
}

std::vector<FreeValue> start_values(const LogData& log, int l) {
  std::vector<FreeValue> out;
  const auto add = [&](int at, double sigma) {
    const NuisanceInfo& n = nuisance_info(at);
    if (sigma > 0)
      out.push_back(
          {std::string(n.name), at, -start_reach * sigma, start_reach * sigma, false, n.prior_mean, n.prior_sd, l});
  };
  const Scenario& s = log.scenario;
  for (const FitChannel& c : log.channels) {
    const double noise = c.noise * std::sqrt(static_cast<double>(c.filter.window));  // of one sample
    if (c.signal == Signal::spool_position) add(nuisance::spool_start, noise);
    if (c.signal == Signal::pressure_a) add(nuisance::pressure_a_start, noise);
    if (c.signal == Signal::pressure_b) add(nuisance::pressure_b_start, noise);
    if (c.signal == Signal::piston_position && s.ports == Ports::actuator)
      add(nuisance::piston_velocity_start, noise * starting_slope_error(s.time));
  }
  return out;
}

void add_effect_rows(Table& table, const std::vector<std::string>& effects) {
  for (const std::string& name : effects) {
    const auto& list = effect_list();
    const auto it = std::find_if(list.begin(), list.end(), [&](const EffectInfo& e) { return e.name == name; });
    if (it == list.end()) {
      std::string known;
      for (const EffectInfo& e : list) known += (known.empty() ? "" : ", ") + e.name;
      throw InputError({.file = "--effects"}, "'" + name + "' is not an effect that can be freed",
                       "use one of: " + known + ", or none");
    }
    for (const EffectParameter& p : it->parameters) {
      if (table.find(p.name) >= 0) continue;
      Row r;
      r.name = p.name;
      r.group = "effect:" + name;
      const bool either_side = p.lower + p.upper == 2 * p.off;  // as likely on one side of nought as on the other
      r.nominal = either_side || !p.told ? p.off : p.start;
      r.lower = p.lower;
      r.upper = p.upper;
      r.estimate = p.told;
      r.unit = p.unit;
      r.description = p.meaning;
      r.source = either_side ? "none, its sign unknown" : "typical size";
      table.rows.push_back(r);
    }
  }
}

std::optional<double> off_value(int position) {
  for (const EffectInfo& e : effect_list())
    for (std::size_t j = 0; j < e.parameters.size(); ++j)
      if (e.first + static_cast<int>(j) == position && e.parameters[j].switches) return e.parameters[j].off;
  return std::nullopt;
}

}  // namespace servodx
