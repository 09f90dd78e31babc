// Twin experiments: logs made by the identification model at a known truth, with the sensors' noise, tuned as a user
// would tune them. Shared by the test (few) and bench/twins.cpp (many).
//
// A seed draws the truth of the free rows (within 8 % of their range about nominal) and of each log's nuisances
// (from their priors); everything else stays at nominal. Inputs, stamps and noise are those of shipped logs.
#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/random.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "shipped_data.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"
#include "tune/tune.h"

namespace servodx::twins {

// The rows in the order in which they join: 8, 15 and 25 of them are the three experiments.
inline const std::vector<std::string>& rows() {
  static const std::vector<std::string> list = {"torque_motor_gain",
                                                "port_width",
                                                "spool_friction",
                                                "radial_clearance",
                                                "fixed_orifice_diameter",
                                                "driver_bandwidth",
                                                "piston_viscous_friction",
                                                "bulk_modulus",  //
                                                "lap_pa",
                                                "lap_pb",
                                                "lap_at",
                                                "lap_bt",
                                                "flapper_stiffness",
                                                "hydraulic_amplifier_gain",
                                                "piston_coulomb_friction",  //
                                                "torque_motor_frequency",
                                                "nozzle_gap",
                                                "flow_force_coefficient",
                                                "position_sensor_lag",
                                                "cross_piston_leakage",
                                                "hose_resistance",
                                                "hose_compliance",
                                                "moving_mass",
                                                "dead_volume_a",
                                                "dead_volume_b"};
  return list;
}

struct Twin {
  Table table;                // nominal, with only the experiment's rows free
  std::vector<double> truth;  // [SI] of those rows, in the order of the table
  std::vector<std::string> names;
  std::vector<Log> logs;
};

inline Log cut(Log log, std::size_t samples) {
  samples = std::min(samples, log.samples());
  log.time.resize(samples);
  for (Channel& c : log.channels)
    if (!c.value.empty()) c.value.resize(samples);
  return log;
}

// `present`: what else the truth has, by position in a candidate.
inline Twin make(int n, std::uint64_t seed, const std::vector<std::string>& shipped_logs, std::size_t samples,
                 const std::map<int, double>& present = {}) {
  constexpr double spread = 0.08;  // of the row's range, either way: a third of a gain or a clearance
  Twin twin;
  twin.table = shipped_table();
  Random random(seed, static_cast<std::uint32_t>(n));
  for (Row& row : twin.table.rows) row.estimate = false;
  ParameterVector truth = candidate_of(twin.table);
  for (const auto& [at, value] : present) truth[static_cast<std::size_t>(at)] = value;
  for (std::size_t i = 0; i < twin.table.rows.size(); ++i) {
    Row& row = twin.table.rows[i];
    if (std::find(rows().begin(), rows().begin() + n, row.name) == rows().begin() + n) continue;
    row.estimate = true;
    const double u = std::clamp(coordinate(row).to_unit(row.nominal) + random.uniform(-spread, spread), 0.02, 0.98);
    truth[i] = coordinate(row).from_unit(u);
    twin.names.push_back(row.name);
    twin.truth.push_back(truth[i]);
  }
  for (const std::string& name : shipped_logs) {
    Log log = cut(shipped_log(name), samples);
    LogData data = prepare(log, shipped_rig());
    ParameterVector v = truth;
    for (const FreeValue& f : nuisance_values(data, 0, truth, 0.1)) {
      const double u = f.name == "command_slope"
                           ? random.uniform(0.1, 0.9)
                           : std::clamp(f.to_unit(f.start) + f.prior_sd * random.normal(), 0.02, 0.98);
      v[f.at] = f.from_unit(u);
    }
    // Begin where the measured log begins, on the twin's own terms.
    const Trajectory t = simulate(data.scenario, v);
    for (const FitChannel& c : data.channels) {
      Channel& channel = log.channels[index(c.signal)];
      for (std::size_t k = 0; k < channel.value.size(); ++k)
        channel.value[k] = t.signals[c.simulated][k] + c.noise * random.normal();
      channel.resolution = 0;
    }
    log.path += " (twin)";
    twin.logs.push_back(std::move(log));
  }
  return twin;
}

inline TuneResult tuned(const Twin& twin, int threads) {
  RigFile rig = shipped_rig();
  TuneOptions options;
  options.threads = threads;
  options.effects = std::vector<std::string>{};
  options.generations = 0;  // the truth lies near nominal: breadth is not what is asked here
  Table nominal = twin.table;
  rig.facts.erase("actuator.mount_stiffness");
  const double rated = *rig.fact("valve.rated_current");
  rig.facts.clear();  // the table has the facts already, and only the experiment's rows may move
  rig.facts["valve.rated_current"] = rated;
  return tune_table(twin.logs, nominal, rig, options);
}

struct Outcome {
  std::string name;
  RowVerdict verdict = RowVerdict::bounded;
  double z = 0;  // (estimate - truth) / standard error; NaN where there is none
};

inline std::vector<Outcome> outcomes(const Twin& twin, const TuneResult& result) {
  std::vector<Outcome> out;
  for (std::size_t i = 0; i < twin.names.size(); ++i)
    for (const ParameterResult& p : result.parameters)
      if (p.name == twin.names[i]) out.push_back({p.name, p.verdict, (p.estimate - twin.truth[i]) / p.std_error});
  return out;
}

// Whether the fit states an interval that is meant to be trusted.
inline bool identifiable(const Outcome& o) {
  return std::isfinite(o.z) && o.verdict != RowVerdict::confounded && o.verdict != RowVerdict::flat;
}

}  // namespace servodx::twins
