// The global search with its local stage on a log of 10 s, children ranked by rough runs and by those of fits, and what
// a second thread gives it.
#include "optimise/genetic.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "optimise/box_least_squares.h"
#include "optimise/genetic_state.h"
#include "optimise/unit_cube.h"
#include "ratios/measure.h"
#include "ratios/rows.h"
#include "ratios/twin.h"
#include "simulate/scenario.h"

namespace servodx::bench {
namespace {

constexpr int parameters = 25, draws = 5, most_starts = 4, generations = 100;

struct Search {
  double seconds = 0, local = 0, cost_over_floor = 1e300;
  long simulations = 0;
  int starts = 0;  // of the local stage, until one arrives
  bool arrived = false;
};

GeneticResult breed(const Twin& twin, int seed, int so_many, bool screened) {
  GeneticOptions o;
  o.population = 50;
  o.generations = so_many;
  o.seed = static_cast<std::uint64_t>(seed);
  o.archive_distance = 0.2;  // half of what random points are apart: starts in other valleys than the best one's
  const BatchCost cost = [&](std::span<const Point> points) { return twin.costs(points, false); };
  GeneticHooks hooks;
  if (screened) hooks.screen = [&](std::span<const Point> points, auto) { return twin.costs(points, true); };
  return minimise_genetic(parameters, cost, o, {}, hooks);
}

Search search(const Twin& twin, int seed, bool screened) {
  Search s;
  const double begun = thread_seconds();
  const GeneticResult found = breed(twin, seed, generations, screened);
  const double bred = thread_seconds();
  s.simulations = found.state.evaluations;
  LeastSquaresProblem problem;
  problem.n = parameters;
  problem.evaluate = [&](std::span<const Point> points) { return twin.evaluate(points); };
  LeastSquaresOptions local;
  local.difference = Difference::forward;
  local.difference_step = 1e-4;
  local.least_metric = local.from_afar;
  local.cost_goal = twin.goal();
  local.slow_iterations = 5;
  // From the best points that are apart, best first: the best may lie in a wrong valley.
  for (const Individual& start : found.state.archive) {
    const LeastSquaresResult end = minimise_least_squares(problem, start.point, local);
    s.simulations += end.evaluations;
    s.cost_over_floor = std::min(s.cost_over_floor, end.misfit / twin.floor);
    s.arrived = end.misfit <= twin.goal();
    if (++s.starts == most_starts || s.arrived) break;
  }
  s.local = thread_seconds() - bred;
  s.seconds = thread_seconds() - begun;
  return s;
}

struct Searches {
  std::vector<Search> all;

  template <class T>
  double median(T Search::*of) const {
    std::vector<double> v;
    for (const Search& s : all) v.push_back(static_cast<double>(s.*of));
    return median_of(std::move(v));
  }
  long arrived(int within) const {
    return std::count_if(all.begin(), all.end(), [&](const Search& s) { return s.arrived && s.starts <= within; });
  }
  nlohmann::ordered_json json() const {
    nlohmann::ordered_json each = nlohmann::ordered_json::array();
    for (const Search& s : all)
      each.push_back({{"seconds", s.seconds},
                      {"local", s.local},
                      {"simulations", s.simulations},
                      {"cost_over_floor", s.cost_over_floor},
                      {"starts", s.starts}});
    return {{"seconds", median(&Search::seconds)},
            {"arrived", arrived(most_starts)},
            {"from_the_first_start", arrived(1)},
            {"draws", each}};
  }
};

}  // namespace

void genetic_rows(Report& report, const Choice& choice) {
  const Scenario scenario = trace(10.0);
  Searches floats, doubles;
  for (int seed = 1; seed <= std::min(draws, choice.turns); ++seed) {
    const Twin twin(parameters, seed, scenario, 1);
    floats.all.push_back(search(twin, seed, true));
    doubles.all.push_back(search(twin, seed, false));
  }
  const double seconds = floats.median(&Search::seconds);
  report.add({"genetic search 50 x 100 and local stage, 10 s log, one core", "15 s", "6 s",
              fmt::format("{:.1f} s", seconds),
              fmt::format("{} of {} draws arrive, {} from the first start of {}; {:.1f} s of it local, {:.0f} "
                          "simulations; all as fits run {:.1f} s, {} arrive",
                          floats.arrived(most_starts), floats.all.size(), floats.arrived(1), most_starts,
                          floats.median(&Search::local), floats.median(&Search::simulations),
                          doubles.median(&Search::seconds), doubles.arrived(most_starts))});
  report.json["ga_plus_local_seconds_one_core"] = seconds;
  report.json["ga_plus_local"] = floats.json();
  report.json["ga_plus_local"]["in_doubles"] = doubles.json();

  // Wall time, so other work on the machine counts against two threads. What the machine can give at all is what two
  // searches that share nothing take side by side: a core may run slower for the other's work. The search of the row
  // above; as fits run, a part of it that ends with a whole wave too.
  constexpr int part = 32;
  const Twin alone(parameters, 1, scenario, 1), other(parameters, 1, scenario, 1), both(parameters, 1, scenario, 2);
  const auto side_by_side = [&](int so_many, bool screened) {
    std::thread beside([&] { breed(other, 1, so_many, screened); });
    breed(alone, 1, so_many, screened);
    beside.join();
  };
  const std::vector<Timing> t =
      take_turns({[&] { breed(alone, 1, generations, true); }, [&] { breed(both, 1, generations, true); },
                  [&] { side_by_side(generations, true); }, [&] { breed(alone, 1, part, false); },
                  [&] { breed(both, 1, part, false); }, [&] { side_by_side(part, false); }},
                 choice.turns, wall_seconds);
  const double gain = t[0].median / t[1].median, in_doubles_gain = t[3].median / t[4].median;
  const double machine = 2 * t[0].median / t[2].median, machine_in_doubles = 2 * t[3].median / t[5].median;
  report.add({"two threads against one, on the search", "1.8x", "1.95x", fmt::format("{:.2f}x", gain),
              fmt::format("two searches side by side gain {:.2f}x; all as fits run {:.2f}x, side by side {:.2f}x",
                          machine, in_doubles_gain, machine_in_doubles)});
  report.json["ga_two_thread_speedup"] = gain;
  report.json["ga_two_thread_speedup_in_doubles"] = in_doubles_gain;
  report.json["two_searches_side_by_side"] = {{"floats", machine}, {"doubles", machine_in_doubles}};
}

}  // namespace servodx::bench
