#include "explain/smoother.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "fit/error_model.h"

namespace servodx {
namespace {

using Index = std::size_t;
constexpr Index search_samples = 3000;      // of all runs: the intensity is searched for on so many
constexpr double step = 4.6, finest = 0.5;  // of the logarithm of the walk's variance: a factor of ten in intensity
constexpr int longest_path = 10;
constexpr double most_typical = 1e4;  // the path begins where the walk gets so many times the typical over the run

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

// Filter and smoother of N states at most, one of them the missing input, the last.
template <int N>
class KalmanFilter {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  static constexpr int w = N - 1;

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
  // What is missing enters here from now on; negative: nowhere.
  void choose(int place) {
    const auto n = static_cast<long>(states_of(runs_));
    for (Index l = 0; l < runs_.size(); ++l) {
      const LinearRun& r = runs_[l];
      for (Index k = 0; k < r.transition.size(); ++k) {
        Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
        if (place >= 0) b = r.transition[k].col(n + place);
        transition_[l][k].col(w).head(n) = b;
        for (Index c = 0; c < r.channels.size(); ++c)
          lagged_[l][k * r.channels.size() + c][w] = r.channels[c].shows.dot(b);
      }
    }
  }

  struct Walk {
    double variance = 0;                     // [unit2/s]
    double start = 0;                        // [unit2] variance at the first sample
    std::vector<std::vector<double>> noise;  // [run][channel] factor on the variance of the news
  };
  struct Pass {
    std::vector<std::vector<double>> surprise, square, samples;  // [run][channel] sums of ln F, of e2/F, of 1
    std::vector<std::vector<double>> own, own_square;            // the last two by the noise's share of F
    std::vector<std::vector<std::vector<double>>> innovations;   // [run][channel][sample], over their sigma
    std::vector<std::vector<double>> value, variance;            // [run][sample] of w; empty unless smoothed
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
    p(w, w) = walk.start;
    const auto update = [&](Index c, const Vector& row, double innovation, double variance) {
      const Vector ph = p * row;
      const double f = row.dot(ph) + variance, e = innovation - row.dot(x);
      const Vector gain = ph / f;
      x += gain * e;
      p.noalias() -= gain * ph.transpose();
      const double square = e * e / f, share = variance / f;
      out.surprise[l][c] += std::log(f), out.square[l][c] += square, out.samples[l][c] += 1;
      out.own[l][c] += share, out.own_square[l][c] += share * square;
      if (keep != Keep::sums) out.innovations[l][c].push_back(e / std::sqrt(f));
      if (smoothed) updates.push_back({&row, gain, e / f, 1 / f});
    };
    for (Index k = 0; k < samples; ++k) {
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
        p(w, w) += walk.variance * (r.time[k] - r.time[k - 1]);
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
  // b a^T for symmetric b; what is zero in a costs nothing.
  static Matrix times(const Matrix& a, const Matrix& b) {
    Matrix out;
    for (int j = 0; j < N; ++j) {
      Vector sum = Vector::Zero();
      for (int k = 0; k < N; ++k)
        if (const double f = a(j, k); f != 0) sum += f * b.col(k);
      out.col(j) = sum;
    }
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

  typename F::Walk walk(double log_variance, std::vector<std::vector<double>> noise) const {
    // As unknown at the start as it becomes over the run.
    const double variance = std::isfinite(log_variance) ? std::exp(log_variance) : 0;
    return {variance, variance * duration_, std::move(noise)};
  }
  // As large as they come out without anything missing.
  void without() {
    fine_.choose(-1), coarse_.choose(-1);
    typename F::Walk none = walk(-std::numeric_limits<double>::infinity(), noise_);
    for (int round = 0; round < 2; ++round) none.noise = coarse_(none, F::Keep::sums).noise(none.noise);
    none.noise = fine_(none, F::Keep::sums).noise(none.noise);
    noise_ = none.noise;
    nothing_ = fine_(none, F::Keep::innovations);
  }
  // The intensity and the noise of greatest likelihood: along a path of falling intensity, since noise that has to grow
  // does so at once.
  typename F::Walk at(int place, double typical) {
    fine_.choose(place), coarse_.choose(place);
    struct Step {
      double log_variance, log_likelihood;
      std::vector<std::vector<double>> noise;
    };
    const auto look = [&](double at_log, std::vector<std::vector<double>> noise) -> Step {
      noise = coarse_(walk(at_log, noise), F::Keep::sums).noise(noise);
      const typename F::Pass pass = coarse_(walk(at_log, noise), F::Keep::sums);
      return {at_log, pass.log_likelihood(), pass.noise(noise)};
    };
    const double first = std::log(most_typical * most_typical * typical * typical / duration_);
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
    typename F::Walk out = walk(best.log_variance, best.noise);
    out.noise = fine_(out, F::Keep::sums).noise(out.noise);
    return out;
  }
  typename F::Pass smoothed(const typename F::Walk& walk) const { return fine_(walk, F::Keep::smoothed); }
  const typename F::Pass& nothing() const { return nothing_; }

 private:
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
  const auto stride = static_cast<int>(std::max<Index>(1, samples / search_samples));
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
    of.intensity = std::sqrt(walk.variance);
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
  }
  return out;
}

// The smallest filter that holds so many states.
template <class F>
auto of_size(Index states, F f) {
  if (states <= 4) return f(std::integral_constant<int, 4>{});
  if (states <= 16) return f(std::integral_constant<int, 16>{});
  if (states <= 20) return f(std::integral_constant<int, 20>{});
  return f(std::integral_constant<int, 32>{});
}

}  // namespace

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
  return of_size(states_of(used) + 1, [&](auto n) { return searched<n>(used, typical, told); });
}

SmoothedInput smooth_at(const std::vector<LinearRun>& runs, int place, double intensity, double start) {
  const std::vector<LinearRun> used = pruned(runs);
  return of_size(states_of(used) + 1, [&](auto n) {
    using F = KalmanFilter<n>;
    F filter(used);
    filter.choose(place);
    const auto pass = filter({intensity * intensity, start * start, ones(used)}, F::Keep::smoothed);
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
