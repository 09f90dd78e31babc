#include "explain/ties.h"

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "optimise/unit_cube.h"

namespace servodx {
namespace {

struct TieRow {
  std::size_t first;  // of its numbers
  std::vector<double> weights;
};

std::vector<TieRow> tie_rows_of(const SubjectFit& fit, const std::vector<Cause>& all, const std::vector<int>& causes) {
  std::vector<TieRow> rows;
  std::size_t at = fit.numbers.size();
  for (int c : causes) at -= all[static_cast<std::size_t>(c)].numbers.size();
  for (int c : causes) {
    const Cause& cause = all[static_cast<std::size_t>(c)];
    for (const std::vector<double>& weights : cause.ties) rows.push_back({at, weights});
    at += cause.numbers.size();
  }
  return rows;
}

}  // namespace

void tie(SubjectFit& fit, const std::vector<Cause>& all, const std::vector<int>& causes) {
  const std::vector<TieRow> rows = tie_rows_of(fit, all, causes);
  if (rows.empty()) return;
  const auto m = static_cast<long>(rows.size());
  fit.problem.evaluate = [plain = fit.problem.evaluate, numbers = fit.numbers, rows, m](std::span<const Point> points) {
    std::vector<Evaluation> e = plain(points);
    for (std::size_t k = 0; k < e.size(); ++k) {
      Eigen::VectorXd& r = e[k].residual;
      r.conservativeResize(r.size() + m);
      for (long i = 0; i < m; ++i) {
        const TieRow& row = rows[static_cast<std::size_t>(i)];
        double sum = 0;
        for (std::size_t j = 0; j < row.weights.size(); ++j)
          sum += row.weights[j] *
                 (numbers[row.first + j].from_unit(points[k][row.first + j]) - numbers[row.first + j].off);
        r[r.size() - m + i] = sum;
      }
    }
    return e;
  };
  if (!fit.problem.jacobian) return;
  fit.problem.jacobian = [plain = fit.problem.jacobian, numbers = fit.numbers, rows, m](
                             const Point& x, const Eigen::VectorXd& r, Eigen::MatrixXd& j) {
    const long untied = r.size() - m;
    if (!plain(x, r.head(untied), j)) return false;
    j.conservativeResize(untied + m, Eigen::NoChange);
    j.bottomRows(m).setZero();
    for (long i = 0; i < m; ++i) {
      const TieRow& row = rows[static_cast<std::size_t>(i)];
      for (std::size_t k = 0; k < row.weights.size(); ++k)  // straight: a step of the whole range is its slope
        j(untied + i, static_cast<long>(row.first + k)) =
            row.weights[k] * (numbers[row.first + k].upper - numbers[row.first + k].lower);
    }
    return true;
  };
}

}  // namespace servodx
