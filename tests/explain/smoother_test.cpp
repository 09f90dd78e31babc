// The smoother of a missing input against sums that can be done otherwise, on models of a few lines: it knows no valve.
#include "explain/smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "explain/linear_run.h"

namespace servodx {
namespace {

constexpr double mass = 2.0, spring = 30.0, damping = 1.5, dt = 0.01, noise = 1e-4;

// A mass on a spring, what is missing a force (place 0) or a speed of the spring's foot (place 1); states: position,
// speed, stretch of the spring. Position and, where asked for, the spring's force are shown.
LinearRun bench(Eigen::Index samples, bool force_shown, double memory = 0) {
  Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(5, 5);
  rate(0, 1) = 1;
  rate(1, 2) = -spring / mass, rate(1, 1) = -damping / mass, rate(1, 3) = 1 / mass;
  rate(2, 1) = 1, rate(2, 4) = -1;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Identity(5, 5);
  for (int k = 0; k < 1000; ++k) whole = (whole + rate * whole * (dt / 1000)).eval();
  LinearRun run;
  for (Eigen::Index k = 0; k < samples; ++k) run.time.push_back(static_cast<double>(k) * dt);
  run.transition.assign(static_cast<std::size_t>(samples - 1), whole.topRows(3));
  run.start = Eigen::Vector3d(noise, 1e-3, 0);
  const auto n = static_cast<std::size_t>(samples);
  run.channels.push_back({Eigen::Vector3d(1, 0, 0), std::vector<double>(n), std::vector<double>(n, noise), memory});
  if (force_shown)
    run.channels.push_back(
        {Eigen::Vector3d(0, 0, spring), std::vector<double>(n), std::vector<double>(n, 10 * noise), memory});
  return run;
}

// The residuals that w(t) at a place leaves, with noise; a seed each.
template <class W>
void fill(LinearRun& run, int place, W w, std::uint32_t seed) {
  Random random(seed, 0);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
  for (Eigen::Index i = 0; i < 3; ++i) x[i] = random.normal(0.0, run.start[i]);
  std::vector<double> last(run.channels.size(), 0.0);
  for (std::size_t k = 0; k < run.time.size(); ++k) {
    if (k > 0) x = run.transition[k - 1].leftCols(3) * x + run.transition[k - 1].col(3 + place) * w(run.time[k - 1]);
    for (std::size_t c = 0; c < run.channels.size(); ++c) {
      LinearChannel& channel = run.channels[c];
      const double a = channel.memory, news = random.normal(0.0, channel.sigma[k]);
      last[c] = k == 0 ? news / std::sqrt(1 - a * a) : a * last[c] + news;
      channel.residual[k] = channel.shows.dot(x) + last[c];
    }
  }
}

double rms(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x * x;
  return std::sqrt(sum / static_cast<double>(v.size()));
}

// All samples at once as one Gaussian vector: mean and variance of w given the residuals, and their likelihood, by a
// dense matrix.
struct Dense {
  Eigen::VectorXd mean, variance;
  double log_likelihood;
  Dense(const LinearRun& run, int place, double intensity, double start) {
    const auto samples = static_cast<Eigen::Index>(run.time.size()),
               channels = static_cast<Eigen::Index>(run.channels.size());
    Eigen::MatrixXd of_start = Eigen::MatrixXd::Identity(3, 3), of_w = Eigen::MatrixXd::Zero(3, samples);
    Eigen::MatrixXd g = Eigen::MatrixXd::Zero(samples * channels, samples), o(samples * channels, 3);
    for (Eigen::Index k = 0; k < samples; ++k) {
      if (k > 0) {
        const Eigen::MatrixXd& t = run.transition[static_cast<std::size_t>(k - 1)];
        of_start = (t.leftCols(3) * of_start).eval(), of_w = (t.leftCols(3) * of_w).eval();
        of_w.col(k - 1) += t.col(3 + place);
      }
      for (Eigen::Index c = 0; c < channels; ++c) {
        g.row(c * samples + k) = run.channels[static_cast<std::size_t>(c)].shows.transpose() * of_w;
        o.row(c * samples + k) = run.channels[static_cast<std::size_t>(c)].shows.transpose() * of_start;
      }
    }
    Eigen::MatrixXd walk(samples, samples);
    for (Eigen::Index i = 0; i < samples; ++i)
      for (Eigen::Index j = 0; j < samples; ++j)
        walk(i, j) = start * start + intensity * intensity * dt * static_cast<double>(std::min(i, j));
    Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(samples * channels, samples * channels);
    for (Eigen::Index c = 0; c < channels; ++c) {
      const LinearChannel& channel = run.channels[static_cast<std::size_t>(c)];
      for (Eigen::Index i = 0; i < samples; ++i)
        for (Eigen::Index j = 0; j < samples; ++j)
          errors(c * samples + i, c * samples + j) = std::pow(channel.sigma[0], 2) /
                                                     (1 - channel.memory * channel.memory) *
                                                     std::pow(channel.memory, std::abs(static_cast<double>(i - j)));
    }
    // What is missing is left out as a row and a column.
    std::vector<Eigen::Index> there;
    std::vector<double> values;
    for (Eigen::Index c = 0; c < channels; ++c)
      for (Eigen::Index k = 0; k < samples; ++k)
        if (const double v = run.channels[static_cast<std::size_t>(c)].residual[static_cast<std::size_t>(k)];
            std::isfinite(v))
          there.push_back(c * samples + k), values.push_back(v);
    const Eigen::VectorXd y = Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    const Eigen::MatrixXd of = g(there, Eigen::all), from = o(there, Eigen::all);
    const Eigen::MatrixXd all = of * walk * of.transpose() +
                                from * run.start.cwiseAbs2().asDiagonal() * from.transpose() + errors(there, there);
    const Eigen::LLT<Eigen::MatrixXd> llt(all);
    mean = walk * of.transpose() * llt.solve(y);
    variance = (walk - walk * of.transpose() * llt.solve(of * walk)).diagonal();
    const Eigen::MatrixXd l = llt.matrixL();
    log_likelihood = -0.5 * y.dot(llt.solve(y)) - l.diagonal().array().log().sum() -
                     0.5 * static_cast<double>(y.size()) * std::log(2 * std::numbers::pi);
  }
};

void as_dense(LinearRun run, int place, double intensity, double start) {
  fill(
      run, place, [](double t) { return 0.4 * std::sin(7 * t); }, 3);
  const SmoothedInput out = smooth_at({run}, place, intensity, start);
  const Dense dense(run, place, intensity, start);
  EXPECT_NEAR(out.log_likelihood, dense.log_likelihood, 1e-6 * std::abs(dense.log_likelihood));
  for (std::size_t k = 0; k < run.time.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    EXPECT_NEAR(out.value[0][k], dense.mean[i], 1e-6 * dense.mean.norm()) << k;
    EXPECT_NEAR(out.std_error[0][k], std::sqrt(dense.variance[i]), 1e-5 * std::sqrt(dense.variance[i])) << k;
  }
}

TEST(Smoother, IsTheGaussianPosteriorOfAllSamplesTogether) {
  for (int place : {0, 1}) {
    as_dense(bench(60, false), place, 3.0, 1.0);
    as_dense(bench(60, true), place, 0.5, 2.0);
  }
}

TEST(Smoother, NoiseThatRemembersIsPartOfThePosterior) {
  as_dense(bench(60, true, 0.9), 0, 3.0, 1.0);
  as_dense(bench(60, true, 0.9), 1, 0.5, 2.0);
}

TEST(Smoother, ConstantForceOnAFreeMassIsTheParabolaOfLeastSquares) {
  // Position = 1/2 f/m t2 from rest: f by least squares, with the variance that goes with it.
  LinearRun run;
  Eigen::MatrixXd t(2, 3);
  t << 1, dt, 0.5 * dt * dt / mass, 0, 1, dt / mass;
  constexpr int n = 200;
  for (int k = 0; k < n; ++k) run.time.push_back(k * dt);
  run.transition.assign(n - 1, t);
  run.start = Eigen::Vector2d::Zero();
  run.channels.push_back({Eigen::Vector2d(1, 0), {}, std::vector<double>(n, noise), 0});
  Random random(5, 0);
  constexpr double force = 0.02;
  double xx = 0, xy = 0;
  for (double at : run.time) {
    const double parabola = 0.5 * at * at / mass;
    run.channels[0].residual.push_back(force * parabola + random.normal(0.0, noise));
    xx += parabola * parabola, xy += parabola * run.channels[0].residual.back();
  }
  const SmoothedInput out = smooth_at({run}, 0, 0.0, 0.1);
  for (std::size_t k = 0; k < run.time.size(); ++k) {
    EXPECT_NEAR(out.value[0][k], xy / xx, 1e-6 * force);
    EXPECT_NEAR(out.std_error[0][k], noise / std::sqrt(xx), 0.02 * noise / std::sqrt(xx));
  }
  EXPECT_NEAR(xy / xx, force, 4 * noise / std::sqrt(xx));
}

// Share of the samples whose 90 % band holds the truth, over ten seeds.
template <class Truth>
double coverage(bool force_shown, int place, double memory, Truth truth) {
  double inside = 0, all = 0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    LinearRun run = bench(800, force_shown, memory);
    const std::vector<double> w = truth(run.time, seed);
    fill(
        run, place, [&](double t) { return w[static_cast<std::size_t>(std::lround(t / dt))]; }, seed);
    const SmoothedInput of = smooth({run}, {0.1, 0.1}).places[static_cast<std::size_t>(place)];
    for (std::size_t k = 0; k + 1 < run.time.size(); ++k, ++all)
      inside += std::abs(of.value[0][k] - w[k]) < 1.645 * of.std_error[0][k];
  }
  return inside / all;
}

TEST(Smoother, BandHoldsAWalkAsOftenAsItSaysAndASmootherInputMoreOften) {
  const auto walk = [](const std::vector<double>& time, std::uint32_t seed) {
    Random random(seed, 7);
    std::vector<double> w = {random.normal(0.0, 0.3)};
    while (w.size() < time.size()) w.push_back(w.back() + random.normal(0.0, 0.3 * std::sqrt(dt)));
    return w;
  };
  const auto smooth_one = [](const std::vector<double>& time, std::uint32_t) {
    std::vector<double> w;
    for (double t : time) w.push_back(0.3 * std::sin(4 * t) + (std::fmod(t, 4.0) > 2 ? 0.2 : 0.0));
    return w;
  };
  for (const bool force_shown : {false, true})
    for (const int place : {0, 1})
      for (const double memory : {0.0, 0.8}) {
        const double of_walk = coverage(force_shown, place, memory, walk),
                     of_smooth = coverage(force_shown, place, memory, smooth_one);
        std::printf("  %s, place %d, memory %.1f: %.1f %%, %.1f %%\n", force_shown ? "two channels" : "position", place,
                    memory, 100 * of_walk, 100 * of_smooth);
        EXPECT_NEAR(of_walk, 0.9, 0.055);  // three standard errors of some 270 independent stretches
        EXPECT_GT(of_smooth, 0.86);
      }
}

TEST(Smoother, NothingMissingGainsNothing) {
  int called = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    LinearRun run = bench(800, true);
    fill(
        run, 0, [](double) { return 0.0; }, seed);
    const SmootherResult out = smooth({run}, {0.1, 0.1});
    for (const SmoothedInput& of : out.places) {
      called += of.gain > 3;
      for (std::size_t k = 0; k < run.time.size(); ++k)
        ASSERT_LE(std::abs(of.value[0][k]), 4 * of.std_error[0][k] + 1e-12);
    }
  }
  EXPECT_LE(called, 1);
}

TEST(Smoother, PlaceIsToldWhereASecondChannelShowsIt) {
  for (const int place : {0, 1})
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      LinearRun run = bench(800, true);
      fill(
          run, place, [](double t) { return 0.1 * std::sin(5 * t); }, seed);
      const SmootherResult out = smooth({run}, {0.1, 0.1});
      const auto gain = [&](int p) { return out.places[static_cast<std::size_t>(p)].gain; };
      EXPECT_GT(gain(place) - gain(1 - place), 3.0) << place << " " << seed;
      EXPECT_NEAR(rms(out.places[static_cast<std::size_t>(place)].value[0]), 0.1 / std::numbers::sqrt2, 0.02);
    }
}

TEST(Smoother, TwoInputsThatEveryChannelShowsAlikeAreNotTold) {
  // The same force twice, once in other units.
  LinearRun run = bench(800, false);
  for (Eigen::MatrixXd& t : run.transition) t.col(4) = 7 * t.col(3);
  fill(
      run, 0, [](double t) { return 0.3 * std::sin(5 * t); }, 1);
  const SmootherResult out = smooth({run}, {0.1, 0.1 / 7});
  EXPECT_GT(out.places[0].gain, 20);
  EXPECT_NEAR(out.places[0].gain, out.places[1].gain, 1e-6 * out.places[0].gain);
  EXPECT_NEAR(out.places[0].value[0][400], 7 * out.places[1].value[0][400], 1e-6);
}

TEST(Smoother, ChannelThatIsNoisierThanSaidCountsForLess) {
  LinearRun run = bench(800, true);
  fill(
      run, 0, [](double t) { return 0.1 * std::sin(5 * t); }, 1);
  for (double& s : run.channels[1].sigma) s /= 5;
  const SmoothedInput of = smooth({run}, {0.1, 0.1}).places[0];
  EXPECT_NEAR(of.noise[0][0], 1, 0.1);
  EXPECT_NEAR(of.noise[0][1], 5, 0.5) << of.intensity;
}

TEST(Smoother, MissingSamplesWidenTheBandAndNoMore) {
  LinearRun run = bench(60, true);
  fill(
      run, 0, [](double t) { return 0.4 * std::sin(7 * t); }, 3);
  for (std::size_t k = 20; k < 35; ++k)
    for (LinearChannel& c : run.channels) c.residual[k] = std::nan("");
  run.channels[0].residual[50] = std::nan("");
  const SmoothedInput out = smooth_at({run}, 0, 3.0, 1.0);
  const Dense dense(run, 0, 3.0, 1.0);
  EXPECT_NEAR(out.log_likelihood, dense.log_likelihood, 1e-6 * std::abs(dense.log_likelihood));
  for (std::size_t k = 0; k < run.time.size(); ++k)
    EXPECT_NEAR(out.std_error[0][k], std::sqrt(dense.variance[static_cast<Eigen::Index>(k)]), 1e-5) << k;
}

TEST(Smoother, ThinnedRunIsTheSameModel) {
  // Every fourth sample of what the full run does, the input held.
  LinearRun run = bench(400, true);
  fill(
      run, 0, [](double) { return 0.2; }, 1);
  const LinearRun few = thinned(run, 4);
  ASSERT_EQ(few.time.size(), 100u);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3), y = x;
  for (std::size_t k = 0; k + 1 < few.time.size(); ++k) {
    y = few.transition[k].leftCols(3) * y + 0.2 * few.transition[k].col(3);
    for (std::size_t j = 4 * k; j < 4 * k + 4; ++j)
      x = run.transition[j].leftCols(3) * x + 0.2 * run.transition[j].col(3);
    ASSERT_LT((x - y).norm(), 1e-12 * (1 + x.norm()));
  }
}

}  // namespace
}  // namespace servodx
