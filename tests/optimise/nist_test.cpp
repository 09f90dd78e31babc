// The local stage against certified answers, from the far and the near start of each problem.
#include <gtest/gtest.h>

#include "nist_problems.h"
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"

namespace servodx::test {
namespace {

// The far start of MGH10 (b1 400 times too large, in an exponent) is the one that is not reached: its box should be
// logarithmic.
TEST(BoxLeastSquares, ReachesTheCertifiedAnswersFromBothStarts) {
  LeastSquaresOptions options;
  options.max_iterations = 500;
  options.difference_step = 1e-6;  // the functions are exact to rounding
  options.cost_tolerance = 1e-14;
  int solved = 0, runs = 0;
  std::string missed;
  for (const NistProblem& nist : nist_problems()) {
    for (const auto& start : {nist.start1, nist.start2}) {
      ++runs;
      const LeastSquaresResult result = minimise_least_squares(least_squares(nist), to_cube(nist, start), options);
      const std::string where = nist.name + (start == nist.start1 ? " start 1" : " start 2");
      const std::vector<double> b = from_cube(nist, result.point);
      double error = 0;
      for (std::size_t j = 0; j < b.size(); ++j) error = std::max(error, std::abs(b[j] / nist.certified[j] - 1));
      if (error < 1e-4) {
        ++solved;
        EXPECT_NEAR(2 * result.misfit / nist.certified_sum_of_squares, 1.0, 1e-6) << where;
        EXPECT_LT(result.gradient_cosine, 1e-4) << where;
      } else {
        missed += where + "\n";
        EXPECT_NE(result.reason, StopReason::converged) << "claims to have converged elsewhere: " << where;
      }
    }
  }
  RecordProperty("solved", solved);
  EXPECT_GE(solved, runs - 1) << missed;
}

}  // namespace
}  // namespace servodx::test
