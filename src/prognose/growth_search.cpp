#include "prognose/growth_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/tiny.h"
#include "prognose/constants.h"
#include "prognose/growth_law.h"

namespace servodx {

using namespace prognose_constants;

namespace {

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// Of the size of a growth and of what the oil makes of it, before any data.
Eigen::Vector3d prior_mean(const GrowthPrior& prior) { return {prior.of_drop ? 1.0 : 0.0, 0.0, 0.0}; }
// `grown`: how much of it there is for the oil to change.
Eigen::Vector3d prior_sd(const GrowthPrior& prior, double grown) {
  if (prior.of_drop) return {prior.size_sd, prior.tilt, prior.tilt};
  const double tilt = prior.tilt * std::clamp(std::abs(grown), least_tilted * prior.scale, prior.scale);
  return {prior.scale, tilt, tilt / 3};
}

}  // namespace

double log_sum(const std::vector<double>& x) {
  const double top = *std::max_element(x.begin(), x.end());
  double sum = 0;
  for (double v : x) sum += std::exp(v - top);
  return top + std::log(sum);
}

NoiseGrid::NoiseGrid(const GrowthData& data, const GrowthPrior& prior) : noise_(prior.noise), worn_(data.worn) {
  std::vector<double> scatters = {0.0};
  if (prior.scatter > 0) scatters.push_back(prior.scatter);
  const std::size_t stated = data.variance.isZero(0) ? 1 : repeated_parts.size();
  of_wander_ = scatters.size() * stated * noise_levels.size();
  for (double wander : wanders)
    for (double scatter : scatters)
      for (std::size_t k = 0; k < stated; ++k)
        for (double level : noise_levels) {
          Eigen::MatrixXd noise =
              std::pow(wander * data.worn, 2) * data.stretch.asDiagonal() * data.drift * data.stretch.asDiagonal();
          noise.diagonal() +=
              repeated_parts[k] * repeated_parts[k] * data.variance + (scatter * data.exposed).cwiseAbs2();
          noise.diagonal().array() += std::pow(level * prior.noise, 2);
          regressions_.emplace_back(data.terms, data.y, noise, data.mean, data.sd);
        }
}

std::size_t NoiseGrid::healthy_ones() const { return healthy_wanders * of_wander_; }
double NoiseGrid::level(std::size_t k) const { return noise_levels[k % noise_levels.size()] * noise_; }
double NoiseGrid::wander(std::size_t k) const { return wanders[k / of_wander_] * worn_; }

CurveGrid::CurveGrid(const GrowthData& data, const GrowthPrior& prior) : width(1 + data.by_oil.cols()) {
  for (std::size_t k = 0; k < all_onsets.size(); k += prior.coarse ? 3 : 1) onsets.push_back(all_onsets[k]);
  for (const GrowthLaw& law : growth_laws) laws_weight += law.weight;
  for (const auto& onset : onsets) onsets_weight += onset.second;
  if (prior.of_drop) {
    parts.clear();
    for (std::size_t k = 0; k < losses.size(); k += prior.coarse ? 2 : 1) parts.push_back(lost_at_drop(1 + losses[k]));
  }
  const long each = static_cast<long>(onsets.size() * growth_laws.size()), n = data.n();
  Eigen::VectorXd column(n);
  for (const double lost : parts) {
    Eigen::MatrixXd& g = growths.emplace_back(n, each * width);
    long at = 0;
    for (const auto& onset : onsets) {
      const double t0 = data.onset_at(onset.first), span = std::max(data.now - t0, 1e-12);
      for (const GrowthLaw& law : growth_laws) {
        for (long i = 0; i < n; ++i) column[i] = law.at((data.points[static_cast<std::size_t>(i)].time - t0) / span);
        if (prior.of_drop) column = column.unaryExpr([lost](double u) { return drop_beyond_whole(lost * u); });
        g.col(at++) = column;
        if (prior.of_drop) column.array() += 1;
        for (long j = 0; j < width - 1; ++j) g.col(at++) = column.cwiseProduct(data.by_oil.col(j));
      }
    }
  }
}

HealthyFit without_growth(const GrowthData& data, const NoiseGrid& noises, const GrowthPrior& prior) {
  // Without growth a drop is that of the whole part, which the oil changes too.
  const long oil = data.by_oil.cols();
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(data.n(), 1 + oil);
  whole.rightCols(oil) = data.by_oil;
  const auto count = static_cast<double>(noises.healthy_ones());
  std::vector<double> evidences;
  HealthyFit out;
  for (std::size_t k = 0; k < noises.healthy_ones(); ++k) {
    GrownRegression none = noises[k].without_growth();
    if (prior.of_drop) {
      const Eigen::MatrixXd whitened = noises[k].whitened(whole);
      none = noises[k].with(whitened, noises[k].crossed(whitened), prior_mean(prior), prior_sd(prior, 0));
    }
    evidences.push_back(none.log_evidence - std::log(count));
    if (k == 0 || evidences.back() >= evidences[out.noise]) out.noise = k, out.best = std::move(none);
  }
  out.log_evidence = log_sum(evidences);
  return out;
}

GrowthSearch::GrowthSearch(const NoiseGrid& noises, const CurveGrid& curves, const GrowthPrior& prior)
    : noises_(noises), curves_(curves), prior_(prior), of_part_(curves.parts.size()) {
  for (std::size_t first = 0; first < noises.size(); first += noise_levels.size()) from_its_peak(first);
}

double GrowthSearch::log_evidence() const { return log_sum(evidences_); }

// From the level that is best without growth down and up, until nothing is left.
void GrowthSearch::from_its_peak(std::size_t first) {
  const std::size_t end = first + noise_levels.size();
  std::size_t from = first;
  for (std::size_t k = first; k < end; ++k)
    if (noises_[k].log_evidence() > noises_[from].log_evidence()) from = k;
  double best = grow(from, true);
  const auto matters = [&](std::size_t k) {
    const double here = grow(k, false);
    best = std::max(best, here);
    return here > best - hopeless;
  };
  for (std::size_t k = from; k > first && matters(k - 1);) --k;
  for (std::size_t k = from + 1; k < end && matters(k);) ++k;
}

double GrowthSearch::grow(std::size_t noise, bool every_part) {
  const std::size_t begin = evidences_.size();
  const double hopeful = *std::max_element(of_part_.begin(), of_part_.end()) - hopeless;
  for (std::size_t part = 0; part < curves_.parts.size(); ++part)
    if (every_part || of_part_[part] >= hopeful) grow(noise, part);
  return log_sum({evidences_.begin() + static_cast<long>(begin), evidences_.end()});
}

void GrowthSearch::grow(std::size_t noise, std::size_t part) {
  const Eigen::MatrixXd whitened = noises_[noise].whitened(curves_.growths[part]);
  const Eigen::MatrixXd crossed = noises_[noise].crossed(whitened);
  of_part_[part] = -1e300;
  for (std::size_t onset = 0; onset < curves_.onsets.size(); ++onset)
    for (std::size_t law = 0; law < growth_laws.size(); ++law) {
      const long from = static_cast<long>(onset * growth_laws.size() + law) * curves_.width;
      take({noise, part, onset, law, {}}, whitened.middleCols(from, curves_.width),
           crossed.middleCols(from, curves_.width));
    }
}

// Without the oil in it and with; of a drop with it alone.
void GrowthSearch::take(const GrownFit& at, const Eigen::Ref<const Eigen::MatrixXd>& whitened,
                        const Eigen::Ref<const Eigen::MatrixXd>& crossed) {
  const long width = curves_.width;
  const double before = log_weight(at);
  double grown = 0;  // what it tells without the oil in it: how much of it there is for the oil to change
  for (long columns = prior_.of_drop ? width : 1; columns <= width; columns += std::max(1L, width - 1)) {
    GrownRegression g = noises_[at.noise].with(whitened.leftCols(columns), crossed.leftCols(columns),
                                               prior_mean(prior_), prior_sd(prior_, grown));
    if (columns == 1) grown = g.mean;
    g.log_evidence += before;
    // A prior cut to one side: twice the part of the posterior that lies there.
    if (prior_.direction != 0 && !prior_.of_drop)
      g.log_evidence += std::log(std::max(tiny, 2 * normal_cdf(prior_.direction * g.mean / std::sqrt(g.variance))));
    evidences_.push_back(g.log_evidence);
    of_part_[at.part] = std::max(of_part_[at.part], g.log_evidence);
    best_ = std::max(best_, g.log_evidence);
    if (g.log_evidence > best_ - hopeless) found_.push_back({at.noise, at.part, at.onset, at.law, std::move(g)});
  }
}

double GrowthSearch::log_weight(const GrownFit& at) const {
  const bool both = curves_.width > 1 && !prior_.of_drop;
  return std::log(growth_laws[at.law].weight / curves_.laws_weight * curves_.onsets[at.onset].second /
                  curves_.onsets_weight / static_cast<double>(curves_.parts.size() * noises_.size() * (both ? 2 : 1)));
}

GrowthComponent component_of(const NoiseGrid& noises, std::size_t noise, double lost, const GrownRegression& grown,
                             const GrowthPrior& prior) {
  GrowthComponent c;
  c.of_drop = prior.of_drop, c.lost = lost, c.direction = prior.direction;
  c.noise = noises.level(noise);
  c.wander = noises.wander(noise);
  const double unit = prior.of_drop ? drop_beyond_whole(lost) : 1.0;
  c.a = unit * grown.mean, c.a_sd = unit * std::sqrt(grown.variance);
  c.d = grown.d;
  c.mean = grown.terms;
  c.base = c.mean[0], c.base_sd = std::sqrt(grown.base_variance), c.tilt = unit > 0 ? grown.tilt[0] / unit : 0.0;
  return c;
}

GrowthComponent component_of(const GrowthData& data, const NoiseGrid& noises, const CurveGrid& curves,
                             const GrownFit& fit, const GrowthPrior& prior) {
  GrowthComponent c = component_of(noises, fit.noise, curves.parts[fit.part], fit.grown, prior);
  c.law = growth_laws[fit.law];
  c.onset = data.onset_at(curves.onsets[fit.onset].first);
  c.span = std::max(data.now - c.onset, 1e-12);
  if (!(c.wander > 0)) return c;
  // What the curve leaves, smoothed to now.
  const Eigen::VectorXd to_now = c.wander * c.wander * data.stretch.cwiseProduct(data.drift.col(data.n() - 1));
  const Eigen::VectorXd gain = noises[fit.noise].solved(to_now);
  Eigen::VectorXd left = data.y - data.terms * c.mean;
  for (long i = 0; i < data.n(); ++i) {
    const GrowthPoint& p = data.points[static_cast<std::size_t>(i)];
    left[i] -= c.a * c.grown(p.time) + c.by_oil(p);
  }
  c.strayed = gain.dot(left);
  c.strayed_sd = std::sqrt(std::max(0.0, c.wander * c.wander - gain.dot(to_now)));
  return c;
}

}  // namespace servodx
