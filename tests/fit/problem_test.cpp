#include "fit/problem.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "base/random.h"
#include "effects/orifice_length.h"
#include "effects/registry.h"
#include "effects/viscosity_change.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/support.h"
#include "optimise/box_least_squares.h"
#include "optimise/genetic.h"
#include "optimise/genetic_state.h"
#include "optimise/robust_loss.h"
#include "optimise/unit_cube.h"
#include "parameters/coordinate.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace {
std::size_t bytes_asked_for = 0;
}

// Counted in this program, whose tests run one at a time. Eigen asks malloc; where that cannot be watched, what C++
// asks for is.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
constexpr bool sees_eigen = true;
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) noexcept {
#pragma omp atomic
  bytes_asked_for += size;
  return __libc_malloc(size);
}
#else
constexpr bool sees_eigen = false;
void* operator new(std::size_t size) {
#pragma omp atomic
  bytes_asked_for += size;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
#endif

namespace servodx {
namespace {

TEST(Coordinate, UnitIntervalAndValueAreInverses) {
  for (const bool log_scale : {false, true}) {
    const Coordinate f{.name = "value", .unit = "-", .lower = 0.02, .upper = 5.0, .log_scale = log_scale};
    EXPECT_DOUBLE_EQ(f.from_unit(0.0), 0.02);
    EXPECT_DOUBLE_EQ(f.from_unit(1.0), 5.0);
    for (double u : {0.1, 0.5, 0.9}) EXPECT_NEAR(f.to_unit(f.from_unit(u)), u, 1e-14);
    EXPECT_EQ(f.to_unit(-1.0), 0.0);
    EXPECT_EQ(f.to_unit(9.0), 1.0);
  }
}

TEST(SharedValues, AnEffectIsLikelyOfItsTypicalSizeAndARowWithinItsBounds) {
  Table table = shipped_table();
  add_effect_rows(table, {OrificeLength::name});
  bool met = false;
  for (const FreeValue& f : shared_values(table)) {
    if (f.at < n_parameters) {
      EXPECT_EQ(f.prior_sd, 0.5) << f.name;
    }
    if (f.name != OrificeLength::parameters[0].name) continue;
    met = true;
    EXPECT_NEAR(f.prior_sd * (f.upper - f.lower), OrificeLength::parameters[0].start, 1e-12);
  }
  EXPECT_TRUE(met);
}

// Relative width of a row's prior.
double width_of(int at, const std::map<std::string, double>& facts, const std::map<std::string, double>& asked,
                const Table& table = shipped_table()) {
  RigFile rig;
  rig.facts = facts;
  std::vector<FreeValue> shared = shared_values(table);
  hold_to_sheet(shared, table, rig, asked);
  const auto f = std::find_if(shared.begin(), shared.end(), [&](const FreeValue& v) { return v.at == at; });
  return f->prior_sd * std::log(f->upper / f->lower);
}

// Else, where the load is light, it takes the place of a slower valve.
TEST(SharedValues, ThePistonsLeakIsHeldToAPartOfTheRatedFlow) {
  const auto spread = [](const std::map<std::string, double>& facts, const std::map<std::string, double>& asked) {
    RigFile rig;
    rig.facts = facts;
    const Table table = shipped_table();
    std::vector<FreeValue> shared = shared_values(table);
    hold_to_sheet(shared, table, rig, asked);
    const auto f = std::find_if(shared.begin(), shared.end(),
                                [](const FreeValue& v) { return v.at == row::cross_piston_leakage; });
    return f->prior_sd * (f->upper - f->lower);
  };
  const std::map<std::string, double> facts = {{"valve.rated_flow", 4e-4}, {"supply.pressure", 2e7}};
  EXPECT_NEAR(spread(facts, {}), 2e-13, 1e-18);
  EXPECT_GT(spread({}, {}), 2e-12);
  EXPECT_GT(spread(facts, {{"cross_piston_leakage", 1e-12}}), 2e-12);
}

// Else blunt corners take the place of a clearance in overlapped edges.
TEST(SharedValues, AClearanceIsHeldToAQuarterOfItsDrawing) {
  EXPECT_NEAR(width_of(row::radial_clearance, {{"valve.radial_clearance", 3e-6}}, {}), 0.25, 1e-12);
  EXPECT_GT(width_of(row::radial_clearance, {}, {}), 0.5);
}

TEST(SharedValues, WhatADrawingGivesOfThePilotStageIsHeldUnlessAPriorIsAskedFor) {
  const auto width = [](const std::map<std::string, double>& facts, const std::map<std::string, double>& asked) {
    return width_of(row::fixed_orifice_diameter, facts, asked);
  };
  const std::map<std::string, double> drawing = {{"valve.fixed_orifice_diameter", 0.2e-3}};
  EXPECT_NEAR(width(drawing, {}), 0.05, 1e-12);
  EXPECT_GT(width({}, {}), 0.2);
  EXPECT_GT(width(drawing, {{"fixed_orifice_diameter", 4e-6}}), 0.2);
}

// Without the spool's sensor no log tells them: a stiffness left alone stood at either bound, and a plugged nozzle was
// a shifted null.
TEST(SharedValues, WhatTheKindOfAValveSaysOfThePilotStageIsHeldToo) {
  EXPECT_NEAR(width_of(row::driver_bandwidth, {}, {}), 0.6, 1e-12);
  EXPECT_NEAR(width_of(row::spool_friction, {}, {}), 0.9, 1e-12);
  EXPECT_GT(width_of(row::spool_friction, {}, {{"spool_friction", 1.0}}), 0.9) << "another prior is asked for";
}

// Of a soft flapper, beside the wire, any stiffness gives nearly the same loop: the sheet's lag says little of it.
TEST(SharedValues, AFlappersStiffnessIsHeldAsTheLoopsGainIs) {
  const std::map<std::string, double> lag = {{"valve.phase_lag_90_frequency", 100}};
  Table table = shipped_table();
  const auto loop_width = [&](double stiffness) {
    table[row::flapper_stiffness].nominal = stiffness;
    const double wire = table[row::feedback_wire_stiffness].nominal;
    // d ln K_v / d ln k_f of K_v = G k_w / (k_f + k_w)
    return width_of(row::flapper_stiffness, lag, {}, table) * stiffness / (stiffness + wire);
  };
  EXPECT_NEAR(loop_width(20e3), loop_width(60e3), 1e-12);
  EXPECT_NEAR(loop_width(20e3), 0.4, 1e-12);
  EXPECT_GT(width_of(row::flapper_stiffness, {}, {}), 0.5) << "nothing says it";
}

// Two logs, shared rows and nuisances of each.
struct TwoLogs {
  Table table = shipped_table();
  ParameterVector truth = candidate_of(table);
  LogData a = written_by_model(slice(shipped_data("healthy/h12_mixed"), 0, 500), truth, 1);
  LogData b = written_by_model(slice(shipped_data("healthy/h10_flight"), 0, 400), truth, 2);
  std::vector<FreeValue> free() const {
    std::vector<FreeValue> f = {free_row(table, row::torque_motor_gain), free_row(table, row::piston_viscous_friction),
                                free_row(table, row::hose_compliance)};
    const LogData* logs[] = {&a, &b};
    for (int l : {0, 1})
      for (FreeValue& v : nuisance_values(*logs[l], l, truth, 0.05)) f.push_back(v);
    return f;
  }
};

TEST(FitProblem, ColumnsThatAreAskedForAreTheJacobiansAndTheOthersStay) {
  const TwoLogs logs;
  const FitProblem problem({&logs.a, &logs.b}, logs.truth, logs.free());
  const Point x = problem.start();
  const Eigen::VectorXd residual = problem.evaluate(std::span(&x, 1)).front().residual;
  Eigen::MatrixXd all;
  ASSERT_TRUE(problem.jacobian(x, residual, all));
  std::vector<char> asked(x.size(), 0);
  asked.front() = asked.back() = 1;
  Eigen::MatrixXd some = Eigen::MatrixXd::Constant(all.rows(), all.cols(), 7.0);
  const long before = problem.simulations();
  ASSERT_TRUE(problem.columns(x, residual, asked, some));
  EXPECT_LT(problem.simulations() - before, before);
  for (std::size_t j = 0; j < asked.size(); ++j) {
    const auto rows = problem.data_rows();
    const Eigen::VectorXd column = some.col(static_cast<long>(j)).head(rows);
    if (asked[j])
      EXPECT_TRUE(column == all.col(static_cast<long>(j)).head(rows)) << j;
    else
      EXPECT_TRUE((column.array() == 7.0).all()) << j;
  }
}

TEST(FitProblem, CostsAreHalfTheSquaredResidualsAsTheLossChangesThem) {
  const TwoLogs logs;
  std::vector<FreeValue> free = logs.free();
  free[1].prior_sd = 0.2;
  FitProblem problem({&logs.a, &logs.b}, logs.truth, free);
  std::vector<Point> points(5, problem.start());
  for (std::size_t k = 0; k < points.size(); ++k)
    for (std::size_t j = 0; j < points[k].size(); ++j)
      points[k][j] = 0.9 * points[k][j] + 0.1 * static_cast<double>((j + k) % 5) / 5;
  const std::vector<Evaluation> e = problem.evaluate(points);
  for (const RobustLoss loss : {RobustLoss::none, RobustLoss::compressed, RobustLoss::soft_l1}) {
    const std::vector<double> costs = problem.costs(points, loss, 3.0);
    for (std::size_t k = 0; k < points.size(); ++k) {
      double sum = 0;
      for (double r : e[k].residual) sum += std::pow(robust(loss, 3.0, r).t, 2);
      EXPECT_NEAR(costs[k], 0.5 * sum, 1e-12 * sum);
    }
  }
}

// The others come out to the last bit, and what is run does not depend on threads.
TEST(FitProblem, APointAboveItsBoundIsLeftAtThat) {
  const TwoLogs logs;
  constexpr std::size_t n = 128;
  Random random(5, 0, 0, 0);
  std::vector<Point> points(n, FitProblem({&logs.a, &logs.b}, logs.truth, logs.free()).start());
  for (Point& x : points)
    for (double& v : x) v = 0.9 * v + 0.1 * random.uniform();
  for (const bool ranking : {false, true}) {
    const std::vector<double> whole =
        FitProblem({&logs.a, &logs.b}, logs.truth, logs.free()).costs(points, RobustLoss::compressed, 3.0, ranking);
    const std::vector<double> of_first =
        FitProblem({&logs.a}, logs.truth, logs.free()).costs(points, RobustLoss::compressed, 3.0, ranking);
    // Lost after the first log, lost after the second, at the bound, far from it, unbounded.
    std::vector<double> bounds(n);
    long lost_early = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double choices[] = {0.5 * of_first[k], std::nextafter(whole[k], 0.0), whole[k], 2 * whole[k],
                                std::numeric_limits<double>::infinity()};
      bounds[k] = choices[k % 5];
      lost_early += of_first[k] > bounds[k];
    }
    ASSERT_GT(lost_early, 20);
    for (const int threads : {1, 2, 3}) {
      FitProblem problem({&logs.a, &logs.b}, logs.truth, logs.free(), {.threads = threads});
      const std::vector<double> costs = problem.costs(points, RobustLoss::compressed, 3.0, ranking, bounds);
      EXPECT_EQ(problem.simulations(), 2 * static_cast<long>(n) - lost_early);
      for (std::size_t k = 0; k < n; ++k) {
        if (whole[k] > bounds[k])
          EXPECT_GT(costs[k], bounds[k]) << k;
        else
          EXPECT_EQ(costs[k], whole[k]) << k;
      }
    }
  }
}

TEST(FitProblem, AGenerationsCostsAskForNoMemoryButTheirOwn) {
  const TwoLogs logs;
  FitProblem problem({&logs.a, &logs.b}, logs.truth, logs.free(), {.threads = 1});
  const std::vector<Point> points(48, problem.start());
  for (const bool ranking : {true, false}) {
    problem.costs(points, RobustLoss::compressed, 3.0, ranking);
    const std::size_t before = bytes_asked_for;
    const std::vector<double> costs = problem.costs(points, RobustLoss::compressed, 3.0, ranking);
    EXPECT_EQ(bytes_asked_for - before, costs.size() * sizeof(double));
  }
}

// Everything between two generations: children, costs, selection, archive, migration, islands that start afresh.
TEST(FitProblem, AGenerationOfTheSearchAsksForNoMemoryButItsCosts) {
  const TwoLogs logs;
  FitProblem problem({&logs.a, &logs.b}, logs.truth, logs.free(), {.threads = 1});
  const auto n = static_cast<std::size_t>(problem.n());
  const std::vector<std::vector<Point>> seeds = {{problem.start()}, {}};
  GeneticOptions o;
  o.population = 64;  // a wave is a generation
  o.generations = 40;
  o.stagnation = 3;
  o.stagnation_gain = 0.3;
  o.migrate_every = 2;
  GeneticHooks hooks;
  hooks.screen = [&](std::span<const Point> points, std::span<const double> bounds) {
    return problem.costs(points, RobustLoss::compressed, 3.0, true, bounds);
  };
  const BatchCost cost = [&](std::span<const Point> points) {
    return problem.costs(points, RobustLoss::compressed, 3.0);
  };
  std::vector<std::size_t> asked;
  asked.reserve(100);
  hooks.generation = [&](const GeneticState&) {
    asked.push_back(bytes_asked_for);
    return true;
  };
  const GeneticState end = minimise_genetic(problem.n(), cost, o, seeds, hooks).state;
  EXPECT_GT(end.restarts, 0);
  // Eigen takes a vector to turn the axes of each island that has children.
  const std::size_t costs = 64 * sizeof(double), eigen = sees_eigen ? seeds.size() * n * sizeof(double) : 0;
  constexpr std::size_t warm = 5;  // generations in which the archive fills
  for (std::size_t k = warm; k + 1 < asked.size(); ++k) {
    EXPECT_GE(asked[k + 1] - asked[k], costs);
    EXPECT_LE(asked[k + 1] - asked[k], costs + eigen) << k;
  }
}

TEST(FitProblem, JacobianEqualsCentralDifferences) {
  const TwoLogs logs;
  FitProblem problem({&logs.a, &logs.b}, logs.truth, logs.free());
  problem.difference_step = 1e-5;
  Point x = problem.start();
  for (std::size_t j = 0; j < x.size(); ++j) x[j] = 0.8 * x[j] + 0.05 + 0.01 * static_cast<double>(j % 7);
  const Evaluation at = problem.evaluate(std::span(&x, 1)).front();
  ASSERT_TRUE(at.ok);
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(problem.jacobian(x, at.residual, jacobian));
  ASSERT_EQ(jacobian.cols(), problem.n());
  ASSERT_EQ(jacobian.rows(), at.residual.size());
  for (int j = 0; j < problem.n(); ++j) {
    constexpr double h = 1e-5;
    std::vector<Point> sides = {x, x};
    sides[0][j] += h, sides[1][j] -= h;
    const std::vector<Evaluation> e = problem.evaluate(sides);
    ASSERT_TRUE(e[0].ok && e[1].ok);
    const Eigen::VectorXd central = (e[0].residual - e[1].residual) / (2 * h);
    ASSERT_GT(central.norm(), 0.0) << problem.free()[j].name;
    EXPECT_LT((jacobian.col(j) - central).norm(), 1e-2 * central.norm()) << problem.free()[j].name;
  }
}

TEST(FitProblem, NuisanceOfALogMovesNoOtherLog) {
  const TwoLogs logs;
  const FitProblem problem({&logs.a, &logs.b}, logs.truth, logs.free());
  const Point x = problem.start();
  const Evaluation at = problem.evaluate(std::span(&x, 1)).front();
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(problem.jacobian(x, at.residual, jacobian));
  const auto rows = [&](int log) {
    const auto channels = static_cast<int>(problem.logs()[log]->channels.size());
    const auto [first, n] = problem.rows(log, 0);
    return std::pair{first, channels * n};
  };
  for (int j = 0; j < problem.n(); ++j) {
    const int log = problem.free()[j].log;
    for (int l : {0, 1}) {
      const auto [first, n] = rows(l);
      const double moved = jacobian.col(j).segment(first, n).norm();
      if (log >= 0 && log != l)
        EXPECT_EQ(moved, 0.0) << problem.free()[j].name;
      else
        EXPECT_GT(moved, 0.0) << problem.free()[j].name << " on log " << l;
    }
  }
}

TEST(FitProblem, PriorIsARowOfTheResidual) {
  const TwoLogs logs;
  FreeValue with = free_row(logs.table, row::torque_motor_gain);
  with.prior_sd = 0.25;
  const FitProblem problem({&logs.a}, logs.truth, {with, free_row(logs.table, row::driver_bandwidth)});
  Point x = problem.start();
  x[0] += 0.1;
  const Evaluation e = problem.evaluate(std::span(&x, 1)).front();
  EXPECT_EQ(e.residual.size(), problem.data_rows() + 1);
  EXPECT_NEAR(e.residual[problem.data_rows()], 0.1 / 0.25, 1e-12);
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(problem.jacobian(x, e.residual, jacobian));
  EXPECT_DOUBLE_EQ(jacobian(problem.data_rows(), 0), 1 / 0.25);
  EXPECT_EQ(jacobian(problem.data_rows(), 1), 0.0);
}

TEST(FitProblem, PistonsOffsetIsLeftOutAndItsStepIsNot) {
  const TwoLogs logs;
  const FitProblem problem({&logs.a}, logs.truth, {free_row(logs.table, row::driver_bandwidth)});
  const Trajectory t = problem.trajectories(problem.start()).front();
  ASSERT_TRUE(t.ok);
  for (int c = 0; c < static_cast<int>(logs.a.channels.size()); ++c) {
    const FitChannel& channel = logs.a.channels[c];
    const auto change = [&](auto added) {
      Trajectory moved = t;
      std::vector<double>& x = moved.signals[channel.simulated];
      for (std::size_t k = 0; k < x.size(); ++k) x[k] -= added(k);
      std::vector<double> r = problem.raw_residual(0, c, moved);
      const std::vector<double> before = problem.raw_residual(0, c, t);
      for (std::size_t k = 0; k < r.size(); ++k) r[k] -= before[k];
      return r;
    };
    const double size = 100 * channel.noise;
    const std::vector<double> offset = change([&](std::size_t) { return size; });
    const std::vector<double> step = change([&](std::size_t k) { return k < 200 ? 0.0 : size; });
    EXPECT_NEAR(step[200] - step[199], size, 0.01 * size) << info(channel.signal).name;
    if (channel.signal == Signal::piston_position) {
      EXPECT_NEAR(offset.back(), 0.0, 1e-9 * size);
      EXPECT_LT(step.back(), 0.7 * size);  // 0.3 s later it has begun to fade
    } else {
      EXPECT_NEAR(offset.back(), size, 1e-9 * size) << info(channel.signal).name;
    }
  }
}

TEST(FitProblem, MissingSampleWeighsNothing) {
  TwoLogs logs;
  FitProblem problem({&logs.a}, logs.truth, {free_row(logs.table, row::driver_bandwidth)});
  const auto [first, n] = problem.rows(0, 0);
  logs.a.channels[0].measured[37] = std::nan("");
  const Point x = problem.start();
  const Evaluation e = problem.evaluate(std::span(&x, 1)).front();
  ASSERT_TRUE(e.ok);
  EXPECT_EQ(e.residual[first + 37], 0.0);
  EXPECT_TRUE(e.residual.allFinite());
}

TEST(FitProblem, FailedSimulationIsCountedAndNotOk) {
  const TwoLogs logs;
  FreeValue broken({.name = "broken", .unit = "Pa", .start = 0.5}, row::bulk_modulus);
  broken.apply = [](double* v, double value) { v[row::bulk_modulus] = value > 0.9 ? std::nan("") : 1.4e9; };
  const FitProblem problem({&logs.a}, logs.truth, {broken});
  const std::vector<Point> points = {{0.5}, {0.95}, {0.2}};
  const std::vector<Evaluation> e = problem.evaluate(points);
  EXPECT_TRUE(e[0].ok);
  EXPECT_FALSE(e[1].ok);
  EXPECT_TRUE(e[2].ok);
  EXPECT_EQ(problem.failed_simulations(), 1);
  EXPECT_EQ(problem.simulations(), 3);
}

// Twin experiments: the model writes the log, its noise is known, and the fit must find the values within what it says
// of its own uncertainty.
struct TwinCount {
  int total = 0, within_one = 0, within_two = 0, within_four = 0;
  double mean_square = 0;
};

// Rows of each block of the model that the log below tells apart.
const std::vector<int> twin_rows = {
    row::torque_motor_gain,       row::fixed_orifice_diameter, row::driver_bandwidth,      row::port_width,
    row::piston_viscous_friction, row::cross_piston_leakage,   row::flow_force_coefficient};

// `fit` takes the problem and returns the end of the fit, whitened as it sees fit.
template <class Write, class Fit>
TwinCount twins(unsigned seeds, const std::vector<int>& rows, Write write, Fit fit) {
  const Table table = shipped_table();
  TwinCount count;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    Random random(50 + seed);
    std::vector<FreeValue> free;
    ParameterVector truth = candidate_of(table);
    Point hidden;
    for (int r : rows) {
      free.push_back(free_row(table, r));
      hidden.push_back(random.uniform(0.3, 0.7));
      truth[r] = free.back().from_unit(hidden.back());
    }
    const LogData log = write(truth, 70 + seed);
    FitProblem problem({&log}, candidate_of(table), free);
    const LeastSquaresResult r = fit(problem);
    const Eigen::MatrixXd covariance = covariance_of(r.jacobian, std::vector<char>(rows.size(), 1));
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const double z = (r.point[j] - hidden[j]) / std::sqrt(covariance(static_cast<long>(j), static_cast<long>(j)));
      count.mean_square += z * z;
      ++count.total;
      count.within_one += std::abs(z) < 1, count.within_two += std::abs(z) < 2, count.within_four += std::abs(z) < 4;
      if (std::abs(z) >= 2) std::printf("  seed %u: %s off by %.2f deviations\n", seed, free[j].name.c_str(), z);
    }
  }
  count.mean_square /= count.total;
  std::printf("twins of %u seeds: %d of %d within one deviation, %d within two, %d within four; mean square %.2f\n",
              seeds, count.within_one, count.total, count.within_two, count.within_four, count.mean_square);
  return count;
}

LeastSquaresOptions twin_options() {
  LeastSquaresOptions o;
  o.max_iterations = 40;
  return o;
}

TEST(Twin, ValuesAreRecoveredWithinTheirStatedUncertaintyUnderWhiteNoise) {
  // Without the piston, whose filter colours its noise, the noise is white and its size known: all is exact.
  LogData inputs = slice(shipped_data("healthy/h01_steps_large"), 0, 1500);
  std::erase_if(inputs.channels, [](const FitChannel& c) { return c.signal == Signal::piston_position; });
  const TwinCount c = twins(
      5, twin_rows, [&](const ParameterVector& truth, unsigned seed) { return written_by_model(inputs, truth, seed); },
      [](FitProblem& problem) {
        const LeastSquaresResult r = minimise_least_squares(problem.least_squares(), problem.start(), twin_options());
        // As many squares as samples, to five deviations of such a sum.
        const auto n = static_cast<double>(problem.data_rows());
        EXPECT_NEAR(2 * r.misfit / n, 1.0, 5 * std::sqrt(2 / n));
        return r;
      });
  EXPECT_EQ(c.within_four, c.total);
  EXPECT_GE(c.within_two, c.total * 8 / 10);  // 95 % expected
  // 35 squares of unit normals have mean 1 with deviation 0.24.
  EXPECT_GT(c.mean_square, 0.3);
  EXPECT_LT(c.mean_square, 2.0);
}

TEST(Twin, ValuesAreRecoveredWithinTheirStatedUncertaintyAsTuneWorks) {
  // All channels, started from noisy samples; weights learnt from the residual, with its correlation.
  const LogData inputs = slice(shipped_data("healthy/h01_steps_large"), 0, 1500);
  std::vector<int> rows = twin_rows;
  rows.push_back(row::position_sensor_lag);
  const TwinCount c = twins(
      5, rows,
      [&](const ParameterVector& truth, unsigned seed) {
        const LogData log = written_by_model(inputs, truth, seed);
        return slice(log, 0, log.scenario.time.size());  // takes its start from what is measured
      },
      [](FitProblem& problem) {
        LeastSquaresResult r = minimise_least_squares(problem.least_squares(), problem.start(), twin_options());
        for (int round = 0; round < 2; ++round) {
          apply_error_model(problem, learn_error_model(problem, r.point), r.point);
          r = minimise_least_squares(problem.least_squares(), r.point, twin_options());
        }
        return r;
      });
  EXPECT_EQ(c.within_four, c.total);
  EXPECT_GE(c.within_two, c.total * 8 / 10);
  EXPECT_LT(c.mean_square, 2.5);  // the weights are learnt from the same data
}

// A log without a temperature has a viscosity of its own: found within its error, and where it is held at that of
// 40 degC the oil's part stays in the residual.
TEST(Nuisances, ViscosityIsFoundWhereNoTemperatureWasLogged) {
  const Table table = shipped_table();
  constexpr int viscosity = effect_row<ViscosityChange>(0);
  for (const double factor : {0.4, 1.0, 3.0}) {
    ParameterVector truth = candidate_of(table);
    LogData log = slice(shipped_data("healthy/h12_mixed"), 0, 1500);
    log.scenario.oil_known = false;
    ParameterVector of_oil = truth;
    for (const FreeValue& f : nuisance_values(log, 0, truth, 0.05))
      if (f.at == viscosity) f.apply(of_oil.data(), factor);
    log = written_by_model(log, of_oil, 3);
    const auto fitted = [&](bool known) {
      log.scenario.oil_known = known;
      FitProblem problem({&log}, truth, nuisance_values(log, 0, truth, 0.05));
      for (std::size_t c = 0; c < log.channels.size(); ++c)
        problem.set_sigma(0, static_cast<int>(c), log.channels[c].noise);
      return std::pair{problem, minimise_least_squares(problem.least_squares(), problem.start(), {})};
    };
    const auto [held, stiff] = fitted(true);
    const auto [free, own] = fitted(false);
    ASSERT_EQ(free.n(), held.n() + 1);
    const auto at =
        std::find_if(free.free().begin(), free.free().end(), [](const FreeValue& f) { return f.at == viscosity; }) -
        free.free().begin();
    const Eigen::MatrixXd covariance = (own.jacobian.transpose() * own.jacobian).inverse();
    const double error = std::log(
                     free.free()[static_cast<std::size_t>(at)].from_unit(own.point[static_cast<std::size_t>(at)]) /
                     factor),
                 sd = std::sqrt(covariance(at, at)) * std::log(10.0 / 0.1);
    std::printf("viscosity times %.1f: off by %.3f +- %.3f; misfit %.0f, held %.0f\n", factor, error, sd, own.misfit,
                stiff.misfit);
    EXPECT_LT(std::abs(error), 3 * sd + 0.01);
    EXPECT_LT(sd, 0.2);
    if (factor != 1.0) {
      EXPECT_GT(stiff.misfit, own.misfit + 20);
    }
  }
}

}  // namespace
}  // namespace servodx
