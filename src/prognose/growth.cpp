#include "prognose/growth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "prognose/constants.h"
#include "prognose/growth_component.h"
#include "prognose/growth_data.h"
#include "prognose/growth_search.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// Weighted means over components, and what they scatter by.
class Averages {
 public:
  Averages(const GrowthData& data, std::size_t features) : data_(data) { mean_.coefficients.assign(features, 0.0); }

  void add(const GrowthComponent& c) {
    const double stretch = data_.stretch[data_.n() - 1];
    const double strayed = c.strayed * stretch, strayed_sd = c.strayed_sd * stretch;
    const double at = c.base + c.a + strayed;
    const double spread = c.base_sd * c.base_sd + std::pow((1 - c.tilt) * c.a_sd, 2) + strayed_sd * strayed_sd;
    total_ += c.weight;
    mean_.now += c.weight * at;
    square_ += c.weight * (at * at + spread);
    mean_.grown += c.weight * (c.a + strayed);
    grown_square_ += c.weight * (std::pow(c.a + strayed, 2) + c.a_sd * c.a_sd + strayed_sd * strayed_sd);
    mean_.base += c.weight * c.base, size_ += c.weight * c.size();
    mean_.slope += c.weight * c.slope_now();
    mean_.noise += c.weight * c.noise;
    for (std::size_t j = 0; j < data_.added.size(); ++j)
      mean_.coefficients[data_.added[j]] += c.weight * c.mean[static_cast<long>(j) + 1];
  }

  Growth growth() const {
    Growth g = mean_;
    g.now /= total_, g.base /= total_, g.slope /= total_, g.noise /= total_;
    for (double& b : g.coefficients) b /= total_;
    g.now_sd = std::sqrt(std::max(0.0, square_ / total_ - g.now * g.now));
    g.grown /= total_, g.size = size_ / total_;
    g.grown_sd = std::sqrt(std::max(0.0, grown_square_ / total_ - g.grown * g.grown));
    return g;
  }

 private:
  const GrowthData& data_;
  Growth mean_;
  double total_ = 0, square_ = 0, grown_square_ = 0, size_ = 0;
};

std::vector<GrowthPoint> in_order(std::vector<GrowthPoint> points) {
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return points;
}

std::vector<GrowthComponent> components_of(const GrowthData& data, const NoiseGrid& noises, const CurveGrid& curves,
                                           const GrowthSearch& search, const GrowthPrior& prior) {
  const double evidence = search.log_evidence();
  std::vector<GrowthComponent> out;
  for (const GrownFit& fit : search.found()) {
    const double weight = std::exp(fit.grown.log_evidence - evidence);
    if (weight <= negligible) continue;
    out.push_back(component_of(data, noises, curves, fit, prior));
    out.back().weight = weight;
  }
  return out;
}

// What is known where there is no trend: all but how it would have grown.
void take_healthy(Growth& g, const GrowthComponent& none, const std::vector<std::size_t>& added) {
  g.base = g.now = none.base;
  g.now_sd = g.base_sd;
  g.noise = g.null_noise, g.size = 1;
  for (std::size_t j = 0; j < added.size(); ++j) g.coefficients[added[j]] = none.mean[static_cast<long>(j) + 1];
}

}  // namespace

GrowthModel::~GrowthModel() = default;
GrowthModel::GrowthModel(GrowthModel&&) noexcept = default;
GrowthModel& GrowthModel::operator=(GrowthModel&&) noexcept = default;

GrowthModel::GrowthModel(std::vector<GrowthPoint> points, const GrowthPrior& prior) {
  const GrowthData data(in_order(std::move(points)), prior);
  const NoiseGrid noises(data, prior);
  const CurveGrid curves(data, prior);
  const HealthyFit healthy = without_growth(data, noises, prior);
  const GrowthSearch search(noises, curves, prior);
  components_ = components_of(data, noises, curves, search, prior);
  added_ = data.added, now_ = data.now, length_ = data.length;

  Averages averages(data, prior.feature_mean.size());
  for (const GrowthComponent& c : components_) averages.add(c);
  growth_ = averages.growth();
  growth_.log_bayes_factor = search.log_evidence() - healthy.log_evidence;
  growth_.probability = 1 / (1 + std::exp(-growth_.log_bayes_factor));

  GrowthComponent none = component_of(noises, healthy.noise, 0, healthy.best, prior);
  growth_.base_sd = none.base_sd;
  growth_.null_noise = none.noise;
  if (growth_.probability < 0.5) {  // of the two hypotheses the likelier is told
    take_healthy(growth_, none, added_);
    none.weight = 1;
    components_.assign(1, none);
  }
}

double GrowthModel::by_conditions(const GrowthPoint& point) const {
  double total = 0, sum = 0;
  for (const GrowthComponent& c : components_) {
    double y = (point.base_shown - 1) * c.base + c.by_oil(point);
    for (std::size_t j = 0; j < added_.size(); ++j) y += c.mean[static_cast<long>(j) + 1] * point.features[added_[j]];
    total += c.weight, sum += c.weight * y;
  }
  return sum / total;
}

double GrowthModel::expected(const GrowthPoint& point) const {
  double total = 0, sum = 0;
  for (const GrowthComponent& c : components_)
    total += c.weight, sum += c.weight * (c.base + c.a * c.grown(point.time));
  return sum / total + by_conditions(point);
}

double GrowthModel::at_reference(const GrowthPoint& point) const { return point.y - by_conditions(point); }

}  // namespace servodx
