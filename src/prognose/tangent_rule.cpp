#include "prognose/tangent_rule.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>

#include "prognose/constants.h"

namespace servodx {

using namespace prognose_constants;

std::optional<TangentRule> tangent_rule(const std::vector<double>& time, const std::vector<double>& value,
                                        double threshold, double warning, double failure) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int beyond = 0;
  double first = 0, scale = 1;
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (!(value[k] > threshold)) continue;
    if (beyond == 0) first = time[k], scale = std::max(1e-12, time.back() - first);
    const double s = (time[k] - first) / scale;
    const Eigen::Vector3d row(1, s, s * s);
    normal += row * row.transpose();
    right += row * value[k];
    if (++beyond < least_for_tangent) continue;
    const Eigen::Vector3d c = normal.ldlt().solve(right);
    const double curve = c[0] + c[1] * s + c[2] * s * s, slope = (c[1] + 2 * c[2] * s) / scale;
    if (curve >= warning && slope > 0) return TangentRule{time[k], (failure - warning) / slope};
  }
  return {};
}

}  // namespace servodx
