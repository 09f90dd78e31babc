// A fault on a log that is sampled faster than a fit steps: at points it is found as at every sample.
#include "fit/fast_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "diagnose/diagnose.h"
#include "diagnose/hypotheses.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

// Edges of 20 % of rated on a sine, at 20 kHz for 0.4 s, as the model writes it with a fault.
Log written(const ParameterVector& base, const Fault* fault, double severity) {
  constexpr std::array signals = {Signal::spool_position, Signal::piston_position, Signal::pressure_a,
                                  Signal::pressure_b};
  constexpr std::array noise = {3e-7, 1e-5, 9e3, 9e3};  // [SI]
  Log log;
  log.path = "fast.csv";
  Random random(3);
  double level = 0.1, until = 0;
  for (int k = 0; k < 8000; ++k) {
    const double t = k / 20e3;
    if (t >= until) level = -level, until = t + random.uniform(5e-3, 40e-3);
    log.time.push_back(t);
    log.channels[index(Signal::command)].value.push_back(0.02 *
                                                         (level + 0.05 * std::sin(2 * std::numbers::pi * 31 * t)));
  }
  for (const Signal s : signals)
    log.channels[index(s)].value.assign(log.samples(), s == Signal::pressure_a || s == Signal::pressure_b ? 1e7 : 0);
  log.channels[index(Signal::oil_temperature)].value.assign(log.samples(), 313.15);
  ParameterVector v = base;
  fault->apply(v.data(), severity);
  const Trajectory run = simulate(prepare(log, shipped_rig()).scenario, v);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    std::vector<double>& x = log.channels[index(signals[i])].value;
    x = run.signals[static_cast<std::size_t>(simulated_index(signals[i]))];
    for (double& value : x) value = random.normal(value, noise[i]);
  }
  return log;
}

TEST(DiagnoseFastLog, AFaultIsOfTheSameSizeAndGainAtPoints) {
  const ParameterVector base = candidate_of(shipped_table());
  const Fault* fault = find_fault("torque_motor_loss");
  const Log log = written(base, fault, 0.8);
  const LogData all = prepare(log, shipped_rig()), few = prepare_at_points(log, shipped_rig());
  ASSERT_LT(20 * few.scenario.time.size(), all.scenario.time.size() + 40);
  ErrorModel error;
  for (const FitChannel& c : all.channels) error.channels.push_back({c.signal, 5 * c.noise, 0.0, 50.0});
  HypothesisSettings settings;
  settings.pairs = false;
  settings.among = {fault};
  const HypothesisFits by_sample = fit_hypotheses({&all}, base, error, settings);
  const HypothesisFits at_points = fit_hypotheses({&few}, base, error, settings);
  const HypothesisFit &whole = by_sample.fits[1], &taken = at_points.fits[1];
  ASSERT_TRUE(whole.ok && taken.ok);
  EXPECT_NEAR(taken.point[0], whole.point[0], 0.1 * whole.standard_error[0]);
  EXPECT_NEAR(taken.standard_error[0] / whole.standard_error[0], 1, 0.1);
  const auto gain = [](const HypothesisFits& f) { return f.fits[0].misfit - f.fits[1].misfit; };
  ASSERT_GT(gain(by_sample), 20);
  EXPECT_NEAR(gain(at_points) / gain(by_sample), 1, 0.1);
}

}  // namespace
}  // namespace servodx
