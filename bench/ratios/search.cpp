// Simulations until a fit stands within 1.05 of the noise floor: ours, and the best of the peers. One lane run each,
// Jacobian lanes included. All seeds of all peers advance in step, and one batch serves them.
#include <fmt/format.h>

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "base/random.h"
#include "optimise/box_least_squares.h"
#include "ratios/measure.h"
#include "ratios/peers.h"
#include "ratios/rows.h"
#include "ratios/twin.h"

namespace servodx::bench {
namespace {

constexpr double seconds = 5.0;
constexpr long patience = 5000;  // simulations of ours before a seed counts as failed

// A spread of points, then the local stage from the best of them, and from the next when one ends short of the goal.
std::optional<long> ours(const Twin& twin, int seed) {
  constexpr int spread = 16;
  LeastSquaresProblem problem;
  problem.n = twin.n;
  problem.evaluate = [&](std::span<const Point> points) { return twin.evaluate(points); };
  LeastSquaresOptions o;
  o.difference = Difference::forward;
  o.difference_step = 1e-4;
  o.compressed_first_pass = true;
  o.cost_goal = twin.goal();
  o.slow_iterations = 5;
  long used = 0;
  for (std::uint32_t round = 0; used < patience; ++round) {
    std::vector<Point> points;
    for (std::uint32_t k = 0; k < spread; ++k) {
      Random random(static_cast<std::uint64_t>(seed), 9, round, k);
      Point x;
      for (int j = 0; j < twin.n; ++j) x.push_back(random.uniform());
      points.push_back(std::move(x));
    }
    std::vector<std::pair<double, int>> order;
    const std::vector<Evaluation> first = twin.evaluate(points);
    used += spread;
    for (int k = 0; k < spread; ++k)
      if (first[k].ok) order.push_back({first[k].residual.squaredNorm(), k});
    std::sort(order.begin(), order.end());
    for (std::size_t k = 0; k < std::min<std::size_t>(2, order.size()) && used < patience; ++k) {
      o.max_evaluations = patience - used;
      const LeastSquaresResult r = minimise_least_squares(problem, points[order[k].second], o);
      used += r.evaluations;
      if (r.misfit <= twin.goal()) return used;
    }
  }
  return std::nullopt;
}

// Runs of peers wait here with one point each; when all that live wait, one batch serves them.
class Desk {
 public:
  struct Closed {};
  struct Seat {
    const Twin* twin = nullptr;
    long used = 0;
    std::optional<long> reached;
    ParameterVector candidate;
    double cost = 0;
    bool waiting = false;
  };

  Desk(std::vector<Seat>& seats, long budget) : seats_(seats), budget_(budget), live_(static_cast<int>(seats.size())) {}

  double ask(Seat& seat, const Point& x) {
    if (seat.used >= budget_ || seat.reached) throw Closed{};
    std::unique_lock lock(mutex_);
    seat.candidate = seat.twin->candidate(x);
    seat.waiting = true;
    ++waiting_;
    changed_.notify_all();
    served_.wait(lock, [&] { return !seat.waiting; });
    ++seat.used;
    if (seat.cost <= seat.twin->goal()) seat.reached = seat.used;
    return seat.cost;
  }
  void leave() {
    const std::lock_guard lock(mutex_);
    --live_;
    changed_.notify_all();
  }
  void serve() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return waiting_ == live_; });
      if (live_ == 0) return;
      std::vector<Seat*> now;
      for (Seat& s : seats_)
        if (s.waiting) now.push_back(&s);
      std::vector<Trajectory> t(now.size());
      std::vector<Job> jobs;
      for (std::size_t i = 0; i < now.size(); ++i)
        jobs.push_back({&now[i]->twin->scenario(), &now[i]->candidate, &t[i]});
      simulate(jobs, {});
      for (std::size_t i = 0; i < now.size(); ++i) now[i]->cost = now[i]->twin->misfit(t[i]), now[i]->waiting = false;
      waiting_ = 0;
      served_.notify_all();
    }
  }

 private:
  std::vector<Seat>& seats_;
  long budget_;
  std::mutex mutex_;
  std::condition_variable changed_, served_;
  int live_, waiting_ = 0;
};

// reached[peer][seed]
std::vector<std::vector<std::optional<long>>> run_peers(const std::vector<Twin>& twins, long budget) {
  std::vector<Desk::Seat> seats(peers().size() * twins.size());
  for (std::size_t i = 0; i < seats.size(); ++i) seats[i].twin = &twins[i % twins.size()];
  Desk desk(seats, budget);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < seats.size(); ++i)
      threads.emplace_back([&, i] {
        try {
          const auto cost = [&](const Point& x) { return desk.ask(seats[i], x); };
          peers()[i / twins.size()].run(twins[0].n, cost, static_cast<unsigned>(1 + i % twins.size()));
        } catch (...) {  // the desk closed, or the method gave up
        }
        desk.leave();
      });
    desk.serve();
  }
  std::vector<std::vector<std::optional<long>>> out(peers().size());
  for (std::size_t i = 0; i < seats.size(); ++i) out[i / twins.size()].push_back(seats[i].reached);
  return out;
}

// Median with what never arrived as infinitely late; empty when that is the median.
std::optional<double> median_of(std::vector<std::optional<long>> v) {
  std::sort(v.begin(), v.end(), [](const auto& a, const auto& b) { return a && (!b || *a < *b); });
  const auto& middle = v[v.size() / 2];
  return middle ? std::optional<double>(static_cast<double>(*middle)) : std::nullopt;
}
nlohmann::ordered_json or_null(const std::optional<double>& x) {
  return x ? nlohmann::ordered_json(*x) : nlohmann::ordered_json(nullptr);
}

}  // namespace

void search_rows(Report& report, const Choice& choice) {
  const Scenario scenario = trace(seconds);
  for (const std::string& why : missing_peers()) report.json["reasons"]["best_peer"].push_back(why);
  for (const int n : {8, 15, 25}) {
    std::vector<Twin> twins;
    for (int seed = 1; seed <= choice.seeds; ++seed) twins.emplace_back(n, seed, scenario, 0);
    std::vector<std::optional<long>> used;
    for (int k = 0; k < choice.seeds; ++k) used.push_back(ours(twins[k], k + 1));
    const auto count = std::count_if(used.begin(), used.end(), [](const auto& u) { return u.has_value(); });
    const std::optional<double> median = median_of(used);
    long low = patience, high = 0;
    for (const auto& u : used)
      if (u) low = std::min(low, *u), high = std::max(high, *u);
    const std::string key = std::to_string(n);
    int redrawn = 0;
    for (const Twin& twin : twins) redrawn += twin.redrawn;
    report.json["simulations_to_floor"][key] = {{"median", or_null(median)}, {"successes", count},
                                                {"seeds", choice.seeds},     {"lowest", low},
                                                {"highest", high},           {"truths_drawn_again", redrawn}};
    report.add({fmt::format("simulations to 1.05 of the floor, {} parameters", n), "1000", "500",
                median ? fmt::format("{:.0f}", *median) : "-",
                fmt::format("{} of {} seeds, {} to {}; {} singing valves drawn again", count, choice.seeds, low, high,
                            redrawn)});

    if (peers().empty() || !median || choice.peer_budget <= 0) {
      report.json["best_peer"][key] = nullptr;
      if (choice.peer_budget <= 0) report.json["reasons"]["best_peer"].push_back("left out on request");
      continue;
    }
    const long budget = static_cast<long>(choice.peer_budget * *median);
    const auto reached = run_peers(twins, budget);
    std::size_t best = 0;
    const auto successes = [&](std::size_t p) {
      return std::count_if(reached[p].begin(), reached[p].end(), [](const auto& u) { return u.has_value(); });
    };
    for (std::size_t p = 0; p < reached.size(); ++p) {
      report.json["peers"][key][peers()[p].name] = {{"successes", successes(p)},
                                                    {"median", or_null(median_of(reached[p]))}};
      if (successes(p) > successes(best)) best = p;
    }
    const std::optional<double> theirs = median_of(reached[best]);
    report.json["best_peer"][key] = {
        {"name", peers()[best].name}, {"median", or_null(theirs)}, {"successes", successes(best)}, {"budget", budget}};
    report.add({fmt::format("the best of {} peers, {} parameters, over ours", peers().size(), n), "5x", "10x",
                theirs ? fmt::format("{:.1f}x", *theirs / *median) : fmt::format("over {:.0f}x", choice.peer_budget),
                fmt::format("{}: {} of {} seeds in {}", peers()[best].name, successes(best), choice.seeds, budget)});
  }
}

}  // namespace servodx::bench
