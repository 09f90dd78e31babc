// Filter and fixed-interval smoother of a linear run with something missing at one place: a random walk, or the
// integral of one, as one more state (smoother.h has the equations and their sources).
//
// Of N states at most, two of them the missing input and its slope, the last. It is told where the walk enters, how
// strong it is and how large each channel's news are; what those are is the search's to find.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/two_pi.h"
#include "explain/constants.h"
#include "explain/linear_run.h"
#include "explain/packed_product.h"

namespace servodx {

template <int N>
class KalmanFilter {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using Index = std::size_t;
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
    std::vector<std::vector<double>> surprise, square, samples;  // [run][channel] sums of ln F, of e2/F, of 1
    std::vector<std::vector<double>> own, own_square;            // the last two by the noise's share of F
    std::vector<std::vector<std::array<double, explain_constants::smoother::blocks>>>
        by_block;                                               // [run][channel] log likelihood but for a constant
    std::vector<std::vector<std::vector<double>>> innovations;  // [run][channel][sample], over their sigma
    std::vector<std::vector<double>> value, variance;           // [run][sample] of w; empty unless smoothed
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

  // A sample of a channel is present, and it follows one: what the one before leaves is then differenced away.
  static bool is_present(const LinearChannel& c, Index k) { return std::isfinite(c.residual[k]); }
  static bool follows(const LinearChannel& c, Index k) { return k > 0 && is_present(c, k - 1); }

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
      out.add(l, c, k * explain_constants::smoother::blocks / samples, e, f, reading.variance);
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

}  // namespace servodx
