// What a log could have shown: how much each fault, were it there, would gain over health on this very input, by its
// severity; and with that, the least severity that would not have passed as healthy.
//
// The difference that a severity makes to the simulation, whitened, less what health itself could have made of it: its
// nuisances and tolerances move with the linear model of its own fit, inside their bounds and at the cost of their
// priors. Costs no simulation beside those that choose where each fault begins.
//
// Limits: health's answer is linear. Speaks of a fault that is there from the first sample on.
#pragma once
#include <Eigen/Dense>
#include <optional>
#include <span>
#include <vector>

#include "faults/fault.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct SeverityGain {
  double severity = 0;  // [the fault's unit]
  double gain = 0;      // of misfit over health, as a fit would be expected to find
};

// Of one fault on one side of health, the mildest first. The first stands at the least that is called the fault.
struct VisibleFault {
  const Fault* fault = nullptr;
  std::vector<SeverityGain> gains;
};

// What health can make of a change of its residual.
class HealthyAnswer {
 public:
  // The Jacobian of health's fit at its end, the priors' rows last, and the point; `data_rows`: of the logs.
  HealthyAnswer(const Eigen::MatrixXd& jacobian, const Point& at, long data_rows);
  // Squared norm of what is left of a change [data_rows] of the whitened residual, priors included.
  double left_of(const Eigen::VectorXd& change) const;
  // What it can take off a squared residual whose half has this gradient [free values].
  double taken(const Eigen::VectorXd& gradient) const;
  const Eigen::MatrixXd& derivatives() const { return data_; }  // [data_rows x free values]

 private:
  Eigen::MatrixXd data_, normal_;
  Eigen::VectorXd lower_, upper_;
};

// The least severity whose gain, and that of every worse one, is at least `needed`; between two of them the gain's root
// runs straight, as an effect that is proportional to the severity makes it. None where the worst gains less.
std::optional<double> least_found(const VisibleFault& visible, double needed);

// The same of a fault with two sides: the one that is seen later, as no log says which would come. None where one of
// them is never seen.
std::optional<double> least_found_either_side(std::span<const VisibleFault> sides, double needed);

}  // namespace servodx
