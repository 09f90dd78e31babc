// Logs that are sampled faster than a fit steps, compared at points: the command keeps its edges, noise becomes
// less, and a fit finds what the fit of every sample finds.
#include "fit/fast_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/registry.h"
#include "effects/transport_delay.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/support.h"
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "servodx/instruction_set.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "shipped_data.h"
#include "signals/filters.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

constexpr std::array measured = {Signal::spool_position, Signal::piston_position, Signal::pressure_a,
                                 Signal::pressure_b};
constexpr std::array noise = {3e-7, 1e-5, 9e3, 9e3};  // [SI] of the shipped rig's sensors

// Edges at any sample on a sine, of 14 % of rated at most.
Log commanded(double rate, double seconds, unsigned seed = 1) {
  Log log;
  log.path = "fast.csv";
  Random random(seed);
  auto& command = log.channels[index(Signal::command)].value;
  double level = 0.1, until = 0;
  for (int k = 0; k < static_cast<int>(seconds * rate); ++k) {
    const double t = k / rate;
    if (t >= until) level = -level, until = t + random.uniform(4e-3, 30e-3);
    log.time.push_back(t);
    command.push_back(0.02 * (level + 0.04 * std::sin(2 * std::numbers::pi * 37 * t)));
  }
  for (const Signal s : measured)
    log.channels[index(s)].value.assign(log.samples(), s == Signal::pressure_a || s == Signal::pressure_b ? 1e7 : 0);
  log.channels[index(Signal::oil_temperature)].value.assign(log.samples(), 313.15);
  return log;
}

// What the model writes of it.
Log written(Log log, const ParameterVector& truth, unsigned seed = 0) {
  const Trajectory run = simulate(prepare(log, shipped_rig()).scenario, truth);
  EXPECT_TRUE(run.ok);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    Random random(seed, static_cast<std::uint32_t>(i));
    std::vector<double>& x = log.channels[index(measured[i])].value;
    x = run.signals[static_cast<std::size_t>(simulated_index(measured[i]))];
    if (seed > 0)
      for (double& v : x) v = random.normal(v, noise[i]);
  }
  return log;
}

ParameterVector nominal() { return candidate_of(shipped_table()); }

// Rms of what a run at points differs by from the run of every sample, in ranges of the signal and filtered as it is in
// fits; the largest of four.
double off_at_points(const LogData& few, const LogData& all, const ParameterVector& v) {
  const Trajectory a = simulate(few.scenario, v), b = simulate(all.scenario, v);
  EXPECT_TRUE(a.ok && b.ok);
  double worst = 0;
  for (std::size_t c = 0; c < measured.size(); ++c) {
    const std::vector<double>&x = a.signals[c], &y = b.signals[c];
    const auto [low, high] = std::minmax_element(y.begin(), y.end());
    std::vector<double> off(x.size());
    for (std::size_t k = 0, j = 0; k < x.size(); ++k) {
      while (all.scenario.time[j] < few.scenario.time[k]) ++j;
      off[k] = (x[k] - y[j]) / (*high - *low);
    }
    if (few.channels[c].filter.drift > 0) off = high_pass(few.scenario.time, off, few.channels[c].filter.drift);
    double square = 0;
    for (const double e : off) square += e * e;
    worst = std::max(worst, std::sqrt(square / static_cast<double>(x.size())));
  }
  return worst;
}

TEST(FastLog, ALogWhoseSamplesAreStepsIsTakenWhole) {
  for (const double rate : {500.0, 1000.0, 2000.0, 5000.0}) {
    const Log log = written(commanded(rate, 0.3), nominal(), 1);
    const LogData whole = prepare(log, shipped_rig()), taken = prepare_to_fit(log, shipped_rig());
    EXPECT_FALSE(taken.scenario.fast) << rate;
    EXPECT_EQ(taken.scenario.time, whole.scenario.time);
    EXPECT_EQ(taken.scenario.command, whole.scenario.command);
    for (std::size_t c = 0; c < measured.size(); ++c) EXPECT_EQ(taken.channels[c].measured, whole.channels[c].measured);
  }
}

// Built for the samples' stamps, the filter would take a point for a sample: a cutoff some twenty times lower.
TEST(FastLog, TheRigsLowPassIsTheSameAtPoints) {
  RigFile rig = shipped_rig();
  rig.facts["measurement.low_pass"] = 150;
  const Log log = commanded(20'000, 0.3);
  const LogData whole = prepare(log, rig), taken = prepare_to_fit(log, rig);
  const auto wave = [](const std::vector<double>& time) {
    std::vector<double> out;
    for (const double t : time) out.push_back(std::sin(2 * std::numbers::pi * 30 * t));
    return out;
  };
  ASSERT_TRUE(taken.scenario.fast && taken.channels.front().low_pass);
  const std::vector<double> few = taken.channels.front().shown(wave(taken.scenario.time)),
                            all = whole.channels.front().shown(wave(whole.scenario.time));
  for (std::size_t k = 0, j = 0; k < few.size(); ++k) {
    while (whole.scenario.time[j] < taken.scenario.time[k]) ++j;
    EXPECT_NEAR(few[k], all[j], 0.01) << taken.scenario.time[k] << " s";
  }
}

TEST(FastLog, PointsAreAMillisecondApartAtAnyRate) {
  for (const double rate : {6000.0, 10'000.0, 20'000.0, 50'000.0}) {
    const LogData taken = prepare_to_fit(commanded(rate, 0.3), shipped_rig());
    ASSERT_TRUE(taken.scenario.fast) << rate;
    EXPECT_EQ(taken.notes.back().kind, Note::Kind::resampled) << rate;
    const std::vector<double>& t = taken.scenario.time;
    EXPECT_NEAR(static_cast<double>(t.size()), 301, 2) << rate;
    for (std::size_t k = 1; k < t.size(); ++k) EXPECT_LE(t[k] - t[k - 1], 1e-3 + 1e-8);
    EXPECT_EQ(t.back(), commanded(rate, 0.3).time.back());
  }
}

TEST(FastLog, APointHasAThirdOfTheNoiseAndWhatIsSmoothPasses) {
  Log log = commanded(20'000, 2);
  Random random(5);
  const auto smooth = [](double t) { return 1e-4 * std::sin(2 * std::numbers::pi * 40 * t); };
  auto& spool = log.channels[index(Signal::spool_position)].value;
  auto& piston = log.channels[index(Signal::piston_position)].value;
  for (std::size_t k = 0; k < log.samples(); ++k) {
    spool[k] = random.normal(smooth(log.time[k]), 1e-6);
    piston[k] = smooth(log.time[k]);
  }
  log.channels[index(Signal::pressure_a)].value.assign(log.samples(), 1e7 / 3);
  const LogData taken = prepare_to_fit(log, shipped_rig());
  double square = 0, bias = 0;
  const std::size_t n = taken.scenario.time.size();
  for (std::size_t k = 0; k < n; ++k) {
    square += std::pow(taken.channels[0].measured[k] - smooth(taken.scenario.time[k]), 2);
    bias = std::max(bias, std::abs(taken.channels[1].measured[k] - smooth(taken.scenario.time[k])));
    EXPECT_EQ(taken.channels[2].measured[k], 1e7 / 3);
  }
  const double rms = std::sqrt(square / static_cast<double>(n));
  EXPECT_NEAR(rms, 0.33e-6, 0.02e-6);
  EXPECT_NEAR(taken.channels[0].noise, 1e-6, 0.05e-6) << "and weighs as a sample";
  EXPECT_LT(bias, 2e-3 * 1e-4) << "at the ends the parabola has one side only";
}

TEST(FastLog, APointIsOnEitherSideOfAGapAndNoMeanGoesAcross) {
  Log log = commanded(20'000, 0.3);
  auto& spool = log.channels[index(Signal::spool_position)].value;
  for (std::size_t k = 3007; k < log.samples(); ++k) log.time[k] += 0.05, spool[k] = 1e-4;
  const LogData taken = prepare_to_fit(log, shipped_rig());
  const std::vector<double>& t = taken.scenario.time;
  EXPECT_TRUE(std::find(t.begin(), t.end(), log.time[3006]) != t.end());
  EXPECT_TRUE(std::find(t.begin(), t.end(), log.time[3007]) != t.end());
  for (const double x : taken.channels[0].measured) EXPECT_TRUE(std::isnan(x) || x == 0 || x == 1e-4) << x;
}

TEST(FastLog, ARunAtPointsIsTheRunOfEverySample) {
  const Log log = written(commanded(20'000, 2), nominal());
  const LogData all = prepare(log, shipped_rig()), few = prepare_to_fit(log, shipped_rig());
  ParameterVector v = nominal();
  for (const double slope : {0.0, 0.5, 1.0}) {
    v[nuisance::command_slope] = slope;
    EXPECT_LT(off_at_points(few, all, v), 1e-3) << slope;  // as the step of fits errs
  }
  v[effect_row<MagneticHysteresis>(0)] = 0.015;
  EXPECT_LT(off_at_points(few, all, v), 1e-3) << "with hysteresis";
  v[effect_row<TransportDelay>(0)] = 0.9e-3;
  EXPECT_LT(off_at_points(few, all, v), 5e-3) << "a delay moves the steps' means";
  LogData held = few;
  held.scenario.fast = {};
  v = nominal();
  EXPECT_GT(off_at_points(held, all, v), 3 * off_at_points(few, all, v)) << "means between points lose the edges";
}

TEST(FastLog, ASliceRunsAsThatPartOfTheLog) {
  const Log log = written(commanded(20'000, 1), nominal());
  const LogData all = prepare(log, shipped_rig()), few = prepare_to_fit(log, shipped_rig());
  EXPECT_LT(off_at_points(slice(few, 500, 900), slice(all, 10'000, 18'000), nominal()), 1e-3);
}

TEST(FastLog, FollowersMoveAsRunsOfTheirOwn) {
  if (instruction_set() == "generic") GTEST_SKIP() << "no packs of floats here: followers are runs of their own";
  const LogData few = prepare_to_fit(written(commanded(20'000, 1), nominal()), shipped_rig());
  ParameterVector base = nominal();
  base[nuisance::command_slope] = 0.5;
  std::vector<ParameterVector> moved;
  for (const int at : {row::torque_motor_gain, row::driver_bandwidth, row::servovalve_null, nuisance::command_slope})
    for (int k = 1; k <= 7; ++k) {
      moved.push_back(base);
      moved.back()[static_cast<std::size_t>(at)] += 1e-3 * k * (base[static_cast<std::size_t>(at)] + 0.01);
    }
  Trajectory of_base;
  std::vector<Trajectory> near(moved.size()), own(moved.size());
  std::vector<Job> follow, alone;
  for (std::size_t k = 0; k < moved.size(); ++k) {
    follow.push_back({&few.scenario, &moved[k], &near[k]});
    alone.push_back({&few.scenario, &moved[k], &own[k]});
  }
  const NearJobs jobs{&base, follow, &of_base};
  simulate_near(std::span(&jobs, 1), {});
  simulate(alone);
  ASSERT_TRUE(of_base.ok);
  for (std::size_t k = 0; k < moved.size(); k += 7) {
    double off = 0, size = 0;
    for (std::size_t i = 0; i < of_base.signals[0].size(); ++i) {
      const double step = own[k].signals[0][i] - of_base.signals[0][i];
      off += std::pow(near[k].signals[0][i] - own[k].signals[0][i], 2), size += step * step;
    }
    EXPECT_LT(std::sqrt(off / size), 0.02) << k;
  }
}

struct Found {
  std::vector<double> value, error;
};
// Three rows of the valve and the log's own values, weighed as a model that errs by some noise for 20 ms.
Found fitted(const LogData& log) {
  const Table table = shipped_table();
  std::vector<FreeValue> free;
  for (const int at : {row::torque_motor_gain, row::port_width, row::bulk_modulus}) free.push_back(free_row(table, at));
  for (FreeValue& f : nuisance_values(log, 0, nominal(), 0.05)) free.push_back(std::move(f));
  for (FreeValue& f : start_values(log, 0)) free.push_back(std::move(f));
  FitProblem problem({&log}, nominal(), free);
  for (std::size_t c = 0; c < measured.size(); ++c) {
    const ChannelError error{measured[c], 3 * noise[c], 0, 50};
    std::vector<double> sigma = sigma_of(&error, log.channels[c].noise, std::vector<double>(log.scenario.time.size()));
    for (double& s : sigma) s /= std::sqrt(effective_of(&error, log.scenario.time));
    problem.set_sigma(0, static_cast<int>(c), std::move(sigma));
  }
  const LeastSquaresResult r = minimise_least_squares(problem.least_squares(), problem.start(), {});
  Eigen::MatrixXd jacobian;
  const Evaluation at = problem.evaluate(std::span(&r.point, 1)).front();
  EXPECT_TRUE(at.ok && problem.jacobian(r.point, at.residual, jacobian));
  const Eigen::MatrixXd covariance = covariance_of(jacobian, std::vector<char>(free.size(), 1));
  Found out;
  for (std::size_t j = 0; j < 3; ++j) {
    out.value.push_back(r.point[j]);
    out.error.push_back(std::sqrt(covariance(static_cast<long>(j), static_cast<long>(j))));
  }
  return out;
}

TEST(FastLog, AFitAtPointsFindsWhatTheFitOfEverySampleFinds) {
  ParameterVector truth = nominal();
  truth[row::torque_motor_gain] *= 0.97;
  truth[row::bulk_modulus] *= 1.05;
  const Log log = written(commanded(20'000, 1.5, 3), truth, 7);
  const Found all = fitted(prepare(log, shipped_rig())), few = fitted(prepare_to_fit(log, shipped_rig()));
  for (std::size_t j = 0; j < 3; ++j) {
    // The step of 1/3 ms, as at 1 kHz, is off by 0.09 of it on the width of the port, the noise of a start by the rest.
    EXPECT_NEAR(few.value[j], all.value[j], 0.15 * all.error[j]) << j;
    EXPECT_NEAR(few.error[j] / all.error[j], 1, 0.03) << j;
  }
}

}  // namespace
}  // namespace servodx
