// Fits with a known answer: the model drives itself, with true values drawn in the box and the shipped rig's noise laid
// on. Several seeds share one input. A draw whose valve sings (its run is not the same at half the step, to within the
// noise) makes data that no model owns, and is drawn again. The same fit to a log of the virtual rig has no true values
// and no known floor.
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "base/random.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/robust_loss.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "ratios/rows.h"
#include "ratios/trace.h"
#include "simulate/scenario.h"

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

  Twin(int free, int seed, const Scenario& scenario, int threads) : Twin(free, empty_log(scenario), threads) {
    Point truth;
    do {
      Random random(static_cast<std::uint64_t>(seed), 7, static_cast<std::uint32_t>(redrawn++));
      truth.clear();
      for (int j = 0; j < n; ++j) truth.push_back(random.uniform(0.1, 0.9));
    } while (sings(problem_.candidate(truth, 0)));
    --redrawn;
    const Trajectory made = problem_.trajectories(truth).front();
    double sum = 0;
    for (int c = 0; c < 4; ++c) {
      Random laid(static_cast<std::uint64_t>(seed), 8, static_cast<std::uint32_t>(c));
      log_->channels[c].measured = made.signals[c];
      for (double& x : log_->channels[c].measured) {
        const double e = laid.normal();
        x += noise[c] * e;
        sum += e * e;
      }
    }
    floor = 0.5 * sum;
  }

  // The four signals of a log, as wrong as its sensors and one per cent of what each moves by.
  Twin(int free, const LogData& log, int threads) : Twin(free, four_of(log), threads) {}

  std::vector<Evaluation> evaluate(std::span<const Point> points) const { return problem_.evaluate(points); }
  std::vector<double> costs(std::span<const Point> points, bool ranking) const {
    return problem_.costs(points, RobustLoss::none, 1.0, ranking);
  }

  int n;
  double floor = 0;  // misfit of the truth, where there is one
  int redrawn = 0;   // truths that sang
  double goal() const { return 1.05 * floor; }

 private:
  Twin(int free, std::shared_ptr<LogData> log, int threads)
      : n(free), log_(std::move(log)), problem_({log_.get()}, candidate_of(table()), values(free), options(threads)) {}
  static SimulateOptions options(int threads) {
    SimulateOptions o;
    o.threads = threads;
    return o;
  }

  // The table's box; the null within what a fit of a fault-free valve allows it (fit/tune.cpp).
  static std::vector<FreeValue> values(int count) {
    constexpr double null_limit = 0.1;
    std::vector<FreeValue> all;
    for (int j = 0; j < count; ++j) {
      const int r = fitted_rows()[j];
      const servodx::Row& of = table()[r];
      all.push_back({of.name, r, of.lower, of.upper, of.log_scale, 0.0});
      if (r == row::servovalve_null) all.back().lower = -null_limit, all.back().upper = null_limit;
    }
    return all;
  }

  static std::shared_ptr<LogData> empty_log(const Scenario& scenario) {
    auto log = std::make_shared<LogData>();
    log->scenario = scenario;
    for (int c = 0; c < 4; ++c)
      log->channels.push_back({simulated_signals[c], c, std::vector<double>(scenario.time.size()), noise[c], {}});
    return log;
  }
  static std::shared_ptr<LogData> four_of(const LogData& log) {
    auto four = std::make_shared<LogData>(log);
    std::erase_if(four->channels, [](const FitChannel& c) { return c.simulated >= 4; });
    for (FitChannel& c : four->channels) {
      const auto [low, high] = std::minmax_element(c.measured.begin(), c.measured.end());
      c.noise = std::hypot(c.noise, 0.01 * (*high - *low));
      c.filter = {};
    }
    return four;
  }

  // Whether half the step moves a signal by more than its noise (rms): a valve that sings, at rest or on its way.
  bool sings(const ParameterVector& v) const {
    SimulateOptions whole, half;
    half.step /= 2, half.impact_step /= 2;
    const Trajectory a = simulate(log_->scenario, v, whole), b = simulate(log_->scenario, v, half);
    if (!a.ok || !b.ok) return true;
    for (int c = 0; c < 4; ++c) {
      double square = 0;
      for (std::size_t k = 0; k < a.signals[c].size(); ++k) square += std::pow(a.signals[c][k] - b.signals[c][k], 2);
      if (square > noise[c] * noise[c] * static_cast<double>(a.signals[c].size())) return true;
    }
    return false;
  }

  std::shared_ptr<LogData> log_;
  FitProblem problem_;
};

}  // namespace servodx::bench
