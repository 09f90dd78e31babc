// What a test tells, from the Gram matrix of its lanes' effects: squared distances of a fault from health and from its
// rivals, with all that these leave free taken out (a Schur complement), and what is left unknown of a row.
//
// distance^2 = r'r - r'J (J'J + 1)^-1 J'r, J the effects of what is free, each of one standard deviation of its prior:
// the gain in misfit that a log without noise would show, linear in what is free. Chaloner & Verdinelli 1995 (Bayesian
// experimental design) for the measure; Atkinson & Fedorov 1975 for the distance between rival models.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "plan/lanes.h"

namespace servodx {

class Information {
 public:
  Information(const Eigen::MatrixXd& gram, const LaneSet& set);

  // Squared deviates by which a lane stands out from health.
  double from_health(int lane) const { return std::max(0.0, from_health_(lane)); }
  // The same of a target from a rival at whatever severity comes nearest, between the severities of its lanes too.
  double from_rival(const TargetLane& target, std::size_t rival) const;
  // Standard deviation of a row after the test, over that before.
  double left_of(const RowLane& row) const;

 private:
  // A rival's lanes, side by side, and then the targets', with what the rival leaves free taken out.
  Eigen::MatrixXd beside(const RivalLanes& rival, const Eigen::MatrixXd& gram) const;
  const LaneSet& set_;
  Eigen::VectorXd from_health_;          // of each lane
  std::vector<Eigen::MatrixXd> rivals_;  // of each what `beside` says
  Eigen::VectorXd left_;                 // of beside_rows: variance after over before
};

}  // namespace servodx
