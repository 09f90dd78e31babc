// What the points say of every noise, course and size of a growth on a fixed grid, and of none.
//
// The grid: wander, scatter, repeated part and level of the noise; onsets, laws and, of a drop, the part lost to now.
// At each point of it the size and all else that is linear is integrated out (growth_regression.h). The evidence over
// the noise level has one peak, so levels are looked at from it until nothing is left. Limits: what lies between two
// points of the grid (constants.h) is told by neither.
#pragma once
#include <Eigen/Dense>
#include <cstddef>
#include <utility>
#include <vector>

#include "prognose/growth.h"
#include "prognose/growth_component.h"
#include "prognose/growth_data.h"
#include "prognose/growth_regression.h"

namespace servodx {

// One regression a noise: wander by wander, each by scatter, stated part that repeats, and level.
class NoiseGrid {
 public:
  NoiseGrid(const GrowthData& data, const GrowthPrior& prior);
  std::size_t size() const { return regressions_.size(); }
  std::size_t healthy_ones() const;  // by wander, those that a healthy figure may have
  const GrowthRegression& operator[](std::size_t k) const { return regressions_[k]; }
  double level(std::size_t k) const;   // [y] noise of one check
  double wander(std::size_t k) const;  // over the record, of what wears

 private:
  double noise_, worn_;
  std::size_t of_wander_;
  std::vector<GrowthRegression> regressions_;
};

// Every growth that is tried, and its products with the oil's features, side by side. Of a part that is lost the drop
// grows, and what the oil makes of it is of the whole drop, without growth too.
struct CurveGrid {
  CurveGrid(const GrowthData& data, const GrowthPrior& prior);
  std::vector<std::pair<double, double>> onsets;  // part of the record, weight
  std::vector<double> parts = {0.0};              // lost to now
  std::vector<Eigen::MatrixXd> growths;           // of each part: by onset, by law, `width` columns each
  long width = 1;
  double onsets_weight = 0, laws_weight = 0;
};

struct HealthyFit {
  double log_evidence = 0;
  std::size_t noise = 0;  // the best
  GrownRegression best;
};
HealthyFit without_growth(const GrowthData& data, const NoiseGrid& noises, const GrowthPrior& prior);

struct GrownFit {
  std::size_t noise = 0, part = 0, onset = 0, law = 0;
  GrownRegression grown;
};

class GrowthSearch {
 public:
  GrowthSearch(const NoiseGrid& noises, const CurveGrid& curves, const GrowthPrior& prior);
  double log_evidence() const;
  const std::vector<GrownFit>& found() const { return found_; }  // but those that hardly weigh

 private:
  double grow(std::size_t noise, bool every_part);  // all of them at one noise; their evidence together
  void grow(std::size_t noise, std::size_t part);
  void take(const GrownFit& at, const Eigen::Ref<const Eigen::MatrixXd>& whitened,
            const Eigen::Ref<const Eigen::MatrixXd>& crossed);
  double log_weight(const GrownFit& at) const;
  void from_its_peak(std::size_t first);

  const NoiseGrid& noises_;
  const CurveGrid& curves_;
  const GrowthPrior& prior_;
  std::vector<double> evidences_;
  std::vector<double> of_part_;  // best evidence at the last noise level
  double best_ = -1e300;
  std::vector<GrownFit> found_;
};

// log of the sum of exponentials.
double log_sum(const std::vector<double>& x);

// As components: the noise's, and the size in y.
GrowthComponent component_of(const NoiseGrid& noises, std::size_t noise, double lost, const GrownRegression& grown,
                             const GrowthPrior& prior);
GrowthComponent component_of(const GrowthData& data, const NoiseGrid& noises, const CurveGrid& curves,
                             const GrownFit& fit, const GrowthPrior& prior);

}  // namespace servodx
