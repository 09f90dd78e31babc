#include "explain/smoother.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "base/normal.h"
#include "explain/constants.h"
#include "explain/kalman_filter.h"
#include "fit/error_model.h"

namespace servodx {
namespace {

using Index = std::size_t;
using namespace explain_constants::smoother;

std::vector<std::vector<double>> ones(const std::vector<LinearRun>& runs) {
  std::vector<std::vector<double>> out;
  for (const LinearRun& r : runs) out.emplace_back(r.channels.size(), 1.0);
  return out;
}

template <int N>
class Search {
 public:
  using F = KalmanFilter<N>;
  Search(const std::vector<LinearRun>& runs, const std::vector<LinearRun>& coarse)
      : fine_(runs),
        coarse_(coarse),
        coarse_runs_(coarse),
        duration_(longest_of(runs)),
        nothing_(),
        noise_(ones(runs)) {}

  // As unknown at the start as it becomes over the run.
  typename F::Walk walk(bool by_slope, double log_variance, std::vector<std::vector<double>> noise) const {
    const double variance = std::exp(log_variance), grown = variance * duration_;
    return {by_slope, variance, by_slope ? grown * duration_ * duration_ / 3 : grown, by_slope ? grown : 0.0,
            std::move(noise)};
  }
  // As large as they come out without anything missing.
  void without() {
    fine_.choose(-1, false), coarse_.choose(-1, false);
    typename F::Walk none{.noise = noise_};
    for (int round = 0; round < 2; ++round) none.noise = coarse_(none, F::Keep::sums).noise(none.noise);
    none.noise = fine_(none, F::Keep::sums).noise(none.noise);
    noise_ = none.noise;
    nothing_ = fine_(none, F::Keep::innovations);
  }
  // The walk and the noise of greatest likelihood.
  typename F::Walk at(int place, double typical) {
    const Step walks = most_likely(place, false, typical), slopes = most_likely(place, true, typical);
    const bool by_slope = slopes.log_likelihood > walks.log_likelihood;
    const Step& best = by_slope ? slopes : walks;
    fine_.choose(place, by_slope);
    typename F::Walk out = walk(by_slope, best.log_variance, best.noise);
    out.noise = fine_(out, F::Keep::sums).noise(out.noise);
    return out;
  }
  typename F::Pass smoothed(const typename F::Walk& walk) const { return fine_(walk, F::Keep::smoothed); }
  const typename F::Pass& nothing() const { return nothing_; }

 private:
  struct Step {
    double log_variance, log_likelihood;
    std::vector<std::vector<double>> noise;
  };
  // Along a path of falling intensity, since noise that has to grow does so at once; then closer about the best.
  Step most_likely(int place, bool by_slope, double typical) {
    coarse_.choose(place, by_slope);
    const auto look = [&](double at, const std::vector<std::vector<double>>& from) -> Step {
      typename F::Pass pass = coarse_(walk(by_slope, at, from), F::Keep::sums);
      std::vector<std::vector<double>> noise = pass.noise(from);
      if (!alike(noise, from)) {
        pass = coarse_(walk(by_slope, at, noise), F::Keep::sums);
        noise = pass.noise(noise);
      }
      return {at, pass.log_likelihood(), std::move(noise)};
    };
    const double most = by_slope ? most_by_slope : most_typical;
    const double first = std::log(most * most * typical * typical / walk(by_slope, 0.0, {}).start);
    Step best = look(first, ones(coarse_runs_)), last = best;
    for (int k = 1, falls = 0; k < longest_path && falls < 2; ++k) {
      Step next = look(first - k * step, last.noise);
      falls = next.log_likelihood < last.log_likelihood ? falls + 1 : 0;
      last = std::move(next);
      if (last.log_likelihood > best.log_likelihood) best = last;
    }
    for (double by = 0.5 * step; by > finest; by *= 0.5)
      for (const double side : {-by, by})
        if (Step s = look(best.log_variance + side, best.noise); s.log_likelihood > best.log_likelihood) {
          best = std::move(s);
          break;
        }
    return best;
  }
  static bool alike(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
    for (Index l = 0; l < a.size(); ++l)
      for (Index c = 0; c < a[l].size(); ++c)
        if (std::abs(a[l][c] - b[l][c]) > little * b[l][c]) return false;
    return true;
  }
  F fine_, coarse_;
  const std::vector<LinearRun>& coarse_runs_;
  double duration_;
  typename F::Pass nothing_;
  std::vector<std::vector<double>> noise_;
};

template <int N>
SmootherResult searched(const std::vector<LinearRun>& runs, const std::vector<double>& typical,
                        const std::function<bool(double)>& told) {
  const Index samples = samples_of(runs);
  std::vector<LinearRun> coarse;
  const auto stride = static_cast<int>((samples + search_samples - 1) / search_samples);
  for (const LinearRun& r : runs) coarse.push_back(thinned(r, stride));
  Search<N> search(runs, coarse);
  search.without();
  SmootherResult out;
  std::vector<typename KalmanFilter<N>::Pass> passes;
  Index best = 0;
  for (Index place = 0; place < typical.size(); ++place) {
    if (told && !told(static_cast<double>(place) / static_cast<double>(typical.size()))) break;
    const auto walk = search.at(static_cast<int>(place), typical[place]);
    passes.push_back(search.smoothed(walk));
    SmoothedInput& of = out.places.emplace_back();
    of.intensity = std::sqrt(walk.variance), of.by_slope = walk.by_slope;
    of.value = passes.back().value, of.noise = walk.noise;
    for (auto& run : of.noise)
      for (double& v : run) v = std::sqrt(v);
    for (const auto& run : passes.back().variance) {
      of.std_error.emplace_back();
      for (double v : run) of.std_error.back().push_back(std::sqrt(v));
    }
    if (passes.back().log_likelihood() > passes[best].log_likelihood()) best = place;
  }
  if (passes.empty()) return out;
  // News that are not news count by their memory, the same at every place.
  auto counts = ones(runs);
  const auto& news = passes[best].innovations;
  for (Index l = 0; l < counts.size(); ++l)
    for (Index c = 0; c < counts[l].size(); ++c) {
      if (news[l][c].size() > fewest_news) counts[l][c] = effective_fraction(news[l][c]);
      out.independent += counts[l][c] * static_cast<double>(news[l][c].size());
    }
  const double without = search.nothing().log_likelihood(&counts);
  for (Index place = 0; place < passes.size(); ++place) {
    SmoothedInput& of = out.places[place];
    of.log_likelihood = passes[place].log_likelihood(&counts);
    of.gain = of.log_likelihood - without;
    for (Index l = 0; l < counts.size(); ++l)
      for (Index b = 0; b < blocks; ++b) {
        double& sum = of.by_block.emplace_back(0.0);
        for (Index c = 0; c < counts[l].size(); ++c)
          sum += counts[l][c] * (passes[place].by_block[l][c][b] - search.nothing().by_block[l][c][b]);
      }
  }
  return out;
}

// The smallest filter that holds so many states.
template <class F>
auto of_size(Index states, F f) {
  if (states <= 8) return f(std::integral_constant<int, 8>{});
  if (states <= 16) return f(std::integral_constant<int, 16>{});
  if (states <= 20) return f(std::integral_constant<int, 20>{});
  if (states <= 24) return f(std::integral_constant<int, 24>{});
  return f(std::integral_constant<int, 32>{});
}

}  // namespace

bool preferred(const SmoothedInput& place, const SmoothedInput& to) {
  const double n = static_cast<double>(place.by_block.size()), mean = (place.gain - to.gain) / n;
  double square = 0;
  for (Index b = 0; b < place.by_block.size(); ++b)
    square += std::pow(place.by_block[b] - to.by_block[b] - mean, 2) / (n - 1);
  return n * mean > std::log(explain_constants::odds_of_a_place) &&
         n * mean > normal_95_one_sided * std::sqrt(n * square);
}

SmootherResult smooth(const std::vector<LinearRun>& runs, const std::vector<double>& typical,
                      const std::function<bool(double)>& told) {
  const std::vector<LinearRun> used = pruned(runs);
  return of_size(states_of(used) + 2, [&](auto n) { return searched<n>(used, typical, told); });
}

SmoothedInput smooth_at(const std::vector<LinearRun>& runs, int place, double intensity, double start) {
  const std::vector<LinearRun> used = pruned(runs);
  return of_size(states_of(used) + 2, [&](auto n) {
    using F = KalmanFilter<n>;
    F filter(used);
    filter.choose(place, false);
    const auto pass =
        filter({.variance = intensity * intensity, .start = start * start, .noise = ones(used)}, F::Keep::smoothed);
    SmoothedInput out;
    out.intensity = intensity;
    out.log_likelihood = pass.log_likelihood();
    out.value = pass.value, out.noise = ones(used);
    for (const auto& run : pass.variance) {
      out.std_error.emplace_back();
      for (double v : run) out.std_error.back().push_back(std::sqrt(v));
    }
    return out;
  });
}

}  // namespace servodx
