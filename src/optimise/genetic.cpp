#include "optimise/genetic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/error.h"
#include "base/median.h"
#include "base/random.h"
#include "optimise/genetic_variation.h"
#include "optimise/unit_cube.h"

namespace servodx {
namespace {

constexpr double kWorst = 1e300;  // what a failed point costs; finite, so that a saved state can hold it
constexpr int kLeastIsland = 6;
constexpr int kMemory = 6;
constexpr double kForget = 0.9;  // of the variations' counts, a generation
// Streams are Random(seed, generation, individual, purpose).
constexpr std::uint32_t kChild = 0, kCloud = 1, kSpread = 2;

void require(bool good, const char* option, const std::string& rule) {
  if (!good) throw InputError({}, std::string("option '") + option + "' " + rule, "");
}

double distance(const Point& a, const Point& b) {
  double sum = 0;
  for (std::size_t j = 0; j < a.size(); ++j) sum += (a[j] - b[j]) * (a[j] - b[j]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

class Genetic {
 public:
  Genetic(int n, const BatchCost& cost, const GeneticOptions& options, const std::vector<std::vector<Point>>& seeds,
          const GeneticHooks& hooks)
      : cost_(cost), options_(options), seeds_(seeds), hooks_(hooks) {
    state_.n = n;
    state_.seed = options.seed;
    make_room();
  }

  void take(const GeneticState& saved) {
    if (saved.n != state_.n || saved.seed != state_.seed || saved.islands.size() != islands())
      throw InputError({}, "the saved genetic search has other dimensions, another seed or other islands",
                       "resume with the options it was started with");
    if (saved.turn >= options_.population || saved.archive.size() > static_cast<std::size_t>(options_.archive))
      throw InputError({}, "the saved genetic search has another population or archive",
                       "resume with the options it was started with");
    for (std::size_t i = 0; i < islands(); ++i)
      if (static_cast<int>(saved.islands[i].population.size()) != island_size(i) ||
          saved.islands[i].reach.size() != kMemory)
        throw InputError({}, "the saved genetic search has islands of other sizes",
                         "resume with the options it was started with");
    state_ = saved;
    make_room();
  }

  GeneticResult run(bool resumed) {
    if (!resumed) {
      begin();
      if (!told()) return end(GeneticStop::interrupted);
    }
    for (;;) {
      if (state_.best.cost <= options_.cost_goal) return end(GeneticStop::goal);
      if (state_.generation >= options_.generations) return end(GeneticStop::generations);
      const int next = wave() + (hooks_.screen ? options_.archive : 0);
      if (options_.max_evaluations > 0 && state_.evaluations + next > options_.max_evaluations)
        return end(GeneticStop::evaluation_limit);
      const int before = state_.generation;
      step();
      if (state_.generation > before && !told()) return end(GeneticStop::interrupted);
    }
  }

 private:
  std::size_t islands() const { return std::max<std::size_t>(1, seeds_.size()); }
  int island_size(std::size_t i) const {
    const int count = static_cast<int>(islands());
    return options_.population / count + (static_cast<int>(i) < options_.population % count ? 1 : 0);
  }

  int first_slot(std::size_t island) const {
    int first = 0;
    for (std::size_t i = 0; i < island; ++i) first += island_size(i);
    return first;
  }

  // Children asked for at once; the last wave ends with the last generation.
  int wave() const {
    const int batches = (2 * options_.population + options_.batch) / (2 * options_.batch);  // the nearest number
    const int whole = batches > 0 ? batches * options_.batch : options_.population;
    const long left = static_cast<long>(options_.generations - state_.generation) * options_.population - state_.turn;
    return static_cast<int>(std::min<long>(whole, left));
  }

  bool told() const { return !hooks_.generation || hooks_.generation(state_); }

  // What was screened is ranked anew by the cost itself: best and archive, all that is reported, hold no other.
  GeneticResult end(GeneticStop reason) {
    if (hooks_.screen) {
      std::vector<Individual> screened;
      screened.swap(state_.archive);
      state_.best = {{}, kWorst};
      std::vector<Point> points;
      for (const Individual& one : screened) points.push_back(one.point);
      const std::vector<double> costs = evaluate(points);
      for (std::size_t k = 0; k < costs.size(); ++k) remember({points[k], costs[k]});
    }
    return {std::move(state_), reason};
  }

  std::vector<double> rank() {
    return hooks_.screen ? checked(hooks_.screen(wave_points(), std::span(bounds_).first(asked_)), asked_)
                         : evaluate(wave_points());
  }
  std::vector<double> evaluate(std::span<const Point> points) { return checked(cost_(points), points.size()); }
  std::vector<double> checked(std::vector<double> costs, std::size_t points) {
    if (costs.size() != points) throw std::logic_error("a batch's cost returned another number of costs");
    state_.evaluations += static_cast<long>(points);
    for (double& cost : costs) {
      if (std::isfinite(cost) && cost < options_.failure_cost) continue;
      ++state_.failed;
      cost = kWorst;
    }
    return costs;
  }

  // Points are asked for in buffers that are kept: a generation asks for no memory but its costs'.
  void make_room() {
    broods_.resize(islands());
    state_.archive.reserve(static_cast<std::size_t>(options_.archive));
    spare_.reserve(static_cast<std::size_t>(options_.archive));
  }
  Point& next_point(double bound = std::numeric_limits<double>::infinity()) {
    if (asked_ == points_.size()) points_.emplace_back(), bounds_.emplace_back();
    points_[asked_].resize(static_cast<std::size_t>(state_.n));
    bounds_[asked_] = bound;
    return points_[asked_++];
  }
  std::span<Point> wave_points() { return std::span(points_).first(asked_); }

  // Points of a fresh island: seeds, a cloud about them, and a Latin hypercube over the box.
  void fresh(std::size_t island, int size, bool with_seeds) {
    const int n = state_.n;
    const auto generation = static_cast<std::uint32_t>(state_.generation);
    const auto first = static_cast<std::uint32_t>(first_slot(island));
    int rest = size;
    if (with_seeds && island < seeds_.size() && !seeds_[island].empty()) {
      const auto& seeds = seeds_[island];
      const int seeded =
          std::min(size, std::max(static_cast<int>(seeds.size()), static_cast<int>(options_.seeded_part * size)));
      rest -= seeded;
      for (int k = 0; k < seeded; ++k) {
        Point& point = next_point();
        point = seeds[k % seeds.size()];
        Random random(state_.seed, generation, first + static_cast<std::uint32_t>(k), kCloud);
        for (double& v : point)
          v = reflect(k < static_cast<int>(seeds.size()) ? v : v + options_.seed_spread * random.normal());
      }
    }
    const std::size_t spread = asked_;
    for (int k = 0; k < rest; ++k) next_point();
    Random random(state_.seed, generation, first, kSpread);
    cell_.resize(static_cast<std::size_t>(size));
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < rest; ++k) {
        const int other = static_cast<int>(random.below(static_cast<std::uint32_t>(k + 1)));  // inside-out shuffle
        cell_[k] = cell_[other];
        cell_[other] = k;
      }
      for (int k = 0; k < rest; ++k) points_[spread + k][j] = (cell_[k] + random.uniform()) / rest;
    }
  }

  void fill(Island& island, std::span<const Point> points, const double* costs) {
    Island blank;
    blank.population.swap(island.population);
    blank.reach.swap(island.reach);
    blank.mixing.swap(island.mixing);
    island = std::move(blank);
    island.population.resize(points.size());
    island.reach.assign(kMemory, 0.5);
    island.mixing.assign(kMemory, 0.5);
    island.best_since_start = kWorst;
    for (std::size_t k = 0; k < points.size(); ++k) {
      island.population[k].point = points[k];
      island.population[k].cost = costs[k];
      island.best_since_start = std::min(island.best_since_start, costs[k]);
      remember(island.population[k]);
    }
    island.mark = island.best_since_start;
    island.median_mark = median_cost(island);
  }

  void begin() {
    state_.islands.resize(islands());
    state_.best.cost = kWorst;
    asked_ = 0;
    for (std::size_t i = 0; i < islands(); ++i) fresh(i, island_size(i), true);
    const std::vector<double> costs = rank();
    std::size_t at = 0;
    for (std::size_t i = 0; i < islands(); ++i) {
      const auto size = static_cast<std::size_t>(island_size(i));
      fill(state_.islands[i], wave_points().subspan(at, size), costs.data() + at);
      at += size;
    }
  }

  // Best and archive: the archive keeps the better of two points that are closer than archive_distance.
  void remember(const Individual& one) {
    if (one.cost >= kWorst) return;
    if (one.cost < state_.best.cost || state_.best.point.empty()) state_.best = one;
    auto& archive = state_.archive;
    if (static_cast<int>(archive.size()) >= options_.archive && one.cost >= archive.back().cost) return;
    for (const Individual& kept : archive)
      if (kept.cost <= one.cost && distance(kept.point, one.point) < options_.archive_distance) return;
    // What goes out lends its memory to what comes in.
    for (std::size_t k = 0; k < archive.size();) {
      if (distance(archive[k].point, one.point) >= options_.archive_distance) {
        ++k;
        continue;
      }
      std::rotate(archive.begin() + k, archive.begin() + k + 1, archive.end());
      take_out();
    }
    if (static_cast<int>(archive.size()) >= options_.archive) take_out();
    if (spare_.empty()) spare_.emplace_back();
    spare_.back() = one;
    const auto place = std::upper_bound(archive.begin(), archive.end(), one.cost,
                                        [](double cost, const Individual& kept) { return cost < kept.cost; });
    archive.insert(place, std::move(spare_.back()));
    spare_.pop_back();
  }
  void take_out() {
    spare_.push_back(std::move(state_.archive.back()));
    state_.archive.pop_back();
  }

  bool is_done(const Island& island) const {
    if (options_.stagnation > 0 && island.stagnant >= options_.stagnation) return true;
    double width = 0;
    for (int j = 0; j < state_.n; ++j) {
      double low = 1, high = 0;
      for (const Individual& one : island.population) {
        low = std::min(low, one.point[j]);
        high = std::max(high, one.point[j]);
      }
      width = std::max(width, high - low);
    }
    return width <= options_.collapse;
  }

  // The slots of one island that are in a wave, as positions in its population.
  struct Stretch {
    std::size_t island;
    int first, count;
    std::uint32_t generation;  // that their children belong to
    bool afresh = false;       // the whole island, and no children
  };

  void share_out(int slots) {
    stretches_.clear();
    auto generation = static_cast<std::uint32_t>(state_.generation + 1);
    for (int slot = state_.turn; slots > 0; slot = 0, ++generation)
      for (std::size_t i = 0; i < state_.islands.size() && slots > 0; ++i) {
        const int first = std::max(0, slot - first_slot(i)), count = std::min(slots, island_size(i) - first);
        if (count <= 0) continue;
        stretches_.push_back({i, first, count, generation});
        slots -= count;
      }
  }

  void step() {
    const int slots = wave();
    share_out(slots);
    asked_ = 0;
    children_.clear();
    done_.assign(islands(), false);
    for (Stretch& s : stretches_) {
      const Island& island = state_.islands[s.island];
      if (done_[s.island]) continue;  // a wave may reach an island's end and its beginning
      done_[s.island] = s.afresh = is_done(island);
      if (s.afresh) {
        fresh(s.island, static_cast<int>(island.population.size()), false);
        continue;
      }
      Brood& brood = broods_[s.island];
      brood.look_at(island, options_.tournament);
      for (int slot = s.first; slot < s.first + s.count; ++slot) {
        Random random(state_.seed, s.generation, static_cast<std::uint32_t>(first_slot(s.island) + slot), kChild);
        children_.push_back(make_child(brood, slot, random, next_point(island.population[slot].cost)));
      }
    }
    const std::vector<double> costs = rank();
    std::size_t at = 0, child = 0;
    for (const Stretch& s : stretches_) {
      Island& island = state_.islands[s.island];
      const std::size_t size = island.population.size();
      if (s.afresh) {
        ++state_.restarts;
        fill(island, wave_points().subspan(at, size), costs.data() + at);
        at += size;
      }
      if (done_[s.island]) continue;
      if (s.first == 0) forget(island);
      for (int k = 0; k < s.count; ++k, ++at) select(island, children_[child++], points_[at], costs[at]);
      if (s.first + s.count == static_cast<int>(size)) take_stock(island);
    }
    state_.turn += slots;
    while (state_.turn >= options_.population) {
      state_.turn -= options_.population;
      ++state_.generation;
      migrate();
      if (hooks_.refine && hooks_.refine_every > 0 && state_.generation % hooks_.refine_every == 0) admit();
    }
  }

  static void forget(Island& island) {
    for (int v = 0; v < kVariations; ++v) {
      island.tries[v] *= kForget;
      island.wins[v] *= kForget;
    }
  }

  void select(Island& island, const Child& child, Point& point, double cost) {
    Individual& parent = island.population[child.parent];
    island.tries[child.variation] += 1;
    if (cost > parent.cost || cost >= kWorst) return;
    if (cost < parent.cost) {
      island.wins[child.variation] += 1;
      if (child.variation == 2 || child.variation == 3) {
        const double gain = std::min(parent.cost, 1e100) - std::min(cost, 1e100);
        const double parts[] = {1.0, child.reach, child.reach * child.reach, child.mixing};
        for (std::size_t j = 0; j < island.gains.size(); ++j) island.gains[j] += gain * parts[j];
      }
    }
    parent.point.swap(point);
    parent.cost = cost;
    remember(parent);
    island.best_since_start = std::min(island.best_since_start, cost);
  }

  // Once a generation: which moves won, and whether the island still gains.
  void take_stock(Island& island) {
    const auto [weight, reach, reach2, mixing] = std::exchange(island.gains, {});
    if (weight > 0 && reach > 0) {
      island.reach[island.memory_at] = reach2 / reach;  // Lehmer mean: leans to the larger
      island.mixing[island.memory_at] = mixing / weight;
      island.memory_at = (island.memory_at + 1) % kMemory;
    }
    const auto gained = [&](double now, double mark) { return now < mark - options_.stagnation_gain * std::abs(mark); };
    const double middle = median_cost(island);
    const bool progress = gained(island.best_since_start, island.mark) || gained(middle, island.median_mark);
    if (!progress) {
      ++island.stagnant;
      return;
    }
    island.mark = island.best_since_start;
    island.median_mark = middle;
    island.stagnant = 0;
  }

  double median_cost(const Island& island) {
    sorted_.clear();
    for (const Individual& one : island.population) sorted_.push_back(one.cost);
    return median_in_place(sorted_);
  }

  static Individual& worst(Island& island) {
    return *std::max_element(island.population.begin(), island.population.end(),
                             [](const Individual& a, const Individual& b) { return a.cost < b.cost; });
  }

  void migrate() {
    if (options_.migrate_every <= 0 || state_.islands.size() < 2 || state_.generation % options_.migrate_every != 0)
      return;
    guests_.resize(islands());
    for (std::size_t i = 0; i < islands(); ++i) {
      const auto& population = state_.islands[i].population;
      guests_[i] = *std::min_element(population.begin(), population.end(),
                                     [](const Individual& a, const Individual& b) { return a.cost < b.cost; });
    }
    for (std::size_t i = 0; i < islands(); ++i) settle(state_.islands[(i + 1) % islands()], guests_[i]);
  }

  void settle(Island& island, const Individual& guest) {
    Individual& place = worst(island);
    if (guest.cost >= place.cost) return;
    place = guest;
    island.best_since_start = std::min(island.best_since_start, guest.cost);
  }

  void admit() {
    for (Individual& guest : hooks_.refine(state_)) {
      if (static_cast<int>(guest.point.size()) != state_.n)
        throw std::logic_error("a refined point has the wrong length");
      if (!std::isfinite(guest.cost) || guest.cost >= options_.failure_cost) continue;
      Island* home = nullptr;
      Individual* nearest = nullptr;
      double least = std::numeric_limits<double>::infinity();
      for (Island& island : state_.islands) {
        for (Individual& one : island.population) {
          const double apart = distance(one.point, guest.point);
          if (apart < least) {
            least = apart;
            nearest = &one;
            home = &island;
          }
        }
      }
      if (nearest && guest.cost < nearest->cost) {
        *nearest = guest;
        home->best_since_start = std::min(home->best_since_start, guest.cost);
      }
      remember(guest);
    }
  }

  const BatchCost& cost_;
  const GeneticOptions& options_;
  const std::vector<std::vector<Point>>& seeds_;
  const GeneticHooks& hooks_;
  GeneticState state_;

  // Kept from wave to wave for their memory only.
  std::vector<Point> points_;  // the first `asked_` are the wave's
  std::vector<double> bounds_;
  std::size_t asked_ = 0;
  std::vector<Child> children_;
  std::vector<Stretch> stretches_;
  std::vector<char> done_;     // islands that start afresh in this wave
  std::vector<Brood> broods_;  // an island each
  std::vector<Individual> guests_, spare_;
  std::vector<int> cell_;
  std::vector<double> sorted_;
};

}  // namespace

void GeneticOptions::validate() const {
  require(population >= kLeastIsland, "population", "must be at least 6");
  require(batch >= 1, "batch", "must be at least 1");
  require(generations >= 0, "generations", "must not be negative");
  require(tournament >= 1, "tournament", "must be at least 1");
  require(seed_spread >= 0 && std::isfinite(seed_spread), "seed_spread", "must not be negative");
  require(seeded_part >= 0 && seeded_part <= 1, "seeded_part", "must be 0 to 1");
  require(migrate_every >= 0, "migrate_every", "must not be negative (0 means never)");
  require(stagnation >= 0, "stagnation", "must not be negative (0 means never)");
  require(stagnation_gain >= 0 && stagnation_gain < 1, "stagnation_gain", "must be at least 0 and below 1");
  require(collapse >= 0 && collapse < 1, "collapse", "must be at least 0 and below 1");
  require(archive >= 1, "archive", "must be at least 1");
  require(archive_distance >= 0 && archive_distance <= 1, "archive_distance", "must be 0 to 1");
  require(failure_cost > 0 && failure_cost <= kWorst, "failure_cost", "must be above 0 and at most 1e300");
  require(max_evaluations >= 0, "max_evaluations", "must not be negative (0 means no limit)");
  require(!std::isnan(cost_goal), "cost_goal", "must be a number");
}

GeneticResult minimise_genetic(int n, const BatchCost& cost, const GeneticOptions& options,
                               const std::vector<std::vector<Point>>& seeds, const GeneticHooks& hooks,
                               const GeneticState* resume) {
  options.validate();
  require(n >= 1, "n", "must be at least 1");
  const int islands = std::max(1, static_cast<int>(seeds.size()));
  require(options.population / islands >= kLeastIsland, "population",
          "must give each of the " + std::to_string(islands) + " islands at least 6 individuals");
  for (const auto& set : seeds)
    for (const Point& point : set)
      if (static_cast<int>(point.size()) != n) throw std::logic_error("a seed point has the wrong length");
  Genetic genetic(n, cost, options, seeds, hooks);
  if (resume) genetic.take(*resume);
  return genetic.run(resume != nullptr);
}

}  // namespace servodx
