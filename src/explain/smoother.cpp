#include "explain/smoother.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "fit/error_model.h"

namespace servodx {
namespace {

using Index = std::size_t;
constexpr Index blocks = 16;                // of time, of each run
constexpr Index search_samples = 1500;      // of all runs: the intensity is searched for on so many
constexpr double step = 4.6, finest = 0.5;  // of the logarithm of the walk's variance: a factor of ten in intensity
constexpr int longest_path = 12;
// The path begins where the walk gets so many times the typical over the run.
constexpr double most_typical = 1e3, most_by_slope = 1e5;

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
    double log_likelihood(const std::vector<std::vector<double>>* counts = nullptr) const {
      double sum = 0;
      for (Index l = 0; l < surprise.size(); ++l)
        for (Index c = 0; c < surprise[l].size(); ++c)
          sum -= 0.5 * (counts ? (*counts)[l][c] : 1.0) *
                 (surprise[l][c] + square[l][c] + samples[l][c] * std::log(2 * std::numbers::pi));
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
  struct Update {  // by one sample of one channel
    const Vector* row;
    Vector gain;
    double weighed, precision;  // innovation over its variance, 1 over its variance
  };
  struct Kept {
    Vector covariance;  // of all with w
    double w;
    Index lagged, fresh;  // updates up to here: before the step that led here, and after it
  };

  void run(Index l, const Walk& walk, Keep keep, Pass& out) const {
    const LinearRun& r = runs_[l];
    const auto n = static_cast<long>(states_of(runs_));
    const Index samples = r.time.size(), channels = r.channels.size();
    const bool smoothed = keep == Keep::smoothed;
    out.surprise.emplace_back(channels, 0.0), out.square.emplace_back(channels, 0.0);
    out.samples.emplace_back(channels, 0.0), out.innovations.emplace_back(channels);
    out.own.emplace_back(channels, 0.0), out.own_square.emplace_back(channels, 0.0);
    out.by_block.emplace_back(channels);
    Index block = 0;
    std::vector<Vector> shows;
    for (const LinearChannel& c : r.channels) {
      shows.push_back(Vector::Zero());
      shows.back().head(n) = c.shows;
    }
    std::vector<Update> updates;
    std::vector<Kept> kept;
    if (smoothed) updates.reserve(samples * channels), kept.reserve(samples);
    Vector x = Vector::Zero();
    Matrix p = Matrix::Zero();
    p.diagonal().head(n) = r.start.cwiseAbs2();
    p(w, w) = walk.start, p(slope, slope) = walk.slope_start;
    const int walks = walk.by_slope ? slope : w;
    const auto update = [&](Index c, const Vector& row, double innovation, double variance) {
      const Vector ph = p * row;
      const double f = row.dot(ph) + variance, e = innovation - row.dot(x);
      const Vector gain = ph / f;
      x += gain * e;
      p.noalias() -= gain * ph.transpose();
      const double square = e * e / f, share = variance / f, surprise = std::log(f);
      out.by_block[l][c][block] -= 0.5 * (surprise + square);
      out.surprise[l][c] += surprise, out.square[l][c] += square, out.samples[l][c] += 1;
      out.own[l][c] += share, out.own_square[l][c] += share * square;
      if (keep != Keep::sums) out.innovations[l][c].push_back(e / std::sqrt(f));
      if (smoothed) updates.push_back({&row, gain, e / f, 1 / f});
    };
    for (Index k = 0; k < samples; ++k) {
      block = k * blocks / samples;
      const auto follows = [&](const LinearChannel& c) { return k > 0 && std::isfinite(c.residual[k - 1]); };
      if (k > 0) {
        for (Index c = 0; c < channels; ++c) {
          const LinearChannel& of = r.channels[c];
          if (!std::isfinite(of.residual[k]) || !follows(of)) continue;
          update(c, lagged_[l][(k - 1) * channels + c], of.residual[k] - of.memory * of.residual[k - 1],
                 walk.noise[l][c] * of.sigma[k] * of.sigma[k]);
        }
      }
      const Index lagged = updates.size();
      if (k > 0) {
        const Matrix& a = transition_[l][k - 1];
        x = a * x;
        p = times(a, times(a, p).transpose());
        p(walks, walks) += walk.variance * (r.time[k] - r.time[k - 1]);
      }
      for (Index c = 0; c < channels; ++c) {
        const LinearChannel& of = r.channels[c];
        if (!std::isfinite(of.residual[k]) || follows(of)) continue;
        update(c, shows[c], of.residual[k], walk.noise[l][c] * of.sigma[k] * of.sigma[k] / (1 - of.memory * of.memory));
      }
      if (smoothed) kept.push_back({p.col(w), x[w], lagged, updates.size()});
    }
    if (!smoothed) return;
    auto& value = out.value.emplace_back(samples);
    auto& variance = out.variance.emplace_back(samples);
    Vector adjoint = Vector::Zero();
    Matrix information = Matrix::Zero();
    const auto undo = [&](Index from, Index to) {
      while (to > from) {
        const Update& u = updates[--to];
        const Vector by = information * u.gain;
        const Vector half = by - 0.5 * (u.gain.dot(by) + u.precision) * *u.row;
        adjoint += *u.row * (u.weighed - u.gain.dot(adjoint));
        information -= *u.row * half.transpose() + half * u.row->transpose();
      }
    };
    for (Index k = samples; k-- > 0;) {
      const Kept& at = kept[k];
      value[k] = at.w + at.covariance.dot(adjoint);
      variance[k] = std::max(0.0, at.covariance[w] - at.covariance.dot(information * at.covariance));
      undo(at.lagged, at.fresh);
      if (k == 0) break;
      const Matrix& a = transition_[l][k - 1];
      adjoint = a.transpose() * adjoint;
      const Matrix turned = a.transpose();
      information = times(turned, times(turned, information).transpose());
      undo(kept[k - 1].fresh, at.lagged);
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
    constexpr double little = 0.01;
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
      if (news[l][c].size() > 8) counts[l][c] = effective_fraction(news[l][c]);
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
  return n * mean > std::log(20.0) && n * mean > 1.645 * std::sqrt(n * square);
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
