// Fits with a known answer: the model drives itself, with true values drawn in the box and the shipped rig's noise laid
// on. Several seeds share one input. A draw whose valve sings (its run is not the same at half the step, to within the
// noise) makes data that no model owns, and is drawn again. The same fit to a log of the virtual rig has no true values
// and no known floor.
#pragma once
#include <algorithm>
#include <vector>

#include "base/random.h"
#include "optimise/problem.h"
#include "ratios/trace.h"

namespace servodx::bench {

// The first 8, 15 or 25 are free: what a servovalve engineer would free first, then what takes part.
inline const std::vector<int>& fitted_rows() {
  static const std::vector<int> rows = {
      row::torque_motor_gain, row::flapper_stiffness, row::driver_bandwidth, row::spool_friction, row::port_width,
      row::radial_clearance, row::cross_piston_leakage, row::servovalve_null,
      // 15
      row::flow_force_coefficient, row::lap_pa, row::lap_pb, row::lap_at, row::lap_bt, row::piston_viscous_friction,
      row::piston_coulomb_friction,
      // 25
      row::valve_glitch, row::fixed_orifice_diameter, row::nozzle_gap, row::hydraulic_amplifier_gain,
      row::torque_motor_frequency, row::position_sensor_lag, row::bulk_modulus, row::hose_resistance,
      row::hose_compliance, row::air_fraction};
  return rows;
}

class Twin {
 public:
  static constexpr double noise[4] = {2.5e-7, 1e-5, 8e3, 8e3};  // [m, m, Pa, Pa] as params/rigs/borello2009.toml

  Twin(int free, int seed, const Scenario& scenario, int threads) : n(free), scenario_(scenario) {
    options_.threads = threads;
    for (int c = 0; c < 4; ++c) sigma_[c] = noise[c];
    base_ = candidate_of(table());
    Point truth;
    do {
      Random random(static_cast<std::uint64_t>(seed), 7, static_cast<std::uint32_t>(redrawn++));
      truth.clear();
      for (int j = 0; j < n; ++j) truth.push_back(random.uniform(0.1, 0.9));
    } while (sings(candidate(truth)));
    --redrawn;
    const Trajectory made = simulate(scenario_, candidate(truth), options_);
    double sum = 0;
    for (int c = 0; c < 4; ++c) {
      measured_[c] = made.signals[c];
      Random laid(static_cast<std::uint64_t>(seed), 8, static_cast<std::uint32_t>(c));
      for (double& x : measured_[c]) {
        const double e = laid.normal();
        x += noise[c] * e;
        sum += e * e;
      }
    }
    floor = 0.5 * sum;
  }

  // A log with the four signals, as wrong as its sensors and one per cent of what each moves by.
  Twin(int free, const LogData& log, int threads) : n(free), scenario_(log.scenario) {
    options_.threads = threads;
    base_ = candidate_of(table());
    for (const FitChannel& channel : log.channels) {
      const int c = channel.simulated;
      if (c >= 4) continue;
      measured_[c] = channel.measured;
      const auto [low, high] = std::minmax_element(channel.measured.begin(), channel.measured.end());
      sigma_[c] = std::hypot(channel.noise, 0.01 * (*high - *low));
    }
  }

  // The table's box; the null within what a fit of a fault-free valve allows it (fit/tune.cpp).
  ParameterVector candidate(const Point& x) const {
    constexpr double null_limit = 0.1;
    ParameterVector v = base_;
    for (int j = 0; j < n; ++j) {
      const int r = fitted_rows()[j];
      v[r] = r == row::servovalve_null ? null_limit * (2 * x[j] - 1) : from_unit(table()[r], x[j]);
    }
    return v;
  }
  Evaluation whitened(const Trajectory& t) const {
    Evaluation e;
    e.ok = t.ok;
    if (!t.ok) return e;
    const auto samples = static_cast<Eigen::Index>(scenario_.time.size());
    e.residual.resize(4 * samples);
    for (int c = 0; c < 4; ++c)
      for (Eigen::Index k = 0; k < samples; ++k)
        e.residual[c * samples + k] =
            (measured_[c][static_cast<std::size_t>(k)] - t.signals[c][static_cast<std::size_t>(k)]) / sigma_[c];
    return e;
  }
  std::vector<Evaluation> evaluate(std::span<const Point> points, bool ranking = false) const {
    std::vector<ParameterVector> v;
    for (const Point& x : points) v.push_back(candidate(x));
    std::vector<Trajectory> t(points.size());
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < v.size(); ++i) jobs.push_back({&scenario_, &v[i], &t[i]});
    SimulateOptions options = options_;
    options.ranking = ranking;
    simulate(jobs, options);
    std::vector<Evaluation> out;
    for (const Trajectory& one : t) out.push_back(whitened(one));
    return out;
  }

  int n;
  double floor = 0;  // misfit of the truth, where there is one
  int redrawn = 0;   // truths that sang
  double goal() const { return 1.05 * floor; }
  const Scenario& scenario() const { return scenario_; }

 private:
  // Whether half the step moves a signal by more than its noise (rms): a valve that sings, at rest or on its way.
  bool sings(const ParameterVector& v) const {
    SimulateOptions half = options_;
    half.step /= 2, half.impact_step /= 2;
    const Trajectory a = simulate(scenario_, v, options_), b = simulate(scenario_, v, half);
    if (!a.ok || !b.ok) return true;
    for (int c = 0; c < 4; ++c) {
      double square = 0;
      for (std::size_t k = 0; k < a.signals[c].size(); ++k) square += std::pow(a.signals[c][k] - b.signals[c][k], 2);
      if (square > noise[c] * noise[c] * static_cast<double>(a.signals[c].size())) return true;
    }
    return false;
  }

  const Scenario& scenario_;
  SimulateOptions options_;
  ParameterVector base_;
  std::array<std::vector<double>, 4> measured_;
  std::array<double, 4> sigma_{};  // [m, m, Pa, Pa]
};

}  // namespace servodx::bench
