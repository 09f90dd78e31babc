#include "plan/piece_search.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "plan/constants.h"
#include "plan/information.h"

namespace servodx {
namespace {

namespace k = plan_constants;

constexpr double unplayable = -1e300;
constexpr std::uint32_t stream_of_draws = 71, stream_of_random_test = 72;
constexpr double smaller = 0.8;   // until a test keeps its limits
constexpr int fewest_times = 25;  // that is a thousandth or so

using Plan = std::vector<Segment>;

class Search {
 public:
  Search(TestBench& bench, const LaneSet& set, const Timing& timing, const SearchWishes& wishes)
      : bench_(bench), set_(set), timing_(timing), wishes_(wishes), draws_(wishes.seed, stream_of_draws) {}

  FoundTest run() {
    refuse_limits_below_rest();
    Plan chosen = choose(play_library());
    begin(chosen);
    for (int round = 0; round < wishes_.rounds && !wishes_.watch.stopped(); ++round) {
      tell(0.2 + 0.8 * round / wishes_.rounds);
      const double before = best_.worth;
      exchange();
      if (best_.worth - before < k::worth_a_round) break;
    }
    best_.interrupted = wishes_.watch.stopped();
    return std::move(best_);
  }

  FoundTest blind() {
    Random random(wishes_.seed, stream_of_random_test);
    Plan plan;
    for (std::size_t i = 0; i < timing_.pieces(); ++i)
      plan.push_back(random_segment(random, wishes_.limits.current, timing_.seconds(i), timing_.rate));
    best_ = playable(std::move(plan));
    return std::move(best_);
  }

 private:
  struct Played {
    Plan plan;
    TestRun run;
    double worth = unplayable;
  };

  void tell(double part) const { wishes_.watch.tell("plan", part, bench_.simulations()); }

  double worth(const TestRun& run) const {
    if (!run.ok || !within(run.extremes, wishes_.limits)) return unplayable;
    return worth_of(Information(run.gram, set_), set_, wishes_.kind);
  }

  std::vector<Played> play(std::vector<Plan> plans, const Timing& timing) {
    std::vector<std::vector<double>> waves;
    for (const Plan& p : plans) waves.push_back(wave_of(p, timing));
    std::vector<TestRun> runs = bench_.play(waves, set_);
    std::vector<Played> out(plans.size());
    const int threads = wishes_.threads > 0 ? wishes_.threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].worth = worth(runs[i]);
      out[i].plan = std::move(plans[i]);
      out[i].run = std::move(runs[i]);
    }
    return out;
  }

  void refuse_limits_below_rest() {
    const Played rest = std::move(play({{}}, timing_).front());
    if (!rest.run.ok)
      throw InputError({"--params", 0, ""}, "the simulation of a valve at rest leaves the finite numbers",
                       "check the table");
    const PlannedTest::Extremes& e = rest.run.extremes;
    if (within(e, wishes_.limits)) return;
    throw InputError({"--max-pressure, --max-stroke, --max-speed", 0, ""},
                     fmt::format("a valve at rest, its null and offsets within their tolerances, comes near a limit: "
                                 "{:.4g} bar, {:.4g} mm, {:.4g} mm/s",
                                 e.pressure_high * 1e-5, e.stroke * 1e3, e.speed * 1e3),
                     "give wider limits");
  }

  // What may be played alone, and what it shows.
  std::vector<Played> play_library() {
    const Timing alone = single_piece(timing_);
    std::vector<Plan> plans;
    for (const Segment& s : segment_library(wishes_.limits.current, alone.seconds(0), alone.rate)) plans.push_back({s});
    std::vector<Played> out = play(std::move(plans), alone);
    std::erase_if(out, [](const Played& p) { return p.worth == unplayable; });
    tell(0.1);
    return out;
  }

  // The piece that adds most to what the others show.
  std::size_t best_beside(const Eigen::MatrixXd& others, const std::vector<Played>& library) const {
    std::vector<double> worths(library.size());
    const int threads = wishes_.threads > 0 ? wishes_.threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (std::size_t s = 0; s < library.size(); ++s) {
      const Eigen::MatrixXd sum = others + library[s].run.gram;
      worths[s] = worth_of(Information(sum, set_), set_, wishes_.kind);
    }
    return static_cast<std::size_t>(std::max_element(worths.begin(), worths.end()) - worths.begin());
  }

  Plan choose(const std::vector<Played>& library) const {
    if (library.empty()) return Plan(timing_.pieces());
    const auto lanes = static_cast<long>(set_.lanes.size());
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(lanes, lanes);
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < timing_.pieces(); ++i) {
      chosen.push_back(best_beside(sum, library));
      sum += library[chosen.back()].run.gram;
    }
    for (std::size_t& piece : chosen) {
      sum -= library[piece].run.gram;
      piece = best_beside(sum, library);
      sum += library[piece].run.gram;
    }
    Plan plan;
    for (const std::size_t piece : chosen) plan.push_back(library[piece].plan.front());
    return plan;
  }

  // Smaller and smaller, until it keeps the limits.
  FoundTest playable(Plan plan) {
    Played p;
    for (int i = 0; i < fewest_times; ++i) {
      p = std::move(play({plan}, timing_).front());
      if (p.worth != unplayable) break;
      for (Segment& s : plan) s.amplitude *= smaller;
    }
    return {std::move(p.plan), std::move(p.run), p.worth, false};
  }

  void begin(const Plan& chosen) {
    best_ = playable(chosen);
    std::vector<Plan> orders;
    Plan plan = best_.segments;
    const auto gentler = [](const Segment& a, const Segment& b) { return a.amplitude < b.amplitude; };
    std::stable_sort(plan.begin(), plan.end(), gentler);
    orders.push_back(plan);
    std::reverse(plan.begin(), plan.end());
    orders.push_back(plan);
    keep_best(play(std::move(orders), timing_));
    tell(0.2);
  }

  bool keep_best(std::vector<Played> played) {
    const auto best = std::max_element(played.begin(), played.end(),
                                       [](const Played& a, const Played& b) { return a.worth < b.worth; });
    if (best == played.end() || best->worth <= best_.worth) return false;
    best_ = {std::move(best->plan), std::move(best->run), best->worth, false};
    return true;
  }

  // Every change of one place.
  std::vector<Segment> changes_of(std::size_t place) {
    const Segment& at = best_.segments[place];
    std::vector<Segment> out;
    const auto amplitude = [&](double by) {
      Segment s = at;
      s.amplitude = std::clamp(s.amplitude * by, k::least_amplitude, wishes_.limits.current);
      if (s.amplitude != at.amplitude) out.push_back(s);
    };
    const auto rate = [&](double by) {
      Segment s = at;
      s.rate *= by;
      const double seconds = timing_.seconds(place);
      const bool plays = s.rate <= std::min(k::fastest, timing_.rate / k::samples_a_cycle);
      if (plays && played_rate(s, seconds) != played_rate(at, seconds)) out.push_back(s);
    };
    if (at.shape != Shape::rest) {
      amplitude(k::change), amplitude(1 / k::change);
      rate(k::change), rate(1 / k::change);
    }
    for (int i = 0; i < k::draws; ++i)
      out.push_back(random_segment(draws_, wishes_.limits.current, timing_.seconds(place), timing_.rate));
    return out;
  }

  void exchange() {
    std::vector<Plan> plans;
    std::vector<std::size_t> places;
    const std::size_t n = best_.segments.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (const Segment& s : changes_of(i)) {
        plans.push_back(best_.segments);
        plans.back()[i] = s;
        places.push_back(i);
      }
      if (i + 1 < n) {
        plans.push_back(best_.segments);
        std::swap(plans.back()[i], plans.back()[i + 1]);
        places.push_back(n);  // of no one place
      }
    }
    std::vector<Played> played = play(std::move(plans), timing_);
    Plan together = best_.segments;
    std::vector<double> gained(n, best_.worth);
    for (std::size_t c = 0; c < played.size(); ++c) {
      const std::size_t at = places[c];
      if (at < n && played[c].worth > gained[at]) gained[at] = played[c].worth, together[at] = played[c].plan[at];
    }
    keep_best(std::move(played));
    keep_best(play({std::move(together)}, timing_));
  }

  TestBench& bench_;
  const LaneSet& set_;
  const Timing& timing_;
  const SearchWishes& wishes_;
  Random draws_;
  FoundTest best_;
};

}  // namespace

bool within(const PlannedTest::Extremes& e, const PlanLimits& limits) {
  constexpr double part = 1 - k::margin;
  return (!limits.stroke || e.stroke <= part * *limits.stroke) && (!limits.speed || e.speed <= part * *limits.speed) &&
         (!limits.pressure || e.pressure_high <= part * *limits.pressure);
}

FoundTest search(TestBench& bench, const LaneSet& set, const Timing& timing, const SearchWishes& wishes) {
  return Search(bench, set, timing, wishes).run();
}

FoundTest random_test(TestBench& bench, const LaneSet& set, const Timing& timing, const SearchWishes& wishes) {
  return Search(bench, set, timing, wishes).blind();
}

}  // namespace servodx
