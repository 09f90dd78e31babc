#include "explain/linear_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace servodx {

std::size_t states_of(const std::vector<LinearRun>& runs) {
  return static_cast<std::size_t>(runs.front().start.size());
}

std::size_t samples_of(const std::vector<LinearRun>& runs) {
  std::size_t n = 0;
  for (const LinearRun& r : runs) n += r.time.size();
  return n;
}

double longest_of(const std::vector<LinearRun>& runs) {
  double longest_run = 0;
  for (const LinearRun& r : runs) longest_run = std::max(longest_run, r.time.back() - r.time.front());
  return longest_run;
}

std::vector<LinearRun> pruned(const std::vector<LinearRun>& runs) {
  const auto n = static_cast<long>(states_of(runs)), m = runs.front().transition.front().cols() - n;
  Eigen::MatrixXd any = Eigen::MatrixXd::Zero(n, n + m);
  Eigen::VectorXd reached = Eigen::VectorXd::Zero(n), seen = reached;
  for (const LinearRun& r : runs) {
    for (const Eigen::MatrixXd& t : r.transition) any += (t.array() != 0).cast<double>().matrix();
    reached += r.start.cwiseAbs();
    for (const LinearChannel& c : r.channels) seen += c.shows.cwiseAbs();
  }
  const Eigen::MatrixXd among = any.leftCols(n);
  reached += any.rightCols(m).rowwise().sum();
  const auto ones = [](const Eigen::VectorXd& v) -> Eigen::VectorXd { return (v.array() != 0).cast<double>(); };
  for (long k = 0; k < n; ++k) {
    reached = ones(reached + among * ones(reached));
    seen = ones(seen + among.transpose() * ones(seen));
  }
  std::vector<long> kept;
  for (long i = 0; i < n; ++i)
    if (reached[i] != 0 && seen[i] != 0) kept.push_back(i);
  std::vector<long> columns = kept;
  for (long p = 0; p < m; ++p) columns.push_back(n + p);
  std::vector<LinearRun> out;
  for (const LinearRun& r : runs) {
    LinearRun& to = out.emplace_back(LinearRun{r.time, {}, r.start(kept), {}});
    for (const Eigen::MatrixXd& t : r.transition) to.transition.push_back(t(kept, columns));
    for (const LinearChannel& c : r.channels) to.channels.push_back({c.shows(kept), c.residual, c.sigma, c.memory});
  }
  return out;
}

LinearRun thinned(const LinearRun& run, int stride) {
  if (stride <= 1) return run;
  const auto s = static_cast<std::size_t>(stride);
  const long n = run.start.size(), m = run.transition.front().cols() - n;
  LinearRun out{{}, {}, run.start, {}};
  for (const LinearChannel& c : run.channels) {
    const double a = std::pow(c.memory, stride);
    LinearChannel& to = out.channels.emplace_back(LinearChannel{c.shows, {}, {}, a});
    // News of several samples, the older ones remembered.
    const double grown = c.memory > 0 ? std::sqrt((1 - a * a) / (1 - c.memory * c.memory)) : 1.0;
    for (std::size_t k = 0; k < run.time.size(); k += s)
      to.residual.push_back(c.residual[k]), to.sigma.push_back(grown * c.sigma[k]);
  }
  for (std::size_t k = 0; k < run.time.size(); k += s) {
    out.time.push_back(run.time[k]);
    if (k + s >= run.time.size()) break;
    Eigen::MatrixXd whole = run.transition[k];
    for (std::size_t j = k + 1; j < k + s; ++j) {
      const Eigen::MatrixXd& next = run.transition[j];
      whole = (next.leftCols(n) * whole).eval();
      whole.rightCols(m) += next.rightCols(m);
    }
    out.transition.push_back(std::move(whole));
  }
  return out;
}

}  // namespace servodx
