#include "explain/smoother.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/normal.h"
#include "base/two_pi.h"
#include "explain/constants.h"
#include "fit/error_model.h"

namespace servodx {
namespace {

using Index = std::size_t;
using namespace explain_constants::smoother;

Index states_of(const std::vector<LinearRun>& runs) { return static_cast<Index>(runs.front().start.size()); }
Index samples_of(const std::vector<LinearRun>& runs) {
  Index n = 0;
  for (const LinearRun& r : runs) n += r.time.size();
  return n;
}

// Without the states that no input, and nothing unknown at the start, ever reaches, or that no channel ever shows.
std::vector<LinearRun> pruned(const std::vector<LinearRun>& runs) {
  const auto n = static_cast<long>(states_of(runs)), m = runs.front().transition.front().cols() - n;
  Eigen::MatrixXd any = Eigen::MatrixXd::Zero(n, n + m);
  Eigen::VectorXd reached = Eigen::VectorXd::Zero(n), seen = reached;
  for (const LinearRun& r : runs) {
    for (const Eigen::MatrixXd& t : r.transition) any += (t.array() != 0).cast<double>().matrix();
    reached += r.start.cwiseAbs();
    for (const LinearChannel& c : r.channels) seen += c.shows.cwiseAbs();
  }
  const Eigen::MatrixXd among = any.leftCols(n);
  reached += any.rightCols(m).rowwise().sum();
  const auto ones = [](const Eigen::VectorXd& v) -> Eigen::VectorXd { return (v.array() != 0).cast<double>(); };
  for (long k = 0; k < n; ++k) {
    reached = ones(reached + among * ones(reached));
    seen = ones(seen + among.transpose() * ones(seen));
  }
  std::vector<long> kept;
  for (long i = 0; i < n; ++i)
    if (reached[i] != 0 && seen[i] != 0) kept.push_back(i);
  std::vector<long> columns = kept;
  for (long p = 0; p < m; ++p) columns.push_back(n + p);
  std::vector<LinearRun> out;
  for (const LinearRun& r : runs) {
    LinearRun& to = out.emplace_back(LinearRun{r.time, {}, r.start(kept), {}});
    for (const Eigen::MatrixXd& t : r.transition) to.transition.push_back(t(kept, columns));
    for (const LinearChannel& c : r.channels) to.channels.push_back({c.shows(kept), c.residual, c.sigma, c.memory});
  }
  return out;
}

// out = b a^T, columns one after another: nearly all of the time. What is zero in a costs nothing.
template <int N>
inline __attribute__((always_inline)) void product(const double* a, const double* b, double* out) {
  typedef double V __attribute__((vector_size(32), aligned(8), may_alias));
  constexpr int width = 4;
  static_assert(N % width == 0);
  for (int j = 0; j < N; ++j) {
    V sum[N / width] = {};
    for (int k = 0; k < N; ++k) {
      const double f = a[k * N + j];
      if (f == 0) continue;
      const V* column = reinterpret_cast<const V*>(b + k * N);
      for (int i = 0; i < N / width; ++i) sum[i] += f * column[i];
    }
    for (int i = 0; i < N / width; ++i) reinterpret_cast<V*>(out + j * N)[i] = sum[i];
  }
}
template <int N>
void product_anywhere(const double* a, const double* b, double* out) {
  product<N>(a, b, out);
}
#if defined(__x86_64__)
template <int N>
__attribute__((target("avx2"))) void product_avx2(const double* a, const double* b, double* out) {
  product<N>(a, b, out);
}
#endif
template <int N>
auto best_product() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return &product_avx2<N>;
#endif
  return &product_anywhere<N>;
}

// A sample of a channel is present, and it follows one: what the one before leaves is then differenced away.
bool is_present(const LinearChannel& c, Index k) { return std::isfinite(c.residual[k]); }
bool follows(const LinearChannel& c, Index k) { return k > 0 && is_present(c, k - 1); }

// Filter and smoother of N states at most, two of them the missing input and its slope, the last.
template <int N>
class KalmanFilter {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  static constexpr int w = N - 2, slope = N - 1;

  explicit KalmanFilter(const std::vector<LinearRun>& runs) : runs_(runs) {
    const auto n = static_cast<long>(states_of(runs));
    for (const LinearRun& r : runs) {
      auto& matrices = transition_.emplace_back();
      auto& rows = lagged_.emplace_back();
      for (const Eigen::MatrixXd& t : r.transition) {
        Matrix& a = matrices.emplace_back(Matrix::Identity());
        a.topLeftCorner(n, n) = t.leftCols(n);
        for (const LinearChannel& c : r.channels) {
          Vector& row = rows.emplace_back(Vector::Zero());
          row.head(n) = t.leftCols(n).transpose() * c.shows - c.memory * c.shows;
        }
      }
    }
  }
  // What is missing enters here from now on; negative: nowhere. It is a walk, or its slope is.
  void choose(int place, bool by_slope) {
    const auto n = static_cast<long>(states_of(runs_));
    for (Index l = 0; l < runs_.size(); ++l) {
      const LinearRun& r = runs_[l];
      for (Index k = 0; k < r.transition.size(); ++k) {
        Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
        if (place >= 0) b = r.transition[k].col(n + place);
        transition_[l][k].col(w).head(n) = b;
        transition_[l][k](w, slope) = by_slope ? r.time[k + 1] - r.time[k] : 0.0;
        for (Index c = 0; c < r.channels.size(); ++c)
          lagged_[l][k * r.channels.size() + c][w] = r.channels[c].shows.dot(b);
      }
    }
  }

  struct Walk {
    bool by_slope = false;                   // the slope walks
    double variance = 0;                     // [unit2/s], or of the slope [unit2/s3]
    double start = 0, slope_start = 0;       // [unit2], [unit2/s2] variance at the first sample
    std::vector<std::vector<double>> noise;  // [run][channel] factor on the variance of the news
  };
  struct Pass {
    std::vector<std::vector<double>> surprise, square, samples;     // [run][channel] sums of ln F, of e2/F, of 1
    std::vector<std::vector<double>> own, own_square;               // the last two by the noise's share of F
    std::vector<std::vector<std::array<double, blocks>>> by_block;  // [run][channel] log likelihood but for a constant
    std::vector<std::vector<std::vector<double>>> innovations;      // [run][channel][sample], over their sigma
    std::vector<std::vector<double>> value, variance;               // [run][sample] of w; empty unless smoothed
    void open_run(Index channels) {
      for (auto* sums : {&surprise, &square, &samples, &own, &own_square}) sums->emplace_back(channels, 0.0);
      innovations.emplace_back(channels), by_block.emplace_back(channels);
    }
    // An innovation of variance f, of which `noise` is the channel's own.
    void add(Index l, Index c, Index block, double innovation, double f, double noise) {
      const double e2 = innovation * innovation / f, share = noise / f, log_f = std::log(f);
      by_block[l][c][block] -= 0.5 * (log_f + e2);
      surprise[l][c] += log_f, square[l][c] += e2, samples[l][c] += 1;
      own[l][c] += share, own_square[l][c] += share * e2;
    }
    double log_likelihood(const std::vector<std::vector<double>>* counts = nullptr) const {
      double sum = 0;
      for (Index l = 0; l < surprise.size(); ++l)
        for (Index c = 0; c < surprise[l].size(); ++c)
          sum -= 0.5 * (counts ? (*counts)[l][c] : 1.0) *
                 (surprise[l][c] + square[l][c] + samples[l][c] * std::log(two_pi));
      return sum;
    }
    // News as large as they come out: where the likelihood has no slope against them.
    std::vector<std::vector<double>> noise(std::vector<std::vector<double>> now) const {
      for (Index l = 0; l < now.size(); ++l)
        for (Index c = 0; c < now[l].size(); ++c)
          if (own[l][c] > 0) now[l][c] = std::max(1.0, now[l][c] * own_square[l][c] / own[l][c]);
      return now;
    }
  };
  enum class Keep { sums, innovations, smoothed };

  Pass operator()(const Walk& walk, Keep keep) const {
    Pass out;
    for (Index l = 0; l < runs_.size(); ++l) run(l, walk, keep, out);
    return out;
  }

 private:
  struct Belief {
    Vector x;
    Matrix p;  // its covariance
  };
  struct Reading {  // value = row x + noise of that variance
    const Vector* row;
    double value, variance;
  };
  struct Update {  // by one reading
    const Vector* row;
    Vector gain;
    double weighed, precision;  // innovation over its variance, 1 over its variance
  };
  struct Kept {
    Vector covariance;  // of all with w
    double w;
    Index lagged, fresh;  // updates up to here: before the step that led here, and after it
  };
  struct History {  // what the smoother needs of a run
    std::vector<Update> updates;
    std::vector<Kept> kept;  // [sample]
  };
  struct Adjoint {  // what later samples say of the state
    Vector value = Vector::Zero();
    Matrix information = Matrix::Zero();
  };

  void run(Index l, const Walk& walk, Keep keep, Pass& out) const {
    const LinearRun& r = runs_[l];
    const Index samples = r.time.size(), channels = r.channels.size();
    const std::vector<Vector> shows = shown_by(r);
    History history;
    if (keep == Keep::smoothed) history.updates.reserve(samples * channels), history.kept.reserve(samples);
    out.open_run(channels);
    Belief now = before(r, walk);
    const auto take = [&](Index c, Index k, const Reading& reading) {
      const Vector ph = now.p * *reading.row;
      const double f = reading.row->dot(ph) + reading.variance, e = reading.value - reading.row->dot(now.x);
      const Vector gain = ph / f;
      now.x += gain * e;
      now.p.noalias() -= gain * ph.transpose();
      out.add(l, c, k * blocks / samples, e, f, reading.variance);
      if (keep != Keep::sums) out.innovations[l][c].push_back(e / std::sqrt(f));
      if (keep == Keep::smoothed) history.updates.push_back({reading.row, gain, e / f, 1 / f});
    };
    for (Index k = 0; k < samples; ++k) {
      for (Index c = 0; c < channels; ++c)
        if (is_present(r.channels[c], k) && follows(r.channels[c], k)) take(c, k, lagged_reading(l, c, k, walk));
      const Index lagged = history.updates.size();
      if (k > 0) step(l, k, walk, now);
      for (Index c = 0; c < channels; ++c)
        if (is_present(r.channels[c], k) && !follows(r.channels[c], k))
          take(c, k, fresh_reading(l, c, k, walk, shows[c]));
      if (keep == Keep::smoothed) history.kept.push_back({now.p.col(w), now.x[w], lagged, history.updates.size()});
    }
    if (keep == Keep::smoothed) smooth(l, history, out);
  }

  static std::vector<Vector> shown_by(const LinearRun& r) {
    std::vector<Vector> out;
    for (const LinearChannel& c : r.channels) out.emplace_back(Vector::Zero()).head(c.shows.size()) = c.shows;
    return out;
  }
  // Of the first sample, before it is read.
  static Belief before(const LinearRun& r, const Walk& walk) {
    Belief out{Vector::Zero(), Matrix::Zero()};
    out.p.diagonal().head(r.start.size()) = r.start.cwiseAbs2();
    out.p(w, w) = walk.start, out.p(slope, slope) = walk.slope_start;
    return out;
  }
  // What a sample says beyond the one before, of the state there.
  Reading lagged_reading(Index l, Index c, Index k, const Walk& walk) const {
    const LinearChannel& of = runs_[l].channels[c];
    return {&lagged_[l][(k - 1) * runs_[l].channels.size() + c], of.residual[k] - of.memory * of.residual[k - 1],
            walk.noise[l][c] * of.sigma[k] * of.sigma[k]};
  }
  // What a sample says by itself: noise that nothing is known of before has its whole variance.
  Reading fresh_reading(Index l, Index c, Index k, const Walk& walk, const Vector& shows) const {
    const LinearChannel& of = runs_[l].channels[c];
    return {&shows, of.residual[k], walk.noise[l][c] * of.sigma[k] * of.sigma[k] / (1 - of.memory * of.memory)};
  }
  // From the sample before to the k-th.
  void step(Index l, Index k, const Walk& walk, Belief& now) const {
    const Matrix& a = transition_[l][k - 1];
    const std::vector<double>& time = runs_[l].time;
    const int walks = walk.by_slope ? slope : w;
    now.x = a * now.x;
    now.p = times(a, times(a, now.p).transpose());
    now.p(walks, walks) += walk.variance * (time[k] - time[k - 1]);
  }

  // Backwards through the updates and steps of a run.
  void smooth(Index l, const History& history, Pass& out) const {
    const Index samples = history.kept.size();
    auto& value = out.value.emplace_back(samples);
    auto& variance = out.variance.emplace_back(samples);
    Adjoint later;
    for (Index k = samples; k-- > 0;) {
      const Kept& at = history.kept[k];
      value[k] = at.w + at.covariance.dot(later.value);
      variance[k] = std::max(0.0, at.covariance[w] - at.covariance.dot(later.information * at.covariance));
      undo(history, at.lagged, at.fresh, later);
      if (k == 0) break;
      const Matrix& a = transition_[l][k - 1];
      const Matrix turned = a.transpose();
      later.value = a.transpose() * later.value;
      later.information = times(turned, times(turned, later.information).transpose());
      undo(history, history.kept[k - 1].fresh, at.lagged, later);
    }
  }
  static void undo(const History& history, Index from, Index to, Adjoint& later) {
    while (to > from) {
      const Update& u = history.updates[--to];
      const Vector by = later.information * u.gain;
      const Vector half = by - 0.5 * (u.gain.dot(by) + u.precision) * *u.row;
      later.value += *u.row * (u.weighed - u.gain.dot(later.value));
      later.information -= *u.row * half.transpose() + half * u.row->transpose();
    }
  }
  static Matrix times(const Matrix& a, const Matrix& b) {
    static const auto best = best_product<N>();
    Matrix out;
    best(a.data(), b.data(), out.data());
    return out;
  }

  const std::vector<LinearRun>& runs_;
  std::vector<std::vector<Matrix>> transition_;  // [run][sample]
  std::vector<std::vector<Vector>> lagged_;      // [run][sample, channel] what the next sample's news show of a state
};

std::vector<std::vector<double>> ones(const std::vector<LinearRun>& runs) {
  std::vector<std::vector<double>> out;
  for (const LinearRun& r : runs) out.emplace_back(r.channels.size(), 1.0);
  return out;
}

double duration_of(const std::vector<LinearRun>& runs) {
  double longest_run = 0;
  for (const LinearRun& r : runs) longest_run = std::max(longest_run, r.time.back() - r.time.front());
  return longest_run;
}

template <int N>
class Search {
 public:
  using F = KalmanFilter<N>;
  Search(const std::vector<LinearRun>& runs, const std::vector<LinearRun>& coarse)
      : fine_(runs),
        coarse_(coarse),
        coarse_runs_(coarse),
        duration_(duration_of(runs)),
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

LinearRun thinned(const LinearRun& run, int stride) {
  if (stride <= 1) return run;
  const auto s = static_cast<Index>(stride);
  const long n = run.start.size(), m = run.transition.front().cols() - n;
  LinearRun out{{}, {}, run.start, {}};
  for (const LinearChannel& c : run.channels) {
    const double a = std::pow(c.memory, stride);
    LinearChannel& to = out.channels.emplace_back(LinearChannel{c.shows, {}, {}, a});
    // News of several samples, the older ones remembered.
    const double grown = c.memory > 0 ? std::sqrt((1 - a * a) / (1 - c.memory * c.memory)) : 1.0;
    for (Index k = 0; k < run.time.size(); k += s)
      to.residual.push_back(c.residual[k]), to.sigma.push_back(grown * c.sigma[k]);
  }
  for (Index k = 0; k < run.time.size(); k += s) {
    out.time.push_back(run.time[k]);
    if (k + s >= run.time.size()) break;
    Eigen::MatrixXd whole = run.transition[k];
    for (Index j = k + 1; j < k + s; ++j) {
      const Eigen::MatrixXd& next = run.transition[j];
      whole = (next.leftCols(n) * whole).eval();
      whole.rightCols(m) += next.rightCols(m);
    }
    out.transition.push_back(std::move(whole));
  }
  return out;
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
