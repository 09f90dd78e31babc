// The genetic algorithm on functions whose answer is known, and its promises: determinism, resumption, honest counts.
#include "optimise/genetic.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "functions.h"
#include "optimise/box_least_squares.h"
#include "optimise/genetic_state.h"
#include "optimise/unit_cube.h"

namespace servodx::test {
namespace {

GeneticOptions long_run(std::uint64_t seed, long evaluations) {
  GeneticOptions options;
  options.seed = seed;
  options.generations = 1'000'000;
  options.max_evaluations = evaluations;
  options.cost_goal = 1e-8;
  return options;
}

struct Count {
  int solved = 0;
  long evaluations = 0;  // of the solved runs, mean
};

Count count_solved(const Function& function, int n, long limit, int seeds) {
  Count count;
  for (int seed = 1; seed <= seeds; ++seed) {
    const GeneticResult result =
        minimise_genetic(n, cost_of(function), long_run(static_cast<std::uint64_t>(seed), limit));
    EXPECT_LE(result.state.evaluations, limit);
    if (result.state.best.cost > 1e-8) continue;
    ++count.solved;
    count.evaluations += result.state.evaluations;
  }
  if (count.solved > 0) count.evaluations /= count.solved;
  std::printf("%-10s n %2d: %d of %d to 1e-8, mean %ld evaluations\n", function.name, n, count.solved, seeds,
              count.evaluations);
  return count;
}

TEST(Genetic, SolvesTenDimensionsAlone) {
  EXPECT_EQ(count_solved(sphere(10), 10, 10'000, 10).solved, 10);
  EXPECT_GE(count_solved(rosenbrock(10), 10, 60'000, 10).solved, 7);
  EXPECT_GE(count_solved(rastrigin(10), 10, 60'000, 10).solved, 7);
  EXPECT_GE(count_solved(ellipsoid(10), 10, 60'000, 10).solved, 2);
}

TEST(Genetic, SolvesTheSphereInFortyOneDimensions) { EXPECT_EQ(count_solved(sphere(41), 41, 60'000, 3).solved, 3); }

// Alone at this budget the genetic algorithm ends far off; its archive holds starts from which the local stage arrives.
TEST(Genetic, WithTheLocalStageSolvesWhatItCannotAlone) {
  constexpr int n = 41;
  for (const Function& function : {ellipsoid(n), rosenbrock(n)}) {
    int alone = 0, together = 0;
    long evaluations = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      GeneticOptions options;
      options.seed = seed;
      const GeneticResult genetic = minimise_genetic(n, cost_of(function), options);
      if (genetic.state.best.cost < 1e-8) ++alone;
      std::vector<Point> starts;
      for (const Individual& one : genetic.state.archive)
        if (starts.size() < 3) starts.push_back(one.point);
      LeastSquaresOptions local;
      local.cost_tolerance = 1e-12;
      local.max_iterations = 300;
      double best = HUGE_VAL;
      evaluations += genetic.state.evaluations;
      for (const Point& start : starts) {
        const LeastSquaresResult result = minimise_least_squares({n, residuals_of(function), {}}, start, local);
        best = std::min(best, result.misfit);
        evaluations += result.evaluations;
      }
      if (2 * best < 1e-8) ++together;
    }
    std::printf("%-10s n %d: alone %d of 5, with the local stage %d of 5, mean %ld evaluations\n", function.name, n,
                alone, together, evaluations / 5);
    EXPECT_EQ(alone, 0) << function.name;
    EXPECT_GE(together, 4) << function.name;
  }
}

// On Rastrigin the local stage inside the search polishes each basin, so that the search compares basins, not slopes.
TEST(Genetic, RefinedAsItRunsFindsRastriginsBasinInTwentyDimensions) {
  constexpr int n = 20;
  constexpr long kLimit = 40'000;
  const Function function = rastrigin(n);
  int alone = 0, refined = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    if (minimise_genetic(n, cost_of(function), long_run(seed, kLimit)).state.best.cost <= 1e-8) ++alone;
    long local_evaluations = 0;
    GeneticHooks hooks;
    hooks.refine = [&](const GeneticState& state) {
      LeastSquaresOptions local;
      local.step_limit = 0.02;
      const LeastSquaresResult result =
          minimise_least_squares({n, residuals_of(function), {}}, state.best.point, local);
      local_evaluations += result.evaluations;
      return std::vector<Individual>{{result.point, 2 * result.misfit}};
    };
    hooks.refine_every = 40;
    hooks.generation = [&](const GeneticState& state) { return state.evaluations + local_evaluations < kLimit; };
    const GeneticResult result = minimise_genetic(n, cost_of(function), long_run(seed, kLimit), {}, hooks);
    if (result.state.best.cost <= 1e-8) ++refined;
  }
  std::printf("rastrigin  n %d, %ld evaluations: alone %d of 5, refined %d of 5\n", n, kLimit, alone, refined);
  EXPECT_GE(refined, 3);
  EXPECT_GE(refined, alone);
}

TEST(Genetic, SeedPointsStartIslandsAndTheBestSeedIsNeverLost) {
  constexpr int n = 8;
  const Function function = ellipsoid(n);
  const Eigen::VectorXd at = minimiser(n);
  Point near(at.data(), at.data() + n);
  near[0] += 1e-3;
  const double seed_cost = cost_of(function)(std::vector<Point>{near})[0];
  GeneticOptions options;
  options.generations = 5;
  const GeneticResult result = minimise_genetic(n, cost_of(function), options, {{Point(n, 0.5)}, {near}});
  EXPECT_EQ(result.state.islands.size(), 2u);
  EXPECT_LE(result.state.best.cost, seed_cost);
}

TEST(Genetic, ArchiveHoldsDistinctPointsBestFirst) {
  constexpr int n = 5;
  GeneticOptions options;
  const GeneticResult result = minimise_genetic(n, cost_of(rastrigin(n)), options);
  const auto& archive = result.state.archive;
  ASSERT_GE(archive.size(), 3u);
  EXPECT_EQ(archive.front().cost, result.state.best.cost);
  for (std::size_t a = 0; a < archive.size(); ++a) {
    for (std::size_t b = a + 1; b < archive.size(); ++b) {
      EXPECT_LE(archive[a].cost, archive[b].cost);
      const double apart = (as_vector(archive[a].point) - as_vector(archive[b].point)).norm() / std::sqrt(1.0 * n);
      EXPECT_GE(apart, options.archive_distance);
    }
  }
}

TEST(Genetic, NeverLeavesTheBoxEvenWithTheMinimumInACorner) {
  bool inside = true;
  const BatchCost corner = [&](std::span<const Point> points) {
    std::vector<double> costs;
    for (const Point& p : points) {
      for (double v : p) inside = inside && v >= 0 && v <= 1;
      costs.push_back(as_vector(p).sum());
    }
    return costs;
  };
  const GeneticResult result = minimise_genetic(6, corner, {});
  EXPECT_TRUE(inside);
  EXPECT_LT(result.state.best.cost, 1e-2);
}

std::string run_with_threads(int threads, std::uint64_t seed) {
  const Function function = rastrigin(9);
  const BatchCost parallel = [&](std::span<const Point> points) {
    std::vector<double> costs(points.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (std::size_t k = 0; k < points.size(); ++k) costs[k] = function.residual(as_vector(points[k])).squaredNorm();
    return costs;
  };
  GeneticOptions options;
  options.seed = seed;
  options.stagnation = 8;  // so that fresh starts are part of it
  return to_json(minimise_genetic(9, parallel, options, {{Point(9, 0.2)}, {}, {Point(9, 0.8)}}).state);
}

TEST(Genetic, SameSeedSameBitsForAnyNumberOfThreads) {
  const std::string one = run_with_threads(1, 5);
  EXPECT_EQ(one, run_with_threads(2, 5));
  EXPECT_EQ(one, run_with_threads(7, 5));
  EXPECT_NE(one, run_with_threads(1, 6));
}

TEST(Genetic, ResumedRunEndsAsTheUninterruptedOne) {
  constexpr int n = 7;
  const BatchCost cost = cost_of(rastrigin(n));
  const std::vector<std::vector<Point>> seeds{{Point(n, 0.1)}, {Point(n, 0.9)}};
  GeneticOptions options;
  options.stagnation = 10;
  const std::string whole = to_json(minimise_genetic(n, cost, options, seeds).state);
  for (const int stop_at : {0, 1, 19, 20, 57, 99}) {
    GeneticHooks hooks;
    std::string saved;
    hooks.generation = [&](const GeneticState& state) {
      saved = to_json(state);
      return state.generation < stop_at;
    };
    const GeneticResult first = minimise_genetic(n, cost, options, seeds, hooks);
    EXPECT_EQ(first.reason, GeneticStop::interrupted);
    const GeneticState state = genetic_state_from_json(saved);
    EXPECT_EQ(state.generation, stop_at);
    EXPECT_EQ(to_json(minimise_genetic(n, cost, options, seeds, {}, &state).state), whole) << stop_at;
  }
}

TEST(Genetic, DamagedOrForeignStateIsRefusedInWords) {
  EXPECT_THROW(genetic_state_from_json("{\"format\": 3"), InputError);
  EXPECT_THROW(genetic_state_from_json("{}"), InputError);
  try {
    genetic_state_from_json(R"({"format": "servodx genetic state 2"})");
    FAIL() << "a part is missing";
  } catch (const InputError& told) {  // in the program's own words
    EXPECT_EQ(told.rule, "the saved genetic search has no 'n'");
  }
  EXPECT_THROW(genetic_state_from_json("[1, 2]"), InputError);
  GeneticOptions options;
  options.generations = 1;
  const GeneticState other = minimise_genetic(3, cost_of(sphere(3)), options).state;
  EXPECT_THROW(minimise_genetic(4, cost_of(sphere(4)), options, {}, {}, &other), InputError);
}

// A number or a list of a saved state replaced by what a damaged file may hold.
TEST(Genetic, AStateThatCannotGoOnIsRefusedNotResumed) {
  GeneticOptions options;
  options.generations = 1;
  const BatchCost cost = cost_of(sphere(3));
  const std::string good = to_json(minimise_genetic(3, cost, options).state);
  const auto resumes = [&](const char* pointer, const char* value) {
    auto json = nlohmann::json::parse(good);
    json[nlohmann::json::json_pointer(pointer)] = nlohmann::json::parse(value);
    GeneticOptions more = options;
    more.generations = 2;
    try {
      const GeneticState state = genetic_state_from_json(json.dump());
      minimise_genetic(3, cost, more, {}, {}, &state);
    } catch (const InputError&) {
      return false;
    }
    return true;
  };
  EXPECT_TRUE(resumes("/generation", "1"));
  for (const char* number : {"1180591620717411303424", "-1", "1.5", "null", "\"1\""}) {
    EXPECT_FALSE(resumes("/generation", number)) << number;
    EXPECT_FALSE(resumes("/turn", number)) << number;
    EXPECT_FALSE(resumes("/islands/0/memory_at", number)) << number;
  }
  EXPECT_FALSE(resumes("/turn", "1000000"));
  EXPECT_FALSE(resumes("/islands/0/population", "[]"));
  EXPECT_FALSE(resumes("/islands/0/population/0/point", "[0.5]"));
  EXPECT_FALSE(resumes("/islands/0/population/0/point/1", "7"));
  EXPECT_FALSE(resumes("/islands/0/population/0/cost", "null"));
  EXPECT_FALSE(resumes("/islands/0/reach", "[]"));
  EXPECT_FALSE(resumes("/islands/0/memory_at", "6"));
  EXPECT_FALSE(resumes("/best/point", "[1, 2]"));
  EXPECT_THROW(genetic_state_from_json(std::string(100000, '[')), InputError);
}

// The limits of a file from outside are not its own.
TEST(Genetic, AStateOfAMillionNumbersIsReadBack) {
  GeneticState state;
  state.n = 1000;
  state.archive.assign(1001, {Point(1000, 0.5), 1.0});
  EXPECT_EQ(genetic_state_from_json(to_json(state)).archive.size(), 1001u);
}

TEST(Genetic, FailedPointsAreCountedAndSurvived) {
  constexpr int n = 5;
  const Function function = sphere(n);
  long asked = 0, failed = 0;
  const BatchCost brittle = [&](std::span<const Point> points) {
    std::vector<double> costs;
    for (const Point& p : points) {
      ++asked;
      const bool fails = std::fmod(1000 * (p[0] + p[1]), 1.0) < 0.3;
      if (fails) ++failed;
      costs.push_back(fails ? (failed % 2 ? std::nan("") : 1e30) : function.residual(as_vector(p)).squaredNorm());
    }
    return costs;
  };
  const GeneticResult result = minimise_genetic(n, brittle, {});
  EXPECT_EQ(result.state.evaluations, asked);
  EXPECT_EQ(result.state.failed, failed);
  EXPECT_GT(failed, 100);
  EXPECT_LT(result.state.best.cost, 1e-2);
}

// Screened by a cost that is wrong in the third digit: what is returned carries the true cost, in its order, and every
// evaluation of either is counted.
TEST(Genetic, ScreenedSearchReportsTrueCostsOnly) {
  constexpr int n = 10;
  const BatchCost truth = cost_of(ellipsoid(n));
  long asked = 0, screened = 0;
  const BatchCost cost = [&](std::span<const Point> points) {
    asked += static_cast<long>(points.size());
    return truth(points);
  };
  GeneticHooks hooks;
  hooks.screen = [&](std::span<const Point> points, auto) {
    screened += static_cast<long>(points.size());
    std::vector<double> costs = truth(points);
    for (double& c : costs) c *= 1 + 1e-3 * std::sin(1e3 * c);
    return costs;
  };
  GeneticOptions options;
  options.generations = 200;
  const GeneticState state = minimise_genetic(n, cost, options, {}, hooks).state;
  EXPECT_EQ(state.evaluations, asked + screened);
  EXPECT_EQ(asked, static_cast<long>(state.archive.size()));
  EXPECT_EQ(truth(std::vector<Point>{state.best.point}).front(), state.best.cost);
  for (std::size_t k = 0; k < state.archive.size(); ++k) {
    EXPECT_EQ(truth(std::vector<Point>{state.archive[k].point}).front(), state.archive[k].cost);
    if (k > 0) {
      EXPECT_LE(state.archive[k - 1].cost, state.archive[k].cost);
    }
  }
  double least = 1e300;  // of the population, as screened
  for (const Individual& one : state.islands[0].population) least = std::min(least, one.cost);
  EXPECT_NE(least, state.best.cost);
  EXPECT_NEAR(least, state.best.cost, 3e-3 * state.best.cost);
  // It ends as low as without a screen, give or take its path: in the mean of ten runs not a digit higher.
  double digits = 0;
  for (options.seed = 1; options.seed <= 10; ++options.seed)
    digits += std::log10(minimise_genetic(n, cost, options, {}, hooks).state.best.cost /
                         minimise_genetic(n, truth, options).state.best.cost);
  std::printf("screened over plain, mean of ten: 10^%.2f\n", digits / 10);
  EXPECT_LT(digits / 10, 1.0);
}

// What comes back for a child that has lost to its parent is no cost of it, only a number above the parent's: the
// search takes the same path to the last bit, through restarts, migration and slots with two children in a wave.
TEST(Genetic, ALosingChildMayBeLeftUncountedAndNothingChanges) {
  constexpr int n = 6;
  for (const Function& function : {rastrigin(n), rosenbrock(n)}) {
    const BatchCost cost = cost_of(function);
    GeneticOptions options;
    options.generations = 150;
    options.stagnation = 4;
    options.stagnation_gain = 0.1;
    options.migrate_every = 7;
    const std::vector<std::vector<Point>> seeds = {{Point(n, 0.3)}, {}, {Point(n, 0.8)}};
    const auto end = [&](auto&& left_at) {
      GeneticHooks hooks;
      hooks.screen = [&](std::span<const Point> points, std::span<const double> bounds) {
        std::vector<double> costs = cost(points);
        EXPECT_EQ(bounds.size(), points.size());
        for (std::size_t k = 0; k < costs.size(); ++k) left_at(costs[k], bounds[k]);
        return costs;
      };
      const GeneticState state = minimise_genetic(n, cost, options, seeds, hooks).state;
      EXPECT_GT(state.restarts, 0) << function.name;
      return to_json(state);
    };
    const std::string whole = end([](double, double) {});
    long left = 0;
    const auto leave = [&](auto&& at) {
      return end([&](double& c, double bound) {
        if (!(c > bound)) return;
        ++left;
        c = at(bound);
      });
    };
    EXPECT_EQ(leave([](double bound) { return std::nextafter(bound, 1e300); }), whole) << function.name;
    EXPECT_EQ(leave([](double) { return 1e29; }), whole) << function.name;
    EXPECT_GT(left, 2 * 0.3 * 50 * 150) << function.name;
    EXPECT_NE(leave([](double bound) { return bound; }), whole) << function.name;  // a tie is the child's
  }
}

TEST(Genetic, WavesAreWholeBatchesAndServeEverySlotOnceAGeneration) {
  const Function function = sphere(4);
  for (const auto& [population, wave] : {std::pair{12, 12u}, {20, 32u}, {48, 64u}, {50, 64u}, {64, 64u}, {100, 96u}}) {
    std::vector<std::size_t> sizes;
    const BatchCost cost = [&](std::span<const Point> points) {
      sizes.push_back(points.size());
      return cost_of(function)(points);
    };
    GeneticOptions options;
    options.population = population;
    options.generations = 25;
    options.stagnation = 0;
    const GeneticState state = minimise_genetic(4, cost, options).state;
    EXPECT_EQ(state.generation, 25);
    EXPECT_EQ(sizes.front(), static_cast<std::size_t>(population));
    for (std::size_t k = 1; k + 1 < sizes.size(); ++k) EXPECT_EQ(sizes[k], wave);
    EXPECT_EQ(state.evaluations, 26L * population);
    // Every slot had its turn: nobody is as it began.
    options.generations = 0;
    const GeneticState first = minimise_genetic(4, cost_of(function), options).state;
    for (std::size_t k = 0; k < state.islands[0].population.size(); ++k)
      EXPECT_LT(state.islands[0].population[k].cost, first.islands[0].population[k].cost) << population << " " << k;
  }
}

TEST(Genetic, AllPointsFailingIsSurvived) {
  GeneticOptions options;
  options.generations = 3;
  const BatchCost hopeless = [](std::span<const Point> points) {
    return std::vector<double>(points.size(), std::numeric_limits<double>::infinity());
  };
  const GeneticResult result = minimise_genetic(3, hopeless, options);
  EXPECT_EQ(result.state.failed, result.state.evaluations);
  EXPECT_TRUE(result.state.archive.empty());
  EXPECT_EQ(to_json(genetic_state_from_json(to_json(result.state))), to_json(result.state));
}

TEST(Genetic, WrongOptionIsNamed) {
  GeneticOptions options;
  options.seeded_part = 1.5;
  try {
    minimise_genetic(3, cost_of(sphere(3)), options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("seeded_part"), std::string::npos);
  }
}

}  // namespace
}  // namespace servodx::test
