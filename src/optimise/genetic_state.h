// Everything a genetic search needs to go on: a plain struct, saved whole each time a generation is complete. A run resumed
// from it gives the identical result, bit for bit, because nothing else is remembered between generations and random
// numbers come from counters.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "optimise/unit_cube.h"

namespace servodx {

struct Individual {
  Point point;
  double cost = 0;
};

inline constexpr int kVariations = 5;  // see genetic_variation.h

struct Island {
  std::vector<Individual> population;
  std::array<double, kVariations> tries{}, wins{};  // decayed counts; they share out the variations
  std::vector<double> reach, mixing;                // memory of the difference factors and crossover rates that won
  int memory_at = 0;
  // Of this generation's children that won: gain, and gain times reach, reach squared, mixing.
  std::array<double, 4> gains{};
  double best_since_start = 0;  // of this restart
  double mark = 0;              // the best when progress was last seen
  double median_mark = 0;       // and the median then
  int stagnant = 0;             // generations since
};

struct GeneticState {
  int n = 0;
  std::uint64_t seed = 0;
  int generation = 0;    // generations completed; 0 is the initial population
  int turn = 0;          // slot whose child is next: a wave may end in the middle of a generation
  long evaluations = 0;  // points asked for
  long failed = 0;       // of those, not finite or at or above the failure cost
  int restarts = 0;
  Individual best;
  std::vector<Individual> archive;  // best distinct points, best first
  std::vector<Island> islands;
};

std::string to_json(const GeneticState& state);                 // numbers keep every bit
GeneticState genetic_state_from_json(const std::string& text);  // throws InputError when the text is not such a state

}  // namespace servodx
