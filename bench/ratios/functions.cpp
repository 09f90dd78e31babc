// Standard functions in 10 and 41 dimensions: evaluations until a cost of 1e-8, of at most 300,000. Ours twice: the
// genetic search alone, and with the local stage on its archive every ten generations, whose evaluations count.
#include "optimise/functions.h"

#include <fmt/format.h>
#include <omp.h>

#include "optimise/box_least_squares.h"
#include "optimise/genetic.h"
#include "optimise/genetic_state.h"
#include "optimise/unit_cube.h"
#include "ratios/peers.h"
#include "ratios/race.h"
#include "ratios/rows.h"

namespace servodx::bench {
namespace {

constexpr long budget = 300000;
constexpr double goal = 1e-8;
constexpr int most_seeds = 5;

struct Counted {
  test::Function function;
  long used = 0;
  std::optional<long> reached;
  double cost(const Point& x) {
    const double c = function.residual(test::as_vector(x)).squaredNorm();
    ++used;
    if (c <= goal && !reached) reached = used;
    return c;
  }
  bool over() const { return reached || used >= budget; }
};

void breed(Counted& f, int n, int seed, bool with_local) {
  GeneticOptions o;
  o.population = 100;
  o.generations = static_cast<int>(budget);
  o.seed = static_cast<std::uint64_t>(seed);
  o.cost_goal = goal;
  GeneticHooks hooks;
  hooks.generation = [&](const GeneticState&) { return !f.over(); };
  if (with_local)
    hooks.refine = [&](const GeneticState& state) {
      LeastSquaresProblem problem;
      problem.n = n;
      problem.evaluate = [&](std::span<const Point> points) {
        std::vector<Evaluation> out;
        for (const Point& x : points) {
          f.cost(x);
          out.push_back({true, f.function.residual(test::as_vector(x))});
        }
        return out;
      };
      LeastSquaresOptions local;
      local.max_iterations = 30;
      local.cost_goal = 0.5 * goal;
      std::vector<Individual> better;
      const LeastSquaresResult r = minimise_least_squares(problem, state.best.point, local);
      Individual i = state.best;
      i.point = r.point, i.cost = 2 * r.misfit;
      better.push_back(i);
      return better;
    };
  minimise_genetic(
      n,
      [&](std::span<const Point> points) {
        std::vector<double> c;
        for (const Point& x : points) c.push_back(f.cost(x));
        return c;
      },
      o, {}, hooks);
}

}  // namespace

void function_rows(Report& report, const Choice& choice) {
  const int seeds = std::min(most_seeds, choice.seeds);
  std::vector<std::string> names = {"genetic", "genetic with local stage"};
  if (choice.peer_budget > 0)
    for (const Peer& p : peers()) names.push_back(p.name);
  for (const int n : {10, 41})
    for (const auto& function : {test::sphere(n), test::ellipsoid(n), test::rosenbrock(n), test::rastrigin(n)}) {
      const auto runs = static_cast<long>(names.size()) * seeds;
      std::vector<std::optional<long>> reached(static_cast<std::size_t>(runs));
#pragma omp parallel for schedule(dynamic, 1)
      for (long i = 0; i < runs; ++i) {
        const auto who = static_cast<std::size_t>(i / seeds);
        const int seed = static_cast<int>(i % seeds) + 1;
        Counted f{function, 0, {}};
        struct Over {};
        if (who < 2)
          breed(f, n, seed, who == 1);
        else
          try {
            peers()[who - 2].run(
                n,
                [&](const Point& x) {
                  if (f.over()) throw Over{};
                  return f.cost(x);
                },
                static_cast<unsigned>(seed));
          } catch (...) {  // the budget ended, or the method gave up
          }
        reached[static_cast<std::size_t>(i)] = f.reached;
      }
      std::string line;
      for (std::size_t who = 0; who < names.size(); ++who) {
        const std::vector<std::optional<long>> of(reached.begin() + static_cast<long>(who) * seeds,
                                                  reached.begin() + static_cast<long>(who + 1) * seeds);
        const auto count = std::count_if(of.begin(), of.end(), [](const auto& u) { return u.has_value(); });
        const auto median = median_arrival(of);
        report.json["functions"][std::to_string(n)][function.name][names[who]] = {{"median", or_null(median)},
                                                                                  {"successes", count}};
        line += fmt::format("{}{} {}", line.empty() ? "" : ", ", names[who],
                            median ? fmt::format("{:.0f}", *median) : fmt::format("{} of {}", count, seeds));
      }
      report.notes.push_back(fmt::format("{} in {} dimensions, evaluations to 1e-8: {}", function.name, n, line));
      fmt::print(stderr, "  {}\n", report.notes.back());
    }
}

}  // namespace servodx::bench
