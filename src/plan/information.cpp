#include "plan/information.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace servodx {
namespace {

Eigen::MatrixXd with_priors(const Eigen::MatrixXd& gram, const std::vector<int>& free) {
  Eigen::MatrixXd m = gram(free, free);
  m.diagonal().array() += 1.0;
  return m;
}

// Least squared distance of a lane from the stretch between two others.
double from_stretch(const Eigen::MatrixXd& g, int a, int from, int to) {
  const double vv = g(a, a) - 2 * g(a, from) + g(from, from);
  const double tt = g(to, to) - 2 * g(to, from) + g(from, from);
  const double tv = g(a, to) - g(a, from) - g(from, to) + g(from, from);
  const double part = tt > 0 ? std::clamp(tv / tt, 0.0, 1.0) : 0.0;
  return std::max(0.0, vv - 2 * part * tv + part * part * tt);
}

// Gram matrix of some lanes, those of others taken out.
Eigen::MatrixXd without(const Eigen::MatrixXd& gram, const std::vector<int>& free, const std::vector<int>& lanes) {
  if (free.empty()) return gram(lanes, lanes);
  const Eigen::MatrixXd cross = gram(free, lanes);
  return gram(lanes, lanes) - cross.transpose() * with_priors(gram, free).llt().solve(cross);
}

}  // namespace

Information::Information(const Eigen::MatrixXd& gram, const LaneSet& set) : set_(set), from_health_(gram.diagonal()) {
  if (!set.health.empty()) {
    const Eigen::MatrixXd cross = gram(set.health, Eigen::all);
    const Eigen::MatrixXd solved = with_priors(gram, set.health).llt().solve(cross);
    from_health_ -= cross.cwiseProduct(solved).colwise().sum().transpose();
  }
  for (const RivalLanes& rival : set.rivals) rivals_.push_back(beside(rival, gram));
  if (!set.rows.empty()) {
    const Eigen::MatrixXd precision = with_priors(gram, set.beside_rows);
    left_ = precision.llt().solve(Eigen::MatrixXd::Identity(precision.rows(), precision.cols())).diagonal();
  }
}

Eigen::MatrixXd Information::beside(const RivalLanes& rival, const Eigen::MatrixXd& gram) const {
  std::vector<int> lanes;
  for (const SeverityLanes& side : rival.sides) lanes.insert(lanes.end(), side.lanes.begin(), side.lanes.end());
  for (const TargetLane& t : set_.targets) lanes.push_back(t.lane);
  return without(gram, rival.beside, lanes);
}

double Information::from_rival(const TargetLane& target, std::size_t rival) const {
  const Eigen::MatrixXd& g = rivals_[rival];
  const auto of_rival = static_cast<std::size_t>(g.rows()) - set_.targets.size();
  const auto place = std::find_if(set_.targets.begin(), set_.targets.end(),
                                  [&](const TargetLane& t) { return t.lane == target.lane; });
  const int at = static_cast<int>(of_rival) + static_cast<int>(place - set_.targets.begin());
  double least = HUGE_VAL;
  int first = 0;
  for (const SeverityLanes& side : set_.rivals[rival].sides) {
    const int last = first + static_cast<int>(side.lanes.size()) - 1;
    for (int i = first; i <= last; ++i) least = std::min(least, from_stretch(g, at, i, std::min(i + 1, last)));
    first = last + 1;
  }
  return least;
}

double Information::left_of(const RowLane& row) const {
  const auto at = std::find(set_.beside_rows.begin(), set_.beside_rows.end(), row.lane) - set_.beside_rows.begin();
  return std::sqrt(std::max(0.0, left_(at)));
}

}  // namespace servodx
