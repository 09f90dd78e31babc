// Who gets to a goal in fewer simulations: ours, and the peers. Every evaluation counts, Jacobian lanes included.
#pragma once
#include <optional>
#include <vector>

#include "optimise/unit_cube.h"
#include "ratios/rows.h"

namespace servodx::bench {

// Copies may be asked side by side.
struct Objective {
  int n = 0;
  double goal = 0;  // of the misfit 0.5*|residual|^2
  BatchEvaluate evaluate;
};

double misfit(const Evaluation& e);  // a failed point: 1e12

// A spread of points, then the local stage from the best of them, and from the next when one ends short of the goal.
// Evaluations used; none within `patience`. `least`: the lowest misfit met.
std::optional<long> ours(const Objective& objective, int seed, long patience, double* least = nullptr);

// reached[peer][objective]: evaluations until the goal, none within the budget. A method's seed is the objective's
// place in the list, from 1. All runs advance in step, and what waits is simulated as one batch.
std::vector<std::vector<std::optional<long>>> run_peers(const std::vector<Objective>& objectives, long budget);

// Median with what never arrived as infinitely late; empty when that is the median.
std::optional<double> median_arrival(std::vector<std::optional<long>> arrivals);
nlohmann::ordered_json or_null(const std::optional<double>& x);

// Ours, then the peers, on one objective a seed: the rows of the table and json[key][n].
void race(Report& report, const Choice& choice, const std::string& what, const std::string& key,
          const std::vector<Objective>& objectives, nlohmann::ordered_json said = {});

}  // namespace servodx::bench
