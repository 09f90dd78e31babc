// Profile likelihood: the curvature's interval where the problem is as good as linear, a bound where it is not.
#include "fit/profile.h"

#include <gtest/gtest.h>

#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/support.h"
#include "optimise/box_least_squares.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

struct Fitted {
  FitProblem problem;
  LeastSquaresResult end;
  Eigen::MatrixXd covariance;
};

Fitted fitted(const LogData& log, const ParameterVector& base, const std::vector<FreeValue>& free) {
  FitProblem problem({&log}, base, free);
  LeastSquaresOptions o;
  o.max_iterations = 20;
  LeastSquaresResult end = minimise_least_squares(problem.least_squares(), problem.start(), o);
  Eigen::MatrixXd covariance = covariance_of(end.jacobian, std::vector<char>(free.size(), 1));
  return {std::move(problem), std::move(end), std::move(covariance)};
}

TEST(Profile, OfANearlyLinearNumberIsTheIntervalOfTheCurvature) {
  const Table table = shipped_table();
  const ParameterVector truth = candidate_of(table);
  const LogData log = written_by_model(slice(shipped_data("healthy/h12_mixed"), 0, 500), truth, 4);
  const Fitted fit = fitted(log, truth, {free_row(table, row::torque_motor_gain), free_row(table, row::port_width)});
  for (int j : {0, 1}) {
    const ProfileInterval found = profile(fit.problem, fit.end.point, j, fit.covariance);
    const double half = 1.96 * std::sqrt(fit.covariance(j, j)), centre = fit.end.point[j];
    EXPECT_FALSE(found.lower_open || found.upper_open);
    EXPECT_NEAR(found.upper - centre, half, 0.15 * half) << j;
    EXPECT_NEAR(centre - found.lower, half, 0.15 * half) << j;
  }
}

}  // namespace
}  // namespace servodx
