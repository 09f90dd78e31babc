#include "optimise/differences.h"

#include <cstddef>

namespace servodx {

int take_differences(const EvaluatePoints& evaluate, const Point& here, const Eigen::VectorXd& residual,
                     DifferenceStep by, Eigen::MatrixXd& jacobian) {
  const auto n = static_cast<int>(here.size());
  const double h = by.step;
  jacobian.resize(residual.size(), n);
  std::vector<int> column(n);
  for (int j = 0; j < n; ++j) column[j] = j;
  for (int attempt = 0; attempt < 2 && !column.empty(); ++attempt) {
    const bool two = by.central && attempt == 0;
    std::vector<Point> points;
    std::vector<double> first(column.size()), second(column.size(), 0.0);
    for (std::size_t k = 0; k < column.size(); ++k) {
      const double x = here[column[k]];
      double step = x + h <= 1.0 ? h : -h;
      if (attempt == 1 && x + h <= 1.0 && x - h >= 0.0) step = -h;
      if (attempt == 1 && step == h) step = 0.1 * h;  // no room on the other side: closer in
      const auto add = [&](double to) {
        Point p = here;
        p[column[k]] = to;
        points.push_back(std::move(p));
        return to - x;
      };
      first[k] = add(x + step);
      if (two) second[k] = add(x - step >= 0.0 && x - step <= 1.0 ? x - step : x + 2 * step);
    }
    const std::vector<Evaluation> values = evaluate(points);
    std::vector<int> left;
    for (std::size_t k = 0, at = 0; k < column.size(); ++k) {
      const Evaluation& one = values[at++];
      const Evaluation* other = two ? &values[at++] : nullptr;
      auto slope = jacobian.col(column[k]);
      if (one.ok && other && other->ok) {
        const double a = first[k],
                     b = second[k];  // the parabola through three points, exact on either side or on both
        slope = (one.residual - residual) * (-b / (a * (a - b))) + (other->residual - residual) * (a / (b * (a - b)));
      } else if (one.ok) {
        slope = (one.residual - residual) / first[k];
      } else if (other && other->ok) {
        slope = (other->residual - residual) / second[k];
      } else {
        left.push_back(column[k]);
      }
    }
    column = std::move(left);
  }
  for (int j : column) jacobian.col(j).setZero();
  return static_cast<int>(column.size());
}

}  // namespace servodx
