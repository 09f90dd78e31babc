#include "optimise/genetic_variation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

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

Eigen::VectorXd crossover(const Brood& brood, int slot, bool turned, Random& random) {
  const auto& population = brood.island->population;
  const auto a = vector(population[slot].point);
  int other = tournament(brood, random);
  if (other == slot) other = draw_below(random, static_cast<int>(population.size()));
  Eigen::VectorXd gap = vector(population[other].point) - a;
  if (turned) gap = (brood.axes.transpose() * gap).eval();
  for (double& d : gap) {
    const double u = random.uniform();
    const double power = 1.0 / (kCrossoverEta + 1.0);
    const double beta = u < 0.5 ? std::pow(2 * u, power) : std::pow(1.0 / (2 * (1 - u)), power);
    const double near = 0.5 * (1 - beta), far = 0.5 * (1 + beta);
    d *= random.uniform() < 0.5 ? near : far;
  }
  Eigen::VectorXd x = a;
  if (turned) {
    x += brood.axes * gap;
  } else {
    x += gap;
  }
  mutate(x, random);
  return x;
}

Eigen::VectorXd difference(const Brood& brood, int slot, bool turned, Child& child, Random& random) {
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
  const auto x = vector(island.population[slot].point);
  Eigen::VectorXd move = child.reach * (vector(island.population[best].point) - x + vector(island.population[a].point) -
                                        vector(island.population[b].point));
  if (turned) move = (brood.axes.transpose() * move).eval();
  const int always = draw_below(random, static_cast<int>(x.size()));
  for (int j = 0; j < x.size(); ++j)
    if (random.uniform() >= child.mixing && j != always) move[j] = 0;
  if (turned) return x + brood.axes * move;
  return x + move;
}

Eigen::VectorXd ensemble(const Brood& brood, Random& random) {
  const auto& population = brood.island->population;
  const double scale = std::exp(0.4 * random.normal()) / std::sqrt(static_cast<double>(population.size()));
  Eigen::VectorXd x = brood.centre;
  for (const Individual& one : population) x += (scale * random.normal()) * (vector(one.point) - brood.mean);
  return x;
}

}  // namespace

double reflect(double x) {
  x = std::fmod(std::abs(x), 2.0);
  return x > 1.0 ? 2.0 - x : x;
}

Brood look_at(const Island& island, int tournament_size) {
  const auto& population = island.population;
  const int size = static_cast<int>(population.size());
  const auto n = static_cast<Eigen::Index>(population.front().point.size());
  Brood brood;
  brood.island = &island;
  brood.tournament = tournament_size;
  brood.by_cost.resize(size);
  std::iota(brood.by_cost.begin(), brood.by_cost.end(), 0);
  std::stable_sort(brood.by_cost.begin(), brood.by_cost.end(),
                   [&](int a, int b) { return population[a].cost < population[b].cost; });
  Eigen::MatrixXd points(n, size);
  for (int k = 0; k < size; ++k) points.col(k) = vector(population[k].point);
  brood.mean = points.rowwise().mean();
  brood.centre = Eigen::VectorXd::Zero(n);
  double weights = 0;
  for (int k = 0; k < size / 2; ++k) {
    const double weight = std::log(size / 2 + 0.5) - std::log(k + 1.0);
    brood.centre += weight * points.col(brood.by_cost[k]);
    weights += weight;
  }
  brood.centre /= weights;
  const Eigen::MatrixXd spread = points.colwise() - brood.mean;
  brood.axes = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(spread * spread.transpose()).eigenvectors();

  double total = 0;
  for (int v = 0; v < kVariations; ++v) {
    brood.share[v] = (island.wins[v] + 0.5) / (island.tries[v] + 2.0);
    total += brood.share[v];
  }
  for (double& share : brood.share) share = kFloor + (1 - kVariations * kFloor) * share / total;
  return brood;
}

Child make_child(const Brood& brood, int slot, Random& random) {
  Child child;
  double at = random.uniform();
  while (child.variation < kVariations - 1 && at >= brood.share[child.variation]) at -= brood.share[child.variation++];
  Eigen::VectorXd x;
  switch (child.variation) {
    case 0:
      x = crossover(brood, slot, false, random);
      break;
    case 1:
      x = crossover(brood, slot, true, random);
      break;
    case 2:
      x = difference(brood, slot, false, child, random);
      break;
    case 3:
      x = difference(brood, slot, true, child, random);
      break;
    default:
      x = ensemble(brood, random);
  }
  child.point.resize(x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) child.point[j] = reflect(x[j]);
  return child;
}

}  // namespace servodx
