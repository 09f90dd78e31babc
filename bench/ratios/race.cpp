#include "ratios/race.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "base/random.h"
#include "optimise/box_least_squares.h"
#include "ratios/peers.h"
#include "simulate/together.h"

namespace servodx::bench {
namespace {

constexpr long patience = 5000;  // evaluations of ours before a seed counts as failed

long arrived(const std::vector<std::optional<long>>& v) {
  return std::count_if(v.begin(), v.end(), [](const auto& u) { return u.has_value(); });
}

}  // namespace

double misfit(const Evaluation& e) { return e.ok ? 0.5 * e.residual.squaredNorm() : 1e12; }

std::optional<long> ours(const Objective& objective, int seed, long patience, double* least) {
  constexpr int spread = 16;
  LeastSquaresProblem problem;
  problem.n = objective.n;
  problem.evaluate = objective.evaluate;
  LeastSquaresOptions o;
  o.difference = Difference::forward;
  o.difference_step = 1e-4;
  o.damping_trials = 1;  // every lane counts here; a fit gets eight in the pack of one
  o.least_metric = o.from_afar;
  o.cost_goal = objective.goal;
  o.slow_iterations = 5;
  long used = 0;
  for (std::uint32_t round = 0; used < patience; ++round) {
    std::vector<Point> points;
    for (std::uint32_t k = 0; k < spread; ++k) {
      Random random(static_cast<std::uint64_t>(seed), 9, round, k);
      Point x;
      for (int j = 0; j < objective.n; ++j) x.push_back(random.uniform());
      points.push_back(std::move(x));
    }
    std::vector<std::pair<double, int>> order;
    const std::vector<Evaluation> first = objective.evaluate(points);
    used += spread;
    for (int k = 0; k < spread; ++k)
      if (first[k].ok) order.push_back({first[k].residual.squaredNorm(), k});
    std::sort(order.begin(), order.end());
    for (std::size_t k = 0; k < std::min<std::size_t>(2, order.size()) && used < patience; ++k) {
      o.max_evaluations = patience - used;
      const LeastSquaresResult r = minimise_least_squares(problem, points[order[k].second], o);
      used += r.evaluations;
      if (least) *least = std::min(*least, r.misfit);
      if (r.misfit <= objective.goal) return used;
    }
  }
  return std::nullopt;
}

std::vector<std::vector<std::optional<long>>> run_peers(const std::vector<Objective>& objectives, long budget) {
  struct Closed {};
  const std::size_t n = objectives.size();
  std::vector<std::vector<std::optional<long>>> reached(peers().size(), std::vector<std::optional<long>>(n));
  together(static_cast<int>(peers().size() * n), 0, [&](int i) {
    const std::size_t peer = static_cast<std::size_t>(i) / n, k = static_cast<std::size_t>(i) % n;
    const Objective mine = objectives[k];  // with a count of runs of its own
    std::optional<long>& arrival = reached[peer][k];
    long used = 0;
    const auto cost = [&](const Point& x) {
      if (used >= budget || arrival) throw Closed{};
      const double found = misfit(mine.evaluate(std::span(&x, 1)).front());
      ++used;
      if (found <= mine.goal) arrival = used;
      return found;
    };
    try {
      peers()[peer].run(mine.n, cost, static_cast<unsigned>(1 + k));
    } catch (...) {  // closed, or the method gave up
    }
  });
  return reached;
}

std::optional<double> median_arrival(std::vector<std::optional<long>> v) {
  std::sort(v.begin(), v.end(), [](const auto& a, const auto& b) { return a && (!b || *a < *b); });
  const auto& middle = v[v.size() / 2];
  return middle ? std::optional<double>(static_cast<double>(*middle)) : std::nullopt;
}

nlohmann::ordered_json or_null(const std::optional<double>& x) {
  return x ? nlohmann::ordered_json(*x) : nlohmann::ordered_json(nullptr);
}

void race(Report& report, const Choice& choice, const std::string& what, const std::string& prefix,
          const std::vector<Objective>& objectives, nlohmann::ordered_json said) {
  const int n = objectives.front().n;
  const std::string key = std::to_string(n);
  std::vector<std::optional<long>> used(objectives.size());
  together(static_cast<int>(used.size()), 0, [&](int k) {
    used[static_cast<std::size_t>(k)] = ours(objectives[static_cast<std::size_t>(k)], k + 1, patience);
  });
  const std::optional<double> median = median_arrival(used);
  long low = patience, high = 0;
  for (const auto& u : used)
    if (u) low = std::min(low, *u), high = std::max(high, *u);
  nlohmann::ordered_json& mine = report.json[prefix + "simulations_to_floor"][key];
  mine = {{"median", or_null(median)},
          {"successes", arrived(used)},
          {"seeds", objectives.size()},
          {"lowest", low},
          {"highest", high}};
  if (said.is_object()) mine.update(said);
  report.add({fmt::format("simulations to 1.05 of the floor, {} parameters{}", n, what), "1000", "500",
              median ? fmt::format("{:.0f}", *median) : "-",
              fmt::format("{} of {} seeds, {} to {}", arrived(used), objectives.size(), low, high)});

  nlohmann::ordered_json& theirs = report.json[prefix + "best_peer"][key];
  theirs = nullptr;
  for (const std::string& why : missing_peers()) report.excuse(prefix + "best_peer", why);
  const std::string row = fmt::format("the best of {} peers, {} parameters{}, over ours", peers().size(), n, what);
  if (peers().empty() || !median || choice.peer_budget <= 0) {
    const std::string why = peers().empty() ? "no peer is installed"
                            : !median       ? "ours does not arrive in the median"
                                            : "peers were left out";
    report.excuse(prefix + "best_peer", why);
    report.add({row, "5x", "10x", "-", why});
    return;
  }
  const long budget = static_cast<long>(choice.peer_budget * *median);
  const auto reached = run_peers(objectives, budget);
  std::size_t best = 0;
  for (std::size_t p = 0; p < reached.size(); ++p) {
    report.json[prefix + "peers"][key][peers()[p].name] = {{"successes", arrived(reached[p])},
                                                           {"median", or_null(median_arrival(reached[p]))}};
    if (arrived(reached[p]) > arrived(reached[best])) best = p;
  }
  const std::optional<double> arrival = median_arrival(reached[best]);
  const long first = arrived(reached[best]);
  theirs = {{"name", first > 0 ? nlohmann::ordered_json(peers()[best].name) : nlohmann::ordered_json(nullptr)},
            {"median", or_null(arrival)},
            {"successes", first},
            {"budget", budget}};
  report.add({row, "5x", "10x",
              arrival ? fmt::format("{:.1f}x", *arrival / *median) : fmt::format("over {:.0f}x", choice.peer_budget),
              fmt::format("{}, {} of {} seeds in {} simulations", first > 0 ? peers()[best].name : "none arrives",
                          first, objectives.size(), budget)});
}

}  // namespace servodx::bench
