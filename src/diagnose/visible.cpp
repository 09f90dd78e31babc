#include "diagnose/visible.h"

#include <algorithm>
#include <cmath>

#include "faults/fault.h"
#include "optimise/box_quadratic.h"
#include "optimise/unit_cube.h"

namespace servodx {

HealthyAnswer::HealthyAnswer(const Eigen::MatrixXd& jacobian, const Point& at, long data_rows)
    : data_(jacobian.topRows(data_rows)), normal_(jacobian.transpose() * jacobian) {
  const auto n = static_cast<long>(at.size());
  lower_.resize(n), upper_.resize(n);
  for (long j = 0; j < n; ++j) {
    lower_[j] = -at[static_cast<std::size_t>(j)];
    upper_[j] = 1 - at[static_cast<std::size_t>(j)];
  }
  // A number that this log does not show at all has no curvature: the least that keeps the quadratic convex.
  constexpr double convex = 1e-12;
  const double most = normal_.diagonal().maxCoeff();
  normal_.diagonal().array() += convex * std::max(most, 1.0);
}

double HealthyAnswer::taken(const Eigen::VectorXd& gradient) const {
  return 2 * minimise_box_quadratic(normal_, gradient, lower_, upper_).decrease;
}

double HealthyAnswer::left_of(const Eigen::VectorXd& change) const {
  return std::max(0.0, change.squaredNorm() - taken(data_.transpose() * change));
}

std::optional<double> least_found(const VisibleFault& visible, double needed) {
  const std::vector<SeverityGain>& g = visible.gains;
  std::size_t first = g.size();  // of those that are found to the end
  while (first > 0 && g[first - 1].gain >= needed) --first;
  if (first == g.size()) return {};
  if (first == 0) return g.front().severity;
  const double below = std::sqrt(std::max(0.0, g[first - 1].gain)), above = std::sqrt(g[first].gain);
  return severity_between(*visible.fault, g[first - 1].severity, g[first].severity,
                          (std::sqrt(needed) - below) / (above - below));
}

std::optional<double> least_found_either_side(std::span<const VisibleFault> sides, double needed) {
  std::optional<double> out;
  for (const VisibleFault& side : sides) {
    const std::optional<double> least = least_found(side, needed);
    if (!least) return {};
    const double healthy = side.fault->healthy;
    if (!out || std::abs(*least - healthy) > std::abs(*out - healthy)) out = std::abs(*least);
  }
  return out;
}

}  // namespace servodx
