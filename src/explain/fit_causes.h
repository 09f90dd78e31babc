// Fits of a subject with some causes in it: from where an earlier fit got to, each cause from where its score says.
//
// A fit minimises the deviance (deviance.h) by sums of squares whose weights follow what is left. It finds the minimum
// that lies nearest to its starts: the probes of the score test are the breadth.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "explain/cause_score.h"
#include "explain/subject.h"
#include "optimise/unit_cube.h"

namespace servodx {

// A fit with some causes in it.
struct ExplainedFit {
  bool wide = false;  // re-tuned
  std::vector<int> causes;
  SubjectFit fit;
  bool ok = false;
  Point point;
  double misfit = 0;    // sum of squares, priors included
  double deviance = 0;  // -2 log likelihood where a channel may err more than is usual: deviance_of
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  std::vector<std::vector<double>>
      heldout;                       // [block][series]: sum of squared rows of blocks that were left out in turn
  Eigen::VectorXd heldout_residual;  // physical, each block's from the fit that had not seen it
};

// The fit with these causes, from where `from` got to, the last one from where its score says. Quick: what was free in
// `from` keeps its derivatives. Re-tuned where `from` is, or where `wide` asks for it.
ExplainedFit fit_causes(const Subject& subject, const std::vector<int>& causes, const ExplainedFit* from,
                        const CauseScore* score, int iterations, bool quick, bool wide = false);
// Re-tuned alone; then the weights are what is left of it, and it is re-tuned with these.
ExplainedFit fit_base(Subject& subject, int iterations);
// The fit with these causes held at `numbers`, theirs one after another: what is free beside them, from where `from`
// is. A cause's columns of the Jacobian are zero.
ExplainedFit hold_causes(const Subject& subject, const std::vector<int>& causes, const Point& numbers,
                         const ExplainedFit& from, int iterations);

// Of a fit's numbers, how many are the base's: they come first.
std::size_t base_size(const Subject& subject, const ExplainedFit& fit);
// The numbers of a fit's causes, one after another.
Point numbers_of_causes(const Subject& subject, const ExplainedFit& fit);
// The point of `from` in the numbers of `to`, of which the last are these causes'; numbers that `from` lacks stand at
// their start.
Point carried(const Subject& subject, const ExplainedFit& from, const SubjectFit& to, const std::vector<int>& causes);

// Value and standard error of each number of a fit's cause. [unit] The error is NaN where a wall holds the number.
struct CauseNumbers {
  std::vector<double> value, std_error;
};
CauseNumbers numbers_of(const Subject& subject, const ExplainedFit& fit, int cause);

}  // namespace servodx
