#include "tune/usual_slope.h"

#include <algorithm>
#include <cmath>

#include "base/tiny.h"
#include "fit/chart.h"
#include "simulate/nuisance.h"
#include "tune/constants.h"

namespace servodx {

std::optional<CommandSlope> usual_slope(const std::vector<SlopeOfLog>& logs) {
  if (logs.size() < tune_constants::enough_slopes) return {};
  const auto mean_beside = [&](double between, double& weight) {
    double sum = 0;
    weight = 0;
    for (const SlopeOfLog& l : logs) {
      const double w = 1 / (l.std_error * l.std_error + between + tiny);
      weight += w, sum += w * l.value;
    }
    return sum / weight;
  };
  double weight = 0;
  const double fixed = mean_beside(0, weight);
  double scatter = 0, squares = 0;  // Cochran's; of the weights
  for (const SlopeOfLog& l : logs) {
    const double w = 1 / (l.std_error * l.std_error + tiny);
    scatter += w * std::pow(l.value - fixed, 2), squares += w * w;
  }
  const double degrees = static_cast<double>(logs.size() - 1), left = weight - squares / weight;
  const double between = left > 0 ? std::max(0.0, (scatter - degrees) / left) : 0.0;
  const double usual = mean_beside(between, weight);
  // Few logs tell their own scatter badly: the next one's is Student's (Higgins, Thompson & Spiegelhalter 2009).
  const double of_student = degrees > 2 ? degrees / (degrees - 2) : degrees + 1;
  return CommandSlope{std::clamp(usual, 0.0, 1.0),
                      std::max(tune_constants::least_slope_spread, std::sqrt((between + 1 / weight) * of_student))};
}

std::vector<SlopeOfLog> slopes_of(const FitProblem& problem, const Point& point, const Eigen::MatrixXd& jacobian,
                                  const Eigen::MatrixXd& covariance) {
  std::vector<SlopeOfLog> out;
  if (jacobian.cols() != covariance.cols()) return out;  // a search that was stopped has no derivatives
  for (std::size_t j = 0; j < problem.free().size(); ++j) {
    const FreeValue& f = problem.free()[j];
    if (f.at != nuisance::command_slope) continue;
    const auto at = static_cast<long>(j);
    const double beside = std::sqrt(std::max(0.0, covariance(at, at))), alone = 1 / (jacobian.col(at).norm() + tiny);
    out.push_back({f.from_unit(point[j]), std::max(beside, alone) * (f.upper - f.lower)});
  }
  return out;
}

}  // namespace servodx
