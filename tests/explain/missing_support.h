// A log that the model itself wrote at fine steps, with something known missing in it.
#pragma once
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/random.h"
#include "explain/missing.h"
#include "explain/valve.h"
#include "fit/log_data.h"
#include "parameters/list.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "signals/log.h"
#include "simulate/scenario.h"

namespace servodx {

struct Planted {
  std::function<double(double)> current = {}, force = {};  // [A], [N] of time
  double leak = 0, seal = 0;                               // [m3/s/Pa], [N] more of these rows
  std::function<void(ParameterVector&)> change = {};       // of anything else
};
struct Rehearsed {
  std::string source = SERVODX_SOURCE_DIR;
  RigFile rig = read_rig_file(source + "/data/rig.toml");
  Table table = read_table(source + "/tests/hidden/valve_1.csv");
  Log log;
  std::vector<double> force, current, flow;  // [sample] what is missing

  // Sensors that stay in the log; noise `times` that of the shipped one.
  Rehearsed(const std::string& name, const Planted& planted, const std::set<Signal>& shown, std::uint32_t seed,
            double seconds = 4)
      : log(read_log(source + "/data/" + name + ".csv", rig)) {
    std::size_t n = 0;
    while (n < log.time.size() && log.time[n] - log.time[0] < seconds) ++n;
    log.time.resize(n);
    for (Channel& c : log.channels)
      if (!c.value.empty()) c.value.resize(n);
    // A current that is added goes through the motor's memory, and is no longer what was added.
    for (Row& row : table.rows)
      if (row.name == "hysteresis_width") row.nominal = 0;
    if (!log.has(Signal::load_force)) log.channels[index(Signal::load_force)].value.assign(n, 0.0);
    const ValveSubject plain({log}, table, rig, 1, {});
    ParameterVector p = plain.candidate({}, plain.start({}), 0);
    const LogData data = plain.logs().front();
    Scenario s = data.scenario;
    p[row::cross_piston_leakage] += planted.leak, p[row::piston_coulomb_friction] += planted.seal;
    if (planted.change) planted.change(p);
    for (std::size_t k = 0; k < n; ++k) {
      const double t = s.time[k];
      force.push_back(planted.force ? planted.force(t) : 0),
          current.push_back(planted.current ? planted.current(t) : 0);
      s.load_force[k] -= force.back(), s.command[k] += current.back();
    }
    // What the torque motor gets of it: behind the driver's lag, a mean over each interval.
    double lagged = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double z = 2 * 3.14159265358979 * p[row::driver_bandwidth] * 1e-3, u = current[k], from = lagged;
      lagged = u + (from - u) * std::exp(-z);
      current[k] = u - (from - u) * std::expm1(-z) / z;
    }
    SimulateOptions fine = fine_steps();
    fine.wanted.fill(true);
    const Trajectory t = simulate(s, p, fine);
    const auto of = [&](Signal which) { return t.signals[static_cast<std::size_t>(simulated_index(which))]; };
    const std::vector<double> a = of(Signal::pressure_a), b = of(Signal::pressure_b), x = of(Signal::piston_position);
    for (std::size_t k = 0; k < n; ++k) flow.push_back(-planted.leak * (a[k] - b[k]) / s.oil.viscosity_ratio);
    if (planted.seal != 0)
      for (std::size_t k = 1; k < n; ++k) {
        const double v = (x[k] - x[k - 1]) / (s.time[k] - s.time[k - 1]);
        force[k] -= planted.seal * v / std::hypot(v, 2e-3);
      }
    for (const FitChannel& c : data.channels) {
      Channel& to = log.channels[index(c.signal)];
      if (!shown.contains(c.signal)) {
        to.value.clear();
        continue;
      }
      Random random(seed, static_cast<std::uint32_t>(c.signal));
      to.value = of(c.signal);
      for (double& v : to.value) v += random.normal(0.0, c.noise);
    }
  }
  MissingInputs missing() const {
    const ValveSubject subject({log}, table, rig, 1, {});
    return missing_inputs(subject, subject.start({}));
  }
};

inline const MissingInput& place(const MissingInputs& m, const std::string& where, const std::string& quantity) {
  for (const MissingInput& p : m.places)
    if (p.where == where && p.quantity == quantity) return p;
  throw std::runtime_error("no such place");
}
inline double rms(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x * x;
  return std::sqrt(sum / static_cast<double>(v.size()));
}
// Share of the samples where the 90 % band holds the truth.
inline double held(const MissingInput& m, const std::vector<double>& truth) {
  double in = 0;
  for (std::size_t k = 0; k + 1 < truth.size(); ++k) in += std::abs(m.value[0][k] - truth[k]) < 1.645 * m.error[0][k];
  return in / static_cast<double>(truth.size() - 1);
}

}  // namespace servodx
