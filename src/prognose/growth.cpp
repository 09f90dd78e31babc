#include "prognose/growth.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/random.h"

namespace servodx {
namespace {

struct Law {
  double power = 1;     // s^power
  double exponent = 0;  // else (exp(k s) - 1) / (exp(k) - 1)
  double weight = 1;    // before any data
  double at(double s) const {
    if (s <= 0) return 0;
    return exponent > 0 ? std::expm1(exponent * s) / std::expm1(exponent) : std::pow(s, power);
  }
  double inverse(double u) const {
    return exponent > 0 ? std::log1p(u * std::expm1(exponent)) / exponent : std::pow(u, 1 / power);
  }
  double slope_at_1() const { return exponent > 0 ? exponent * std::exp(exponent) / std::expm1(exponent) : power; }
};

// The drop over what is open of a part, at the same flow, over that of the whole one; and how much more than that.
double drop_beyond_whole(double lost) { return 1 / ((1 - lost) * (1 - lost)) - 1; }
double lost_at_drop(double drop) { return 1 - 1 / std::sqrt(drop); }
double drop_per_lost(double drop) { return 2 * drop * std::sqrt(drop); }

// Wear at constant duty is linear; dirt and chemistry are not known to be. Linear has as much weight as the others.
constexpr std::array<Law, 13> laws = {{{0.5, 0, 1},
                                       {0.6, 0, 1},
                                       {0.72, 0, 1},
                                       {0.85, 0, 1},
                                       {1.0, 0, 12},
                                       {1.2, 0, 1},
                                       {1.4, 0, 1},
                                       {1.7, 0, 1},
                                       {2.0, 0, 1},
                                       {2.5, 0, 1},
                                       {3.0, 0, 1},
                                       {1, 2.5, 1},
                                       {1, 5.0, 1}}};
// Onsets as parts of the record, and their weights: wear usually begins with use. Between coarser ones a growth that
// began late looks like one that accelerates.
constexpr auto all_onsets = [] {
  std::array<std::pair<double, double>, 18> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = {0.05 * static_cast<double>(k), k ? 4.0 / 17.0 : 4.0};
  return all;
}();
constexpr std::array<double, 9> noises = {0.1, 0.18, 0.32, 0.56, 1, 1.8, 3.2, 5.6, 10};
// Wander over the whole record, in parts of the growth that matters: no law is quite the wear's, and what lies between
// two of those above is off them by a hundredth at most. A healthy figure may wander by the lesser two.
constexpr std::array<double, 3> wanders = {0.005, 0.03, 0.1};
constexpr std::size_t healthy_wanders = 2;
// Of the stated errors: most of one may be what the model's form gets wrong, which is the same from check to check.
constexpr std::array<double, 2> repeated = {1.0, 0.3};
// A part lost so far, where it is one, by what the drop has grown: what is between two of them its size tells.
constexpr auto losses = [] {
  std::array<double, 13> drops{};
  for (std::size_t k = 0; k < drops.size(); ++k) drops[k] = k ? 1.5 * drops[k - 1] : 0.2;
  return drops;
}();
constexpr double negligible = 1e-4;    // weight below which a component is left out
constexpr double least_tilted = 0.02;  // [scale] of a growth at which the oil's part in it is looked for
constexpr double hopeless = 14;        // [nats] below the best noise level at which no further one is looked at

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double log_sum(const std::vector<double>& x) {
  const double top = *std::max_element(x.begin(), x.end());
  double sum = 0;
  for (double v : x) sum += std::exp(v - top);
  return top + std::log(sum);
}

// Base and features; the growth is set apart.
constexpr int most_terms = 8;
using Terms = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_terms, 1>;
using TermMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_terms, most_terms>;

// Gaussian linear regression of all but the growth at one noise level and wander, whitened, and what a growth adds.
struct Regression {
  Eigen::LLT<Eigen::MatrixXd> factor;  // of the noise's covariance
  Eigen::VectorXd alone;               // inverse spread of each point where none depends on another
  Eigen::MatrixXd x;                   // whitened
  Eigen::VectorXd residual;            // whitened, of the prior mean
  Eigen::LLT<TermMatrix> precision;
  Terms right, mean;
  TermMatrix covariance;
  double log_evidence = 0;

  Regression(const Eigen::MatrixXd& terms, const Eigen::VectorXd& y, const Eigen::MatrixXd& noise,
             const Terms& prior_mean, const Terms& prior_sd)
      : factor(noise) {
    if (noise.isDiagonal(0)) alone = noise.diagonal().cwiseSqrt().cwiseInverse();
    x = whitened(terms);
    residual = whitened(y - terms * prior_mean);
    const Terms prior = prior_sd.cwiseAbs2().cwiseInverse();
    TermMatrix a = x.transpose() * x;
    a.diagonal() += prior;
    precision.compute(a);
    right = x.transpose() * residual;
    const Terms shift = precision.solve(right);
    mean = prior_mean + shift;
    covariance = precision.solve(TermMatrix::Identity(a.rows(), a.cols()));
    const auto log_det = [](const auto& llt) { return 2 * llt.matrixLLT().diagonal().array().log().sum(); };
    log_evidence = -0.5 * (residual.squaredNorm() - right.dot(shift) + log_det(factor) + log_det(precision) -
                           prior.array().log().sum());
  }

  Eigen::MatrixXd whitened(const Eigen::MatrixXd& of) const {
    if (alone.size() > 0) return alone.asDiagonal() * of;
    return factor.matrixL().solve(of);
  }

  // Of a, with d integrated out.
  struct Grown {
    double log_evidence = 0, mean = 0, variance = 0;
    Eigen::Vector2d d = Eigen::Vector2d::Zero();
    Terms terms;               // given a at its mean
    Terms tilt;                // how far they fall for a unit of a
    double base_variance = 0;  // of the first of them, given a
  };
  // `g`, whitened: the growth and its products with the features that d stands for; `crossed`: x^T g.
  Grown with(const Eigen::Ref<const Eigen::MatrixXd>& g, const Eigen::Ref<const Eigen::MatrixXd>& crossed,
             const Eigen::Vector3d& prior_mean, const Eigen::Vector3d& prior_sd) const {
    using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
    using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
    using Cross = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_terms, 3>;
    const long m = g.cols();
    const Cross cross = crossed, fall = precision.solve(cross);
    const SmallVector prior = prior_sd.head(m).cwiseAbs2().cwiseInverse(),
                      supposed = prior.cwiseProduct(prior_mean.head(m));
    Small own = g.transpose() * g - cross.transpose() * fall;
    own.diagonal() += prior;
    const SmallVector pull = g.transpose() * residual - fall.transpose() * right + supposed;
    const Eigen::LLT<Small> inverse(own);
    const Small spread = inverse.solve(Small::Identity(m, m));
    const SmallVector at = spread * pull, per_a = spread.col(0) / spread(0, 0);
    Grown out;
    out.mean = at[0], out.variance = spread(0, 0);
    out.d.head(m - 1) = at.tail(m - 1);
    out.terms = mean - fall * at;
    out.tilt = fall * per_a;
    const SmallVector of_base = fall.row(0).transpose();
    out.base_variance =
        covariance(0, 0) + of_base.dot(spread * of_base) - std::pow(of_base.dot(spread.col(0)), 2) / spread(0, 0);
    const double log_det = 2 * inverse.matrixLLT().diagonal().array().log().sum();
    out.log_evidence =
        log_evidence + 0.5 * (pull.dot(at) - supposed.dot(prior_mean.head(m)) - log_det + prior.array().log().sum());
    return out;
  }
};

}  // namespace

struct GrowthModel::Component {
  double weight = 0;
  Law law;
  bool of_drop = false;
  double lost = 0;             // to now, of a part
  double onset = 0, span = 1;  // [h]
  int direction = 0;
  double noise = 0, wander = 0;            // wander: of what wears
  double a = 0, a_sd = 0;                  // growth to now
  Eigen::Vector2d d;                       // of it per unit of the first features; of a drop all of it
  double base = 0, base_sd = 0, tilt = 0;  // given a: base - tilt (a' - a), with this spread
  double strayed = 0, strayed_sd = 0;      // wander to now, of what wears
  Terms mean;

  double along(double time) const { return law.at((time - onset) / span); }
  // Growth at a time, as a part of that to now.
  double grown(double time) const {
    if (!of_drop) return along(time);
    return lost > 0 ? drop_beyond_whole(lost * along(time)) / drop_beyond_whole(lost) : 0.0;
  }
  // What the oil makes of it.
  double by_oil(const GrowthPoint& p) const {
    double sum = 0;
    for (std::size_t j = 0; j < std::min<std::size_t>(2, p.features.size()); ++j)
      sum += d[static_cast<long>(j)] * p.features[j];
    return sum * (of_drop ? 1 + drop_beyond_whole(lost * along(p.time)) : along(p.time));
  }
  double size() const { return of_drop && lost > 0 ? a / drop_beyond_whole(lost) : 1.0; }
  double slope_now() const {
    if (!of_drop) return a * law.slope_at_1() / span;
    const double drop = 1 + drop_beyond_whole(lost);
    return lost > 0 ? a / (drop - 1) * drop_per_lost(drop) * lost * law.slope_at_1() / span : 0.0;
  }
  // Part of the span from the onset on at which the curve reaches a level, with what wears astray by so much.
  double reaches(double level, double from, double growth, double astray) const {
    if (!of_drop) return law.inverse(std::max(0.0, (level - astray - from) / growth));
    const double drop = 1 + (level - from) / growth * drop_beyond_whole(lost);
    return law.inverse(std::max(0.0, drop > 1 ? lost_at_drop(drop) - astray : 0.0) / lost);
  }
};
GrowthModel::~GrowthModel() = default;
GrowthModel::GrowthModel(GrowthModel&&) noexcept = default;
GrowthModel& GrowthModel::operator=(GrowthModel&&) noexcept = default;

double quantile(const Life& life, double p) {
  const double at = p * static_cast<double>(life.size()) - 0.5;
  const auto last = static_cast<double>(life.size()) - 1;
  const double low = std::floor(std::clamp(at, 0.0, last));
  const double high = std::min(low + 1, last);
  const double a = life[static_cast<std::size_t>(low)], b = life[static_cast<std::size_t>(high)];
  const double part = std::clamp(at, 0.0, last) - low;
  return part == 0 ? a : a + part * (b - a);
}

GrowthModel::GrowthModel(std::vector<GrowthPoint> points, const GrowthPrior& prior) {
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  const auto n = static_cast<long>(points.size());
  const std::size_t features = prior.feature_mean.size();
  const double first = points.front().time;
  now_ = points.back().time;
  length_ = std::max(now_ - first, 1e-12);
  for (std::size_t j = 0; j < features; ++j)
    if (prior.feature_sd[j] > 0) added_.push_back(j);
  const auto f = static_cast<long>(added_.size());
  Eigen::MatrixXd x(n, f + 1), drift(n, n);
  Eigen::VectorXd y(n), own(n), exposed(n), column(n), stretch(n);
  Terms mean(f + 1), sd(f + 1);
  mean[0] = prior.base, sd[0] = prior.base_sd;
  for (long j = 0; j < f; ++j)
    mean[j + 1] = prior.feature_mean[added_[static_cast<std::size_t>(j)]],
             sd[j + 1] = prior.feature_sd[added_[static_cast<std::size_t>(j)]];
  for (long i = 0; i < n; ++i) {
    const GrowthPoint& p = points[static_cast<std::size_t>(i)];
    y[i] = p.y, own[i] = p.variance, exposed[i] = p.exposed, stretch[i] = p.stretch, x(i, 0) = p.base_shown;
    for (long j = 0; j < f; ++j) x(i, j + 1) = p.features[added_[static_cast<std::size_t>(j)]];
    for (long k = 0; k <= i; ++k)
      drift(i, k) = drift(k, i) = (points[static_cast<std::size_t>(k)].time - first) / length_;
  }
  const double worn = prior.of_drop ? lost_at_drop(1 + prior.scale) : prior.scale;  // of what wears, that matters

  std::vector<std::pair<double, double>> onsets;
  for (std::size_t k = 0; k < all_onsets.size(); k += prior.coarse ? 3 : 1) onsets.push_back(all_onsets[k]);
  double laws_weight = 0, onsets_weight = 0;
  for (const Law& law : laws) laws_weight += law.weight;
  for (const auto& onset : onsets) onsets_weight += onset.second;
  std::vector<double> scatters = {0.0};
  if (prior.scatter > 0) scatters.push_back(prior.scatter);
  std::vector<double> null, all;
  std::vector<Regression> regressions;
  struct Candidate {
    std::size_t regression, part, onset, law;
    Regression::Grown grown;
  };
  std::vector<Candidate> found;
  const std::size_t stated = own.isZero(0) ? 1 : repeated.size(), of_wander = scatters.size() * stated * noises.size();
  const auto healthy_ones = static_cast<double>(healthy_wanders * of_wander);
  for (double wander : wanders)
    for (double scatter : scatters)
      for (std::size_t k = 0; k < stated; ++k)
        for (double level : noises) {
          Eigen::MatrixXd noise = std::pow(wander * worn, 2) * stretch.asDiagonal() * drift * stretch.asDiagonal();
          noise.diagonal() += repeated[k] * repeated[k] * own + (scatter * exposed).cwiseAbs2();
          noise.diagonal().array() += std::pow(level * prior.noise, 2);
          regressions.emplace_back(x, y, noise, mean, sd);
        }
  // Every growth that is tried, and its products with the oil's features, side by side: whitened in one go. Of a part
  // that is lost the drop grows, and what the oil makes of it is of the whole drop, without growth too.
  const long oil = prior.tilt > 0 && features >= 2 ? 2 : prior.tilt > 0 ? std::min(f, 1L) : 0;
  const long width = 1 + oil;
  Eigen::MatrixXd by_oil(n, oil);
  for (long i = 0; i < n; ++i)
    for (long j = 0; j < oil; ++j)
      by_oil(i, j) = points[static_cast<std::size_t>(i)].features[static_cast<std::size_t>(j)];
  std::vector<double> parts = {0.0};  // lost to now
  if (prior.of_drop) {
    parts.clear();
    for (std::size_t k = 0; k < losses.size(); k += prior.coarse ? 2 : 1) parts.push_back(lost_at_drop(1 + losses[k]));
  }
  const long each = static_cast<long>(onsets.size() * laws.size());
  std::vector<Eigen::MatrixXd> growths;
  for (const double lost : parts) {
    Eigen::MatrixXd& g = growths.emplace_back(n, each * width);
    long at = 0;
    for (const auto& onset : onsets) {
      const double t0 = first + onset.first * (now_ - first), span = std::max(now_ - t0, 1e-12);
      for (const Law& law : laws) {
        for (long i = 0; i < n; ++i) column[i] = law.at((points[static_cast<std::size_t>(i)].time - t0) / span);
        if (prior.of_drop) column = column.unaryExpr([lost](double u) { return drop_beyond_whole(lost * u); });
        g.col(at++) = column;
        if (prior.of_drop) column.array() += 1;
        for (long j = 0; j < oil; ++j) g.col(at++) = column.cwiseProduct(by_oil.col(j));
      }
    }
  }
  const Eigen::Vector3d supposed(prior.of_drop ? 1.0 : 0.0, 0.0, 0.0);
  const auto spreads = [&](double grown) -> Eigen::Vector3d {
    if (prior.of_drop) return {prior.size_sd, prior.tilt, prior.tilt};
    const double tilt = prior.tilt * std::clamp(std::abs(grown), least_tilted * prior.scale, prior.scale);
    return {prior.scale, tilt, tilt / 3};
  };
  // Without growth a drop is that of the whole part, which the oil changes too.
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n, width);
  whole.rightCols(oil) = by_oil;
  std::vector<Regression::Grown> nulls;
  std::size_t best_null = 0;
  for (std::size_t r = 0; r < static_cast<std::size_t>(healthy_ones); ++r) {
    const Regression& of = regressions[r];
    if (prior.of_drop) {
      const Eigen::MatrixXd whitened = of.whitened(whole);
      nulls.push_back(of.with(whitened, of.x.transpose() * whitened, supposed, spreads(0)));
    } else {
      nulls.push_back(
          {of.log_evidence, 0, 0, Eigen::Vector2d::Zero(), of.mean, Terms::Zero(f + 1), of.covariance(0, 0)});
    }
    null.push_back(nulls.back().log_evidence - std::log(healthy_ones));
    if (null.back() >= null[best_null]) best_null = r;
  }
  std::vector<double> of_part(parts.size());  // best evidence at the last noise level
  double best_of_all = -1e300;
  const auto grow = [&](std::size_t r, bool every_part) {  // all of them at one noise; their evidence together
    const std::size_t begin = all.size();
    const double hopeful = *std::max_element(of_part.begin(), of_part.end()) - hopeless;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      if (!every_part && of_part[part] < hopeful) continue;
      const Eigen::MatrixXd whitened = regressions[r].whitened(growths[part]);
      const Eigen::MatrixXd crossed = regressions[r].x.transpose() * whitened;
      of_part[part] = -1e300;
      for (std::size_t o = 0; o < onsets.size(); ++o)
        for (std::size_t l = 0; l < laws.size(); ++l) {
          const long from = static_cast<long>(o * laws.size() + l) * width;
          const bool both = oil > 0 && !prior.of_drop;
          const double before = std::log(laws[l].weight / laws_weight * onsets[o].second / onsets_weight /
                                         static_cast<double>(parts.size() * regressions.size() * (both ? 2 : 1)));
          double grown = 0;  // what it tells without the oil in it: how much of it there is for the oil to change
          for (long columns = prior.of_drop ? width : 1; columns <= width; columns += std::max(1L, oil)) {
            Regression::Grown g = regressions[r].with(whitened.middleCols(from, columns),
                                                      crossed.middleCols(from, columns), supposed, spreads(grown));
            if (columns == 1) grown = g.mean;
            g.log_evidence += before;
            // A prior cut to one side: twice the part of the posterior that lies there.
            if (prior.direction != 0 && !prior.of_drop)
              g.log_evidence +=
                  std::log(std::max(1e-300, 2 * normal_cdf(prior.direction * g.mean / std::sqrt(g.variance))));
            all.push_back(g.log_evidence);
            of_part[part] = std::max(of_part[part], g.log_evidence);
            best_of_all = std::max(best_of_all, g.log_evidence);
            if (g.log_evidence > best_of_all - hopeless) found.push_back({r, part, o, l, std::move(g)});
          }
        }
    }
    return log_sum({all.begin() + static_cast<long>(begin), all.end()});
  };
  // The evidence over the noise level has one peak: from the best without growth down and up, until nothing is left.
  for (std::size_t first_of = 0; first_of < regressions.size(); first_of += noises.size()) {
    std::size_t from = first_of;
    for (std::size_t r = first_of; r < first_of + noises.size(); ++r)
      if (regressions[r].log_evidence > regressions[from].log_evidence) from = r;
    double best = grow(from, true);
    const auto matters = [&](std::size_t r) {
      const double here = grow(r, false);
      best = std::max(best, here);
      return here > best - hopeless;
    };
    for (std::size_t r = from; r > first_of && matters(r - 1);) --r;
    for (std::size_t r = from + 1; r < first_of + noises.size() && matters(r);) ++r;
  }
  const double growth = log_sum(all);
  growth_.log_bayes_factor = growth - log_sum(null);
  growth_.probability = 1 / (1 + std::exp(-growth_.log_bayes_factor));
  double total = 0, square = 0, grown_square = 0, size = 0;
  growth_.coefficients.assign(features, 0.0);
  const auto component = [&](std::size_t r, double lost, const Regression::Grown& grown) {
    Component c;
    c.of_drop = prior.of_drop, c.lost = lost, c.direction = prior.direction;
    c.noise = noises[r % noises.size()] * prior.noise;
    c.wander = wanders[r / of_wander] * worn;
    const double unit = prior.of_drop ? drop_beyond_whole(lost) : 1.0;
    c.a = unit * grown.mean, c.a_sd = unit * std::sqrt(grown.variance);
    c.d = grown.d;
    c.mean = grown.terms;
    c.base = c.mean[0], c.base_sd = std::sqrt(grown.base_variance), c.tilt = unit > 0 ? grown.tilt[0] / unit : 0.0;
    return c;
  };
  for (const Candidate& from : found) {
    const double weight = std::exp(from.grown.log_evidence - growth);
    if (weight <= negligible) continue;
    const Regression& r = regressions[from.regression];
    Component c = component(from.regression, parts[from.part], from.grown);
    c.weight = weight;
    c.law = laws[from.law];
    c.onset = first + onsets[from.onset].first * (now_ - first);
    c.span = std::max(now_ - c.onset, 1e-12);
    if (c.wander > 0) {  // what the curve leaves, smoothed to now
      const Eigen::VectorXd to_now = c.wander * c.wander * stretch.cwiseProduct(drift.col(n - 1));
      const Eigen::VectorXd gain = r.factor.solve(to_now);
      Eigen::VectorXd left = y - x * c.mean;
      for (long i = 0; i < n; ++i) {
        const GrowthPoint& p = points[static_cast<std::size_t>(i)];
        left[i] -= c.a * c.grown(p.time) + c.by_oil(p);
      }
      c.strayed = gain.dot(left);
      c.strayed_sd = std::sqrt(std::max(0.0, c.wander * c.wander - gain.dot(to_now)));
    }
    const double strayed = c.strayed * stretch[n - 1], strayed_sd = c.strayed_sd * stretch[n - 1];
    const double at = c.base + c.a + strayed;
    const double spread = c.base_sd * c.base_sd + std::pow((1 - c.tilt) * c.a_sd, 2) + strayed_sd * strayed_sd;
    total += weight;
    growth_.now += weight * at;
    square += weight * (at * at + spread);
    growth_.grown += weight * (c.a + strayed);
    grown_square += weight * (std::pow(c.a + strayed, 2) + c.a_sd * c.a_sd + strayed_sd * strayed_sd);
    growth_.base += weight * c.base, size += weight * c.size();
    growth_.slope += weight * c.slope_now();
    growth_.noise += weight * c.noise;
    for (long j = 0; j < f; ++j) growth_.coefficients[added_[static_cast<std::size_t>(j)]] += weight * c.mean[j + 1];
    components_.push_back(std::move(c));
  }
  growth_.now /= total, growth_.base /= total, growth_.slope /= total, growth_.noise /= total;
  for (double& b : growth_.coefficients) b /= total;
  growth_.now_sd = std::sqrt(std::max(0.0, square / total - growth_.now * growth_.now));
  growth_.grown /= total, growth_.size = size / total;
  growth_.grown_sd = std::sqrt(std::max(0.0, grown_square / total - growth_.grown * growth_.grown));
  const Component none = component(best_null, 0, nulls[best_null]);
  growth_.base_sd = none.base_sd;
  growth_.null_noise = none.noise;
  if (growth_.probability < 0.5) {  // without a trend, the null's
    growth_.base = growth_.now = none.base;
    growth_.now_sd = growth_.base_sd;
    growth_.noise = growth_.null_noise, growth_.size = 1;
    for (long j = 0; j < f; ++j) growth_.coefficients[added_[static_cast<std::size_t>(j)]] = none.mean[j + 1];
    components_.assign(1, none);
    components_.front().weight = 1;
  }
}

double GrowthModel::by_conditions(const GrowthPoint& point) const {
  double total = 0, sum = 0;
  for (const Component& c : components_) {
    double y = (point.base_shown - 1) * c.base + c.by_oil(point);
    for (std::size_t j = 0; j < added_.size(); ++j) y += c.mean[static_cast<long>(j) + 1] * point.features[added_[j]];
    total += c.weight, sum += c.weight * y;
  }
  return sum / total;
}

double GrowthModel::expected(const GrowthPoint& point) const {
  double total = 0, sum = 0;
  for (const Component& c : components_) total += c.weight, sum += c.weight * (c.base + c.a * c.grown(point.time));
  return sum / total + by_conditions(point);
}

double GrowthModel::at_reference(const GrowthPoint& point) const { return point.y - by_conditions(point); }

Life GrowthModel::life(const FailureAt& failure, std::uint64_t seed) const {
  constexpr double all_draws = 4000;  // shared among the components by their weights
  constexpr int least_draws = 16, kept = 200;
  std::vector<std::pair<double, double>> passed;  // hours, weight
  for (std::size_t k = 0; k < components_.size(); ++k) {
    const Component& c = components_[k];
    Random random(seed, 21, static_cast<std::uint32_t>(k));
    const int draws = 2 * std::max(least_draws / 2, static_cast<int>(0.5 * all_draws * c.weight));
    std::vector<double> hours;
    std::array<double, 5> z{};
    for (int i = 0; i < 20 * draws && std::ssize(hours) < draws; ++i) {
      // In pairs of opposite sign: the middle of a wide distribution is not left to chance.
      for (double& v : z) v = i % 2 ? -v : random.normal();
      const double a = c.a + c.a_sd * z[0];
      const double base = c.base - c.tilt * (a - c.a) + c.base_sd * z[1];
      const double strayed = c.strayed + c.strayed_sd * z[2], ahead = z[3];
      const double moved = failure.sd * z[4];
      if (c.direction != 0 && a * c.direction <= 0) continue;
      const std::optional<double>& given = a > 0 ? failure.upper : failure.lower;
      double t = std::numeric_limits<double>::infinity();
      if (given && a != 0) {
        const double level = failure.level(*given, base, a / c.a * c.size());
        // The wander goes on: once from now to the first estimate of the end.
        const auto reached = [&](double astray) {
          return std::max(0.0, c.onset + c.span * c.reaches(level, base, a, astray - moved) - now_);
        };
        t = reached(strayed);
        if (c.wander > 0) t = reached(strayed + c.wander * std::sqrt(std::min(t, length_) / length_) * ahead);
      }
      hours.push_back(t);
    }
    for (double t : hours) passed.emplace_back(t, c.weight / static_cast<double>(hours.size()));
  }
  std::sort(passed.begin(), passed.end());
  double total = 0;
  for (const auto& p : passed) total += p.second;
  Life life;
  double sum = 0;
  std::size_t i = 0;
  for (int q = 0; q < kept && !passed.empty(); ++q) {
    const double target = (q + 0.5) / kept * total;
    while (i + 1 < passed.size() && sum + passed[i].second < target) sum += passed[i].second, ++i;
    life.push_back(passed[i].first);
  }
  return life;
}

}  // namespace servodx
