#include "explain/deviance.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "optimise/unit_cube.h"

namespace servodx {

double deviance_of(const Subject& subject, const Eigen::VectorXd& residual) {
  double sum = 0;
  long rows = 0;
  for (const Series& s : subject.series()) {
    const double independent = static_cast<double>(s.count) * s.effective;
    const double times = residual.segment(s.first, s.count).squaredNorm() / (independent * s.usual);
    sum += independent * (times > 1 ? 1 + std::log(times) : times);
    rows = std::max(rows, s.first + s.count);
  }
  return sum + residual.tail(residual.size() - rows).squaredNorm();
}

double degrees_of(const Subject& subject) {
  double n = 0;
  for (const Series& s : subject.series()) n += static_cast<double>(s.count) * s.effective;
  return n;
}

long data_rows(const Subject& subject) {
  long n = 0;
  for (const Series& s : subject.series()) n = std::max(n, s.first + s.count);
  return n;
}

std::vector<long> samples_of_logs(const Subject& subject) {
  std::vector<long> samples;
  for (const Series& s : subject.series()) {
    const auto log = static_cast<std::size_t>(s.log);
    if (log >= samples.size()) samples.resize(log + 1, 0);
    samples[log] = std::max(samples[log], s.count);
  }
  return samples;
}

Eigen::VectorXd weights_at(const Subject& subject, const Eigen::VectorXd& residual) {
  Eigen::VectorXd w = Eigen::VectorXd::Ones(residual.size());
  for (const Series& s : subject.series()) {
    const double independent = static_cast<double>(s.count) * s.effective;
    const double times = residual.segment(s.first, s.count).squaredNorm() / (independent * s.usual);
    if (times > 1) w.segment(s.first, s.count).setConstant(1 / std::sqrt(times));
  }
  return w;
}

LeastSquaresProblem weighed(const LeastSquaresProblem& p, const Eigen::VectorXd& w) {
  LeastSquaresProblem out = p;
  out.evaluate = [p, w](std::span<const Point> points) {
    std::vector<Evaluation> e = p.evaluate(points);
    for (Evaluation& one : e)
      if (one.ok) one.residual.array() *= w.array();
    return e;
  };
  if (p.jacobian)
    out.jacobian = [p, w](const Point& x, const Eigen::VectorXd& r, Eigen::MatrixXd& j) {
      if (!p.jacobian(x, r.cwiseQuotient(w), j)) return false;
      j.array().colwise() *= w.array();
      return true;
    };
  return out;
}

}  // namespace servodx
