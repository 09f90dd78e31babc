#include "optimise/box_quadratic.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace servodx {
namespace {

// The minimiser over the free entries with the walls held; free entries of `s` are overwritten in `target`.
Eigen::VectorXd solve_free(const Eigen::MatrixXd& a, const Eigen::VectorXd& g, const Eigen::VectorXd& s,
                           const std::vector<int>& wall) {
  std::vector<int> open, held;
  for (int j = 0; j < g.size(); ++j) (wall[j] == 0 ? open : held).push_back(j);
  Eigen::VectorXd target = s;
  if (open.empty()) return target;
  Eigen::VectorXd rhs = -g(open);
  if (!held.empty()) rhs -= a(open, held) * s(held);
  const Eigen::MatrixXd inner = a(open, open);
  const Eigen::VectorXd solved = inner.llt().solve(rhs);
  target(open) = solved;
  return target;
}

}  // namespace

BoxQuadraticResult minimise_box_quadratic(const Eigen::MatrixXd& a, const Eigen::VectorXd& g,
                                          const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const int n = static_cast<int>(g.size());
  BoxQuadraticResult result;
  result.step = Eigen::VectorXd::Zero(n);
  result.wall.assign(n, 0);
  Eigen::VectorXd& s = result.step;
  std::vector<int>& wall = result.wall;
  // Walls that the start already touches and the gradient pushes into are taken from the outset; it saves the most
  // solves.
  for (int j = 0; j < n; ++j) {
    if (lower[j] >= 0 && g[j] >= 0) wall[j] = -1;
    if (upper[j] <= 0 && g[j] <= 0) wall[j] = +1;
  }
  const double slack = 1e-13 * g.cwiseAbs().maxCoeff();
  std::vector<char> barred(n, 0);  // walls let go of in vain since the last true move
  const int limit = 20 * n + 20;
  int solves = 0;
  for (; solves < limit; ++solves) {
    const Eigen::VectorXd target = solve_free(a, g, s, wall);
    if (!target.allFinite()) break;
    double reach = 1.0;
    for (int j = 0; j < n; ++j) {
      if (wall[j] != 0) continue;
      const double move = target[j] - s[j];
      if (target[j] < lower[j]) reach = std::min(reach, (lower[j] - s[j]) / move);
      if (target[j] > upper[j]) reach = std::min(reach, (upper[j] - s[j]) / move);
    }
    if (reach < 1.0) {
      for (int j = 0; j < n; ++j) {
        if (wall[j] != 0) continue;
        const double move = target[j] - s[j];
        const double next = s[j] + reach * move;
        const double nudge = 4 * std::numeric_limits<double>::epsilon() * (upper[j] - lower[j]);
        if (target[j] < lower[j] && next <= lower[j] + nudge) {
          s[j] = lower[j];
          wall[j] = -1;
        } else if (target[j] > upper[j] && next >= upper[j] - nudge) {
          s[j] = upper[j];
          wall[j] = +1;
        } else {
          s[j] = std::clamp(next, lower[j], upper[j]);
        }
      }
      if (reach > 0) std::fill(barred.begin(), barred.end(), char{0});
      continue;
    }
    s = target;
    // Multipliers: at a lower wall the gradient must not be negative, at an upper wall not positive.
    const Eigen::VectorXd slope = a * s + g;
    int worst = -1;
    double worst_size = slack;
    for (int j = 0; j < n; ++j) {
      if (wall[j] == 0 || barred[j] || lower[j] == upper[j]) continue;
      const double pull = wall[j] < 0 ? -slope[j] : slope[j];
      if (pull > worst_size) {
        worst_size = pull;
        worst = j;
      }
    }
    if (worst < 0) break;
    wall[worst] = 0;
    barred[worst] = 1;
  }
  result.exact = solves < limit;
  result.decrease = -(0.5 * s.dot(a * s) + g.dot(s));
  return result;
}

}  // namespace servodx
