#include "optimise/genetic_variation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "optimise/unit_cube.h"

namespace servodx {
namespace {

constexpr double kFloor = 0.05;       // least share of a variation
constexpr double kCrossoverEta = 10;  // the larger, the nearer children stay to their parents
constexpr double kMutationEta = 20;
constexpr double kBestPart = 0.15;  // of the population: whom a difference leans to

Eigen::Map<const Eigen::VectorXd> vector(const Point& p) { return {p.data(), static_cast<Eigen::Index>(p.size())}; }

int draw_below(Random& random, int n) { return static_cast<int>(random.below(static_cast<std::uint32_t>(n))); }
double draw_cauchy(Random& random) { return std::tan(std::numbers::pi * (random.uniform() - 0.5)); }

int tournament(const Brood& brood, Random& random) {
  int rank = static_cast<int>(brood.by_cost.size());
  for (int k = 0; k < brood.tournament; ++k)
    rank = std::min(rank, draw_below(random, static_cast<int>(brood.by_cost.size())));
  return brood.by_cost[rank];
}

void mutate(Eigen::VectorXd& x, Random& random) {
  const double rate = 1.0 / static_cast<double>(x.size());
  for (double& v : x) {
    if (random.uniform() >= rate) continue;
    const double u = random.uniform();
    const double power = 1.0 / (kMutationEta + 1.0);
    v += u < 0.5 ? std::pow(2 * u, power) - 1.0 : 1.0 - std::pow(2 * (1 - u), power);
  }
}

// The child stands at the parent and `move`, given along the principal axes or the coordinates.
void step_from(Brood& brood, int slot, bool turned) {
  if (turned) brood.along.noalias() = brood.axes() * brood.move;
  brood.child = vector(brood.island->population[slot].point) + (turned ? brood.along : brood.move);
}

void turn_to_axes(Brood& brood) {
  brood.along.noalias() = brood.axes().transpose() * brood.move;
  brood.move.swap(brood.along);
}

void crossover(Brood& brood, int slot, bool turned, Random& random) {
  const auto& population = brood.island->population;
  int other = tournament(brood, random);
  if (other == slot) other = draw_below(random, static_cast<int>(population.size()));
  brood.move = vector(population[other].point) - vector(population[slot].point);
  if (turned) turn_to_axes(brood);
  for (double& d : brood.move) {
    const double u = random.uniform();
    const double power = 1.0 / (kCrossoverEta + 1.0);
    const double beta = u < 0.5 ? std::pow(2 * u, power) : std::pow(1.0 / (2 * (1 - u)), power);
    const double near = 0.5 * (1 - beta), far = 0.5 * (1 + beta);
    d *= random.uniform() < 0.5 ? near : far;
  }
  step_from(brood, slot, turned);
  mutate(brood.child, random);
}

void difference(Brood& brood, int slot, bool turned, Child& child, Random& random) {
  const Island& island = *brood.island;
  const int size = static_cast<int>(island.population.size());
  const int cell = draw_below(random, static_cast<int>(island.reach.size()));
  do {
    child.reach = island.reach[cell] + 0.1 * draw_cauchy(random);
  } while (child.reach <= 0);
  child.reach = std::min(child.reach, 1.0);
  child.mixing = std::clamp(island.mixing[cell] + 0.1 * random.normal(), 0.0, 1.0);

  const int best = brood.by_cost[draw_below(random, std::max(2, static_cast<int>(kBestPart * size)))];
  int a = draw_below(random, size), b = draw_below(random, size);
  while (a == slot) a = draw_below(random, size);
  while (b == slot || b == a) b = draw_below(random, size);
  brood.move = child.reach * (vector(island.population[best].point) - vector(island.population[slot].point) +
                              vector(island.population[a].point) - vector(island.population[b].point));
  if (turned) turn_to_axes(brood);
  const int always = draw_below(random, static_cast<int>(brood.move.size()));
  for (int j = 0; j < brood.move.size(); ++j)
    if (random.uniform() >= child.mixing && j != always) brood.move[j] = 0;
  step_from(brood, slot, turned);
}

void ensemble(Brood& brood, Random& random) {
  const auto& population = brood.island->population;
  const double scale = std::exp(0.4 * random.normal()) / std::sqrt(static_cast<double>(population.size()));
  brood.child = brood.centre;
  for (const Individual& one : population) brood.child += (scale * random.normal()) * (vector(one.point) - brood.mean);
}

}  // namespace

double reflect(double x) {
  x = std::fmod(std::abs(x), 2.0);
  return x > 1.0 ? 2.0 - x : x;
}

void Brood::look_at(const Island& one, int tournament_size) {
  const auto& population = one.population;
  const int size = static_cast<int>(population.size());
  const auto n = static_cast<Eigen::Index>(population.front().point.size());
  island = &one;
  tournament = tournament_size;
  by_cost.resize(size);
  std::iota(by_cost.begin(), by_cost.end(), 0);
  std::sort(by_cost.begin(), by_cost.end(), [&](int a, int b) {
    return population[a].cost < population[b].cost || (population[a].cost == population[b].cost && a < b);
  });
  points.resize(n, size);
  for (int k = 0; k < size; ++k) points.col(k) = vector(population[k].point);
  mean = points.rowwise().mean();
  centre.setZero(n);
  double weights = 0;
  for (int k = 0; k < size / 2; ++k) {
    const double weight = std::log(size / 2 + 0.5) - std::log(k + 1.0);
    centre += weight * points.col(by_cost[k]);
    weights += weight;
  }
  centre /= weights;
  spread = points.colwise() - mean;
  square.noalias() = spread * spread.transpose();
  principal.compute(square);

  double total = 0;
  for (int v = 0; v < kVariations; ++v) {
    share[v] = (one.wins[v] + 0.5) / (one.tries[v] + 2.0);
    total += share[v];
  }
  for (double& s : share) s = kFloor + (1 - kVariations * kFloor) * s / total;
}

Child make_child(Brood& brood, int slot, Random& random, Point& point) {
  Child child;
  child.parent = slot;
  double at = random.uniform();
  while (child.variation < kVariations - 1 && at >= brood.share[child.variation]) at -= brood.share[child.variation++];
  switch (child.variation) {
    case 0:
      crossover(brood, slot, false, random);
      break;
    case 1:
      crossover(brood, slot, true, random);
      break;
    case 2:
      difference(brood, slot, false, child, random);
      break;
    case 3:
      difference(brood, slot, true, child, random);
      break;
    default:
      ensemble(brood, random);
  }
  point.resize(brood.child.size());
  std::transform(brood.child.begin(), brood.child.end(), point.begin(), reflect);
  return child;
}

}  // namespace servodx
