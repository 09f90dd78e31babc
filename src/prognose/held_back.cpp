#include "prognose/held_back.h"

#include <cstddef>

#include "parameters/coordinate.h"

namespace servodx {

Eigen::VectorXd held_back(const Point& end, const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                          const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd push = jacobian.transpose() * residual;
  for (std::size_t j = 0; j < end.size(); ++j) {
    double& cost_rises = push[static_cast<long>(j)];
    const bool outward = end[j] < 0.5 ? cost_rises > 0 : cost_rises < 0;
    if (off_walls(end[j]) || !outward) cost_rises = 0;
  }
  return (covariance * push).cwiseAbs();
}

}  // namespace servodx
