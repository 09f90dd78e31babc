#include "fit/uncertainty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/recorder.h"
#include "fit/support.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

constexpr double null_limit = 0.1;
constexpr double quiet = 0.1;  // of the sensors' noise: over a standard error the response is then straight

// Two logs that the model wrote at where a fit starts, a few shared rows free and each log's own numbers.
struct TwoLogs {
  Table table = shipped_table();
  std::vector<LogData> data;
  FitProblem problem = made();

  FitProblem made() {
    std::vector<FreeValue> free;
    for (const int r : {row::port_width, row::driver_bandwidth, row::radial_clearance, row::lap_pa, row::lap_bt})
      free.push_back(free_row(table, r));
    for (const char* name : {"healthy/h04_multisine", "healthy/h12_mixed"}) {
      const LogData whole = prepare(shipped_log(name), shipped_rig());
      LogData log = slice(whole, 0, whole.scenario.time.size() / 3);
      ParameterVector truth = candidate_of(table);
      for (FreeValue& f : nuisance_values(log, static_cast<int>(data.size()), truth, null_limit)) {
        truth[static_cast<std::size_t>(f.at)] = f.start;
        free.push_back(std::move(f));
      }
      data.push_back(written_by_model(std::move(log), truth, 7, quiet));
    }
    std::vector<const LogData*> logs;
    for (const LogData& log : data) logs.push_back(&log);
    return {logs, candidate_of(table), free};
  }
  Eigen::MatrixXd jacobian(const Point& x) const {
    Eigen::MatrixXd j;
    EXPECT_TRUE(problem.jacobian(x, problem.evaluate(std::span(&x, 1)).front().residual, j));
    return j;
  }
  std::vector<char> inside(const Point& x) const {
    std::vector<char> out;
    for (const double u : x) out.push_back(u > 1e-6 && u < 1 - 1e-6);
    return out;
  }
};

TEST(LogsOfRows, ARowMovesWithItsOwnLogsValuesAlone) {
  const TwoLogs logs;
  const Point x = logs.problem.start();
  const Eigen::MatrixXd j = logs.jacobian(x);
  const std::vector<int> of = logs.problem.logs_of_rows();
  ASSERT_EQ(static_cast<long>(of.size()), j.rows());
  for (int k = 0; k < logs.problem.n(); ++k) {
    const int own = logs.problem.free()[static_cast<std::size_t>(k)].log;
    if (own < 0) continue;
    double mine = 0, others = 0;
    for (long r = 0; r < j.rows(); ++r) (of[static_cast<std::size_t>(r)] == own ? mine : others) += std::abs(j(r, k));
    EXPECT_GT(mine, 0) << k;
    EXPECT_EQ(others, 0) << k;
  }
}

// Where the response is smooth, wide differences along ways say what small ones by one value at a time do.
TEST(Uncertainty, ErrorsOfASmoothFitAreThoseOfItsDerivatives) {
  const TwoLogs logs;
  const Point x = logs.problem.start();
  const std::vector<char> kept = logs.inside(x);
  const Eigen::MatrixXd j = logs.jacobian(x), expected = covariance_of(j, kept);
  const Uncertainty found = uncertainty(logs.problem, x, j, kept);
  for (int k = 0; k < logs.problem.n(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (!kept[at]) {
      EXPECT_EQ(found.covariance(k, k), 0) << logs.problem.free()[at].name;
      continue;
    }
    EXPECT_NEAR(std::sqrt(found.covariance(k, k) / expected(k, k)), 1, 0.05) << logs.problem.free()[at].name;
  }
}

TEST(Uncertainty, ItsPointCostsNoMore) {
  const TwoLogs logs;
  const Point x = logs.problem.start();
  const Uncertainty found = uncertainty(logs.problem, x, logs.jacobian(x), logs.inside(x));
  const std::vector<Point> both = {x, found.point};
  const std::vector<Evaluation> runs = logs.problem.evaluate(both);
  EXPECT_LT(runs[1].residual.squaredNorm(), runs[0].residual.squaredNorm());
}

TEST(Uncertainty, WhatIsALogsOwnIsAskedOfAllLogsAtOnce) {
  const TwoLogs logs;
  const Point x = logs.problem.start();
  const Eigen::MatrixXd j = logs.jacobian(x);
  const std::vector<char> kept = logs.inside(x);
  long shared = 0, own[2] = {0, 0};
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (kept[k]) ++(logs.problem.free()[k].log < 0 ? shared : own[logs.problem.free()[k].log]);
  const long before = logs.problem.simulations();
  uncertainty(logs.problem, x, j, kept);
  const long ways = shared + std::max(own[0], own[1]), steps_down = 4;  // halved from all of the way to a tenth
  EXPECT_LE(logs.problem.simulations() - before, 2 * (1 + 2 * (2 * ways + steps_down)));
  EXPECT_LT(ways, shared + own[0] + own[1]);
}

// Standard error of a filter's blockage beside a log's own numbers. [of the unit interval]
double error_of_blockage(const LogData& log) {
  const Table table = shipped_table();
  ParameterVector base = candidate_of(table);
  base[row::filter_blockage_positive] = 0.6;
  std::vector<FreeValue> free = {free_row(table, row::filter_blockage_positive)};
  free.front().start = 0.6;
  for (FreeValue& f : nuisance_values(log, 0, base, null_limit)) free.push_back(std::move(f));
  const FitProblem problem({&log}, base, free);
  const Point x = problem.start();
  Eigen::MatrixXd j;
  EXPECT_TRUE(problem.jacobian(x, problem.evaluate(std::span(&x, 1)).front().residual, j));
  return std::sqrt(covariance_of(j, std::vector<char>(free.size(), 1))(0, 0));
}

TEST(Recorder, KnownItTellsMoreOfACloggedFilterWhereThePistonIsAllThatIsSeen) {
  const Log log = shipped_log("healthy/h04_multisine");
  const auto made = [&](const Recorder& recorder) {
    LogData out = slice(prepare(log, shipped_rig(), recorder), 0, 1500);
    std::erase_if(out.channels, [](const FitChannel& c) { return c.signal != Signal::piston_position; });
    return out;
  };
  const double alone = error_of_blockage(made({})), known = error_of_blockage(made({1, CommandSlope{0.5, 0.02}}));
  std::printf("blockage: +- %.4f alone, %.4f where the recorder is known\n", alone, known);
  EXPECT_LT(known, 0.9 * alone) << "half a sample of delay is what a slow first stage looks like";
}

}  // namespace
}  // namespace servodx
