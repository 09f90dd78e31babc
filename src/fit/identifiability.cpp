#include "fit/identifiability.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/tiny.h"
#include "fit/constants.h"
#include "optimise/ceres_covariance.h"

namespace servodx {

using namespace fit_constants::told;

Identifiability identify(const Eigen::MatrixXd& jacobian, const std::vector<char>& candidates) {
  const long n = jacobian.cols();
  Identifiability out;
  out.verdict.assign(n, RowVerdict::bounded);
  out.confounded_with.resize(n);
  out.norm.resize(n);
  // All that is needed is in the Gram matrix: n by n however long the logs.
  const Eigen::MatrixXd gram = jacobian.transpose() * jacobian;
  for (long j = 0; j < n; ++j) out.norm[j] = std::sqrt(std::max(0.0, gram(j, j)));
  std::vector<long> order;
  for (long j = 0; j < n; ++j)
    if (!candidates[j]) order.push_back(j);
  const auto first_candidate = static_cast<long>(order.size());
  for (long j = 0; j < n; ++j)
    if (candidates[j]) order.push_back(j);
  std::sort(order.begin() + first_candidate, order.end(), [&](long a, long b) { return out.norm[a] > out.norm[b]; });
  std::vector<long> kept;
  for (long j : order) {
    if (out.norm[j] < flat_limit) {
      if (candidates[j]) out.verdict[j] = RowVerdict::flat;
      if (out.norm[j] < least_length) continue;  // never kept: the Gram matrix of the kept ones must stay regular
    }
    double rest2 = gram(j, j);
    Eigen::VectorXd weights;
    if (!kept.empty()) {
      const auto m = static_cast<long>(kept.size());
      Eigen::MatrixXd g(m, m);
      Eigen::VectorXd b(m);
      for (long r = 0; r < m; ++r) {
        b[r] = gram(kept[r], j) / out.norm[kept[r]];
        for (long c = 0; c < m; ++c) g(r, c) = gram(kept[r], kept[c]) / (out.norm[kept[r]] * out.norm[kept[c]]);
      }
      weights = g.ldlt().solve(b);
      rest2 -= b.dot(weights);
    }
    const double rest = std::sqrt(std::max(0.0, rest2));
    if (candidates[j] && out.verdict[j] == RowVerdict::bounded &&
        rest < std::min(enough, out.norm[j] / collinearity_limit)) {
      out.verdict[j] = RowVerdict::confounded;
      std::vector<std::pair<double, int>> strongest;
      for (long r = 0; r < weights.size(); ++r) strongest.push_back({-std::abs(weights[r]), static_cast<int>(kept[r])});
      std::sort(strongest.begin(), strongest.end());
      for (std::size_t r = 0; r < strongest.size() && r < most_named; ++r)
        if (-strongest[r].first > least_named * out.norm[j]) out.confounded_with[j].push_back(strongest[r].second);
    }
    if (out.verdict[j] == RowVerdict::bounded && rest > least_of_its_own * out.norm[j]) kept.push_back(j);
  }
  return out;
}

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& jacobian, const std::vector<char>& kept) {
  const long n = jacobian.cols();
  std::vector<long> at;
  for (long j = 0; j < n; ++j)
    if (kept[j]) at.push_back(j);
  const auto m = static_cast<long>(at.size());
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
  if (m == 0) return full;
  const Eigen::MatrixXd gram = jacobian.transpose() * jacobian;
  Eigen::VectorXd scale(m);
  Eigen::MatrixXd g(m, m);
  for (long r = 0; r < m; ++r) scale[r] = std::sqrt(std::max(gram(at[r], at[r]), tiny));
  for (long r = 0; r < m; ++r)
    for (long c = 0; c < m; ++c) g(r, c) = gram(at[r], at[c]) / (scale[r] * scale[c]);
  const std::optional<Eigen::MatrixXd> by_ceres = covariance_by_ceres(g);
  const Eigen::MatrixXd inverse = by_ceres ? *by_ceres : g.completeOrthogonalDecomposition().pseudoInverse();
  for (long r = 0; r < m; ++r)
    for (long c = 0; c < m; ++c) full(at[r], at[c]) = inverse(r, c) / (scale[r] * scale[c]);
  return full;
}

}  // namespace servodx
