#include "fit/error_model.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/support.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

std::vector<double> white(std::size_t n, unsigned seed) {
  Random random(seed);
  std::vector<double> x(n);
  for (double& v : x) v = random.normal();
  return x;
}

TEST(ErrorModel, WhiteNoiseIsIndependentSampleBySample) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const double fraction = effective_fraction(white(4000, seed));
    // The sum over lags ends at the first negative pair; of white noise it holds a few that are positive by chance.
    EXPECT_GT(fraction, 0.8) << seed;
    EXPECT_LE(fraction, 1.0) << seed;
  }
}

TEST(ErrorModel, EffectiveFractionOfAutoregressionIsItsTheory) {
  // x_k = a x_(k-1) + e_k: integrated autocorrelation time (1 + a) / (1 - a).
  for (double a : {0.5, 0.9, 0.97}) {
    double mean = 0;
    constexpr int seeds = 20;
    for (unsigned seed = 0; seed < seeds; ++seed) {
      std::vector<double> x = white(8000, 100 + seed);
      for (std::size_t k = 1; k < x.size(); ++k) x[k] += a * x[k - 1];
      mean += effective_fraction(x) / seeds;
    }
    const double theory = (1 - a) / (1 + a);
    std::printf("AR(1) %.2f: effective fraction %.4f, theory %.4f\n", a, mean, theory);
    EXPECT_NEAR(mean, theory, 0.2 * theory) << a;
  }
}

TEST(ErrorModel, MissingSamplesAndScaleDoNotCount) {
  std::vector<double> x = white(2000, 5);
  for (std::size_t k = 1; k < x.size(); ++k) x[k] += 0.8 * x[k - 1];
  const double fraction = effective_fraction(x);
  std::vector<double> scaled = x, with_gaps;
  for (double& v : scaled) v *= 1024;
  for (double v : x) with_gaps.push_back(v), with_gaps.push_back(std::nan(""));
  EXPECT_EQ(effective_fraction(scaled), fraction);
  EXPECT_EQ(effective_fraction(with_gaps), fraction);
}

TEST(ErrorModel, ActivityOfARampIsItsTravelInAMillisecond) {
  std::vector<double> time, x, still;
  for (int k = 0; k < 400; ++k) time.push_back(1e-3 * k), x.push_back(0.02 * k), still.push_back(7.0);
  EXPECT_NEAR(activity(time, x).back(), 0.02, 1e-6);
  EXPECT_EQ(activity(time, still).back(), 0.0);
  // The same motion sampled twice as densely is as lively.
  std::vector<double> dense_time, dense;
  for (int k = 0; k < 800; ++k) dense_time.push_back(0.5e-3 * k), dense.push_back(0.01 * k);
  EXPECT_NEAR(activity(dense_time, dense).back(), 0.02, 1e-6);
}

TEST(ErrorModel, ALogTakenTwiceAsFastTellsNoMoreOfTheModelsError) {
  const ChannelError error{Signal::spool_position, 4.0, 6.0, 40.0};
  const auto told = [&](double rate) {
    std::vector<double> time;
    for (int k = 0; k <= 2 * static_cast<int>(rate); ++k) time.push_back(k / rate);
    return effective_of(&error, time) * static_cast<double>(time.size());
  };
  EXPECT_NEAR(told(2000), told(1000), 0.1);
  EXPECT_NEAR(told(20), 41, 1e-9);  // no sample counts twice
}

TEST(ErrorModel, SigmaIsTheRootOfTheSumOfSquares) {
  const ChannelError error{Signal::spool_position, 4.0, 6.0, 1.0};
  EXPECT_EQ(sigma_of(&error, 3.0, {0.0, 2.0}), (std::vector<double>{5.0, 13.0}));
  EXPECT_EQ(sigma_of(nullptr, 3.0, {0.0, 2.0}), (std::vector<double>{3.0, 3.0}));
}

TEST(ErrorModel, LearnsTheFloorThatWasAdded) {
  // The model writes the log, and white noise of four times what the log's differences would say is added as
  // the model's own error: floor^2 + noise^2 = (4 noise)^2 + noise^2.
  const Table table = shipped_table();
  const ParameterVector truth = candidate_of(table);
  const LogData shipped = slice(shipped_data("healthy/h12_mixed"), 0, 2000);
  LogData log = written_by_model(shipped, truth, 3, std::sqrt(17.0));
  for (FitChannel& c : log.channels) c.noise /= std::sqrt(17.0);
  const FitProblem problem({&log}, truth, {free_row(table, row::driver_bandwidth)});
  const ErrorModel model = learn_error_model(problem, problem.start());
  ASSERT_EQ(model.channels.size(), log.channels.size());
  for (const FitChannel& c : log.channels) {
    const ChannelError* e = model.find(c.signal);
    ASSERT_NE(e, nullptr);
    EXPECT_NEAR(e->floor / c.noise, 4.0, 0.4) << info(c.signal).name;
    // White, but for the piston: its filter drags the noise of the first sample along.
    EXPECT_TRUE(effective_of(e, log.scenario.time) > 0.7 || c.signal == Signal::piston_position) << info(c.signal).name;
  }
}

TEST(ErrorModel, LogsThatAlwaysMoveLeaveAFloorForOneThatRests) {
  // The error is all in proportion to the activity, and nothing rests: such logs say nothing of the floor.
  const Table table = shipped_table();
  const ParameterVector truth = candidate_of(table);
  LogData log = slice(shipped_data("healthy/h04_multisine"), 500, 2500);
  SimulateOptions o;
  o.wanted.fill(true);
  const Trajectory t = simulate(log.scenario, truth, o);
  Random random(5);
  for (FitChannel& c : log.channels) {
    c.measured = t.signals[c.simulated];
    const std::vector<double> act = activity(log.scenario.time, c.measured);
    for (std::size_t k = 0; k < act.size(); ++k) c.measured[k] += act[k] * random.normal();
    c.noise = 1e-6 * std::abs(c.measured.front()) + 1e-12;
  }
  const FitProblem problem({&log}, truth, {free_row(table, row::driver_bandwidth)});
  const ErrorModel model = learn_error_model(problem, problem.start());
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    const ChannelError& e = *model.find(log.channels[c].signal);
    std::vector<double> r = problem.raw_residual(0, static_cast<int>(c), t);
    double sum = 0;
    for (double x : r) sum += x * x;
    const double rms = std::sqrt(sum / static_cast<double>(r.size()));
    std::printf("%s: floor %.3g of the rms, per activity %.2f\n", std::string(info(e.signal).name).c_str(),
                e.floor / rms, e.per_activity);
    EXPECT_GT(e.floor / rms, 1e-3) << info(e.signal).name;
    EXPECT_NEAR(e.per_activity, 1.0, 0.25) << info(e.signal).name;
  }
}

TEST(ErrorModel, ALogThatTheModelFitsBadlyCountsForLessAndTheOthersForMore) {
  // Two logs that the model writes; one has three times the white noise that its sensors are said to have.
  const Table table = shipped_table();
  const ParameterVector truth = candidate_of(table);
  const LogData shipped = slice(shipped_data("healthy/h12_mixed"), 0, 2000);
  const LogData good = written_by_model(shipped, truth, 3);
  LogData bad = written_by_model(shipped, truth, 4, 3.0);
  for (FitChannel& c : bad.channels) c.noise /= 3.0;
  FitProblem problem({&good, &bad}, truth, {free_row(table, row::driver_bandwidth)});
  const Point x = problem.start();
  const ErrorModel pooled = learn_error_model(problem, x);
  const auto whitened = [&](bool each_log) {
    apply_error_model(problem, pooled, x, each_log);
    const Eigen::VectorXd r = problem.evaluate(std::span(&x, 1)).front().residual;
    // Both logs have the same channels and samples; priors follow.
    const long n = static_cast<long>(good.channels.size() * good.scenario.time.size());
    return std::pair{r.head(n).squaredNorm(), r.segment(n, n).squaredNorm()};
  };
  const auto [good_pooled, bad_pooled] = whitened(false);
  const auto [good_own, bad_own] = whitened(true);
  std::printf("bad over good log: pooled %.2f, each with its own variance %.2f\n", bad_pooled / good_pooled,
              bad_own / good_own);
  EXPECT_GT(bad_pooled / good_pooled, 4.0);
  EXPECT_NEAR(bad_own / good_own, 1.0, 0.3);
}

// What four runs of one programme leave of the log-likelihood over what one does, beside an error of the model that is
// so many times each sensor's noise.
double four_over_one(double error_over_noise, int alike) {
  const Table table = shipped_table();
  const ParameterVector truth = candidate_of(table);
  const LogData shipped = slice(shipped_data("healthy/h12_mixed"), 0, 2000);
  std::vector<LogData> logs;
  for (unsigned seed : {3, 4, 5, 6}) logs.push_back(written_by_model(shipped, truth, seed));
  ErrorModel error;
  for (const FitChannel& c : logs.front().channels) error.channels.push_back({c.signal, error_over_noise * c.noise});
  const auto left = [&](std::size_t count) {
    std::vector<const LogData*> first;
    for (std::size_t l = 0; l < count; ++l) logs[l].alike = count > 1 ? alike : 1, first.push_back(&logs[l]);
    FitProblem problem(first, truth, {free_row(table, row::driver_bandwidth)});
    const Point x = problem.start();
    apply_error_model(problem, error, x);
    return problem.evaluate(std::span(&x, 1)).front().residual.head(problem.data_rows()).squaredNorm();
  };
  return left(4) / left(1);
}

// The model's error comes back in each: six runs of one test are no six witnesses of what a valve is made of. Noise is
// each run's own.
TEST(ErrorModel, RepeatsOfOneTestTellOfTheModelsErrorWhatOneOfThemTells) {
  for (const double f : {0.0, 1.0, 30.0})
    EXPECT_NEAR(four_over_one(f, 4), 4 * (1 + f * f) / (1 + 4 * f * f), 0.1) << f << " times the noise";
  EXPECT_NEAR(four_over_one(30.0, 1), 4.0, 0.1) << "four programmes";
}

}  // namespace
}  // namespace servodx
