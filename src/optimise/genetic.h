// Genetic algorithm on the unit cube, for breadth: which structure, which basin. It is real-coded and elitist (a slot
// only ever gets better), keeps its children in the box by reflection, and asks for them in waves that go round the
// slots of all islands: whole batches, however many the population has. Each island may start from its own seed points
// (tune passes starts of a healthy valve, diagnose one island of a failure mode's identifiers). An island whose best
// and median stop improving, or whose members have drawn together, gives its best to the archive and starts afresh. The
// archive holds the best points that are apart: the starts of the local stage.
//
// Limits: it does not polish. In 41 dimensions 5,000 evaluations find a basin, not a minimum; box_least_squares.h does
// the rest, at the end or, through `refine`, while it runs. Costs must be finite or are taken as failures; a failed
// point loses every comparison and is counted. Randomness derives from (seed, generation, individual); the result does
// not depend on threads, and a resumed run ends bit for bit the same.
#pragma once
#include <functional>
#include <string>

#include "optimise/genetic_state.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct GeneticOptions {
  int population = 50;  // all islands together
  int generations = 100;
  // Children come in waves of whole batches, as many as are nearest to the population (64 for 50, whose first 14 slots
  // get two in the first wave, the next 14 in the next): 32 fill two packs of 16 floats or four of 8 doubles, evenly
  // on one and two threads. Waves smaller than the population converge slower: old and new then stand side by side.
  int batch = 32;
  std::uint64_t seed = 1;
  int tournament = 2;
  double seed_spread = 0.1;       // standard deviation of the cloud about each seed point, of the box
  double seeded_part = 0.5;       // of an island, seed points included; the rest is spread over the whole box
  int migrate_every = 20;         // generations; the best of each island visits the next one. 0: never
  int stagnation = 40;            // generations without `stagnation_gain`, then an island starts afresh. 0: never
  double stagnation_gain = 1e-3;  // of the island's best cost or of its median
  double collapse = 1e-9;         // an island no wider than this (of the box, every coordinate) starts afresh
  int archive = 10;
  // Root mean square over the coordinates, of the box. Random points are some 0.4 apart; a population that has settled
  // in one valley is some 0.1 wide, so an archive that is to hold starts in others needs more.
  double archive_distance = 0.05;
  double failure_cost = 1e30;  // at or above: counted as failed
  long max_evaluations = 0;    // 0: no limit. No generation is begun that would pass it
  double cost_goal = -1e300;   // stop once the best is at or below it

  void validate() const;  // throws InputError with the option's name
};

enum class GeneticStop { generations, evaluation_limit, goal, interrupted };

struct GeneticHooks {
  // After every generation, when the state is whole: save it, show progress. False asks to stop.
  std::function<bool(const GeneticState&)> generation;
  // Improved points with their costs, for example from a short local search on the archive. Each takes the place of the
  // member nearest to it, if it is better: to put the same polished point in the worst slots would draw the island
  // together. Must be a pure function of the state for a resumed run to end the same; its evaluations are the caller's
  // to count.
  std::function<std::vector<Individual>(const GeneticState&)> refine;
  int refine_every = 10;
  // A cheaper cost that ranks almost as the cost does: all comparisons are by it, and what is returned as best and in
  // the archive is ranked anew by the cost itself. While the search runs, its state holds costs of the screen. A
  // child's bound is the cost of the parent whose slot it asks for; a point that asks for nobody's has none (infinity).
  BoundedCost screen;
};

struct GeneticResult {
  GeneticState state;  // best, archive, counts
  GeneticStop reason = GeneticStop::generations;
};

// `seeds`: one set of start points an island; none means one island without seeds. `resume`: a saved state, options and
// problem as before.
GeneticResult minimise_genetic(int n, const BatchCost& cost, const GeneticOptions& options,
                               const std::vector<std::vector<Point>>& seeds = {}, const GeneticHooks& hooks = {},
                               const GeneticState* resume = nullptr);

}  // namespace servodx
