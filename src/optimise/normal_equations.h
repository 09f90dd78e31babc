// The normal equations of a residual at one point, each row as the loss changes it: all that a damped step asks for.
// Formed block by block, so that no second copy of a tall Jacobian is held.
#pragma once
#include <Eigen/Dense>

#include "optimise/robust_loss.h"

namespace servodx {

struct NormalEquations {
  Eigen::MatrixXd matrix;    // J'J
  Eigen::VectorXd gradient;  // J'e
};

NormalEquations normal_equations(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual, RobustLoss loss,
                                 double scale);

// The sum of rho(e_i).
double robust_cost(const Eigen::VectorXd& residual, RobustLoss loss, double scale);

}  // namespace servodx
