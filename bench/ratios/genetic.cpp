// The global search with its local stage on a log of 10 s, children ranked in floats and in doubles, and what a second
// thread gives it.
#include "optimise/genetic.h"

#include <fmt/format.h>

#include <thread>

#include "optimise/box_least_squares.h"
#include "ratios/measure.h"
#include "ratios/rows.h"
#include "ratios/twin.h"

namespace servodx::bench {
namespace {

constexpr int parameters = 25, most_starts = 4;

struct Search {
  double genetic = 0, local = 0, cost_over_floor = 1e300;
  int starts = 0;  // of the local stage, until one arrives
};

GeneticResult breed(const Twin& twin, int generations, bool screened) {
  GeneticOptions o;
  o.population = 50;
  o.generations = generations;
  const BatchCost cost = [&](std::span<const Point> points) { return twin.costs(points, false); };
  GeneticHooks hooks;
  if (screened) hooks.screen = [&](std::span<const Point> points) { return twin.costs(points, true); };
  return minimise_genetic(parameters, cost, o, {}, hooks);
}

Search search(const Twin& twin, bool screened) {
  Search s;
  const double begun = thread_seconds();
  const GeneticResult found = breed(twin, 100, screened);
  s.genetic = thread_seconds() - begun;
  LeastSquaresProblem problem;
  problem.n = parameters;
  problem.evaluate = [&](std::span<const Point> points) { return twin.evaluate(points); };
  LeastSquaresOptions local;
  local.difference = Difference::forward;
  local.difference_step = 1e-4;
  local.least_metric = local.from_afar;
  local.cost_goal = twin.goal();
  // From the best points that are apart, best first: the best may lie in a wrong valley.
  for (const Individual& start : found.state.archive) {
    const LeastSquaresResult end = minimise_least_squares(problem, start.point, local);
    s.cost_over_floor = std::min(s.cost_over_floor, end.misfit / twin.floor);
    if (++s.starts == most_starts || end.misfit <= twin.goal()) break;
  }
  s.local = thread_seconds() - begun - s.genetic;
  return s;
}

}  // namespace

void genetic_rows(Report& report, const Choice& choice) {
  const Scenario scenario = trace(10.0);
  const Twin alone(parameters, 1, scenario, 1), both(parameters, 1, scenario, 2);
  std::vector<double> total, total_in_doubles;
  Search last, in_doubles;
  for (int k = 0; k < std::min(3, choice.turns); ++k) {
    last = search(alone, true);
    in_doubles = search(alone, false);
    total.push_back(last.genetic + last.local);
    total_in_doubles.push_back(in_doubles.genetic + in_doubles.local);
  }
  const double seconds = median_of(total);
  report.add(
      {"genetic search 50 x 100 and local stage, 10 s log, one core", "15 s", "6 s", fmt::format("{:.1f} s", seconds),
       fmt::format("{:.1f} s of it local; ends at {:.3f} of the floor, from start {}; all in doubles {:.1f} s, at "
                   "{:.3f}, from start {}",
                   last.local, last.cost_over_floor, last.starts, median_of(total_in_doubles),
                   in_doubles.cost_over_floor, in_doubles.starts)});
  report.json["ga_plus_local_seconds_one_core"] = seconds;
  report.json["ga_plus_local"] = {
      {"genetic", last.genetic},
      {"local", last.local},
      {"cost_over_floor", last.cost_over_floor},
      {"starts", last.starts},
      {"in_doubles", {{"seconds", median_of(total_in_doubles)}, {"cost_over_floor", in_doubles.cost_over_floor}}}};

  // Wall time, so other work on the machine counts against two threads. What the machine can give at all is what two
  // searches that share nothing take side by side: a core may run slower for the other's work.
  const Twin other(parameters, 1, scenario, 1);
  const auto side_by_side = [&](bool screened) {
    std::thread beside([&] { breed(other, 8, screened); });
    breed(alone, 8, screened);
    beside.join();
  };
  const std::vector<Timing> t =
      take_turns({[&] { breed(alone, 8, true); }, [&] { breed(both, 8, true); }, [&] { side_by_side(true); },
                  [&] { breed(alone, 8, false); }, [&] { breed(both, 8, false); }, [&] { side_by_side(false); }},
                 choice.turns, wall_seconds);
  const double gain = t[0].median / t[1].median, in_doubles_gain = t[3].median / t[4].median;
  const double machine = 2 * t[0].median / t[2].median, machine_in_doubles = 2 * t[3].median / t[5].median;
  report.add({"two threads against one, on the search", "1.8x", "1.95x", fmt::format("{:.2f}x", gain),
              fmt::format("two searches side by side gain {:.2f}x; all in doubles {:.2f}x, side by side {:.2f}x",
                          machine, in_doubles_gain, machine_in_doubles)});
  report.json["ga_two_thread_speedup"] = gain;
  report.json["ga_two_thread_speedup_in_doubles"] = in_doubles_gain;
  report.json["two_searches_side_by_side"] = {{"floats", machine}, {"doubles", machine_in_doubles}};
}

}  // namespace servodx::bench
