#include "explain/hold_out.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

#include "explain/constants.h"
#include "explain/deviance.h"
#include "optimise/unit_cube.h"

namespace servodx {
namespace {

using namespace explain_constants;

struct Block {
  int log;
  double from, to;  // fraction of the log's samples
};

std::vector<Block> blocks_of(const Subject& subject, int wanted) {
  const std::vector<long> samples = samples_of_logs(subject);
  const long total = std::accumulate(samples.begin(), samples.end(), 0L);
  std::vector<Block> out;
  for (std::size_t l = 0; l < samples.size(); ++l) {
    const int n =
        std::max(2, static_cast<int>(std::lround(static_cast<double>(wanted) * static_cast<double>(samples[l]) /
                                                 static_cast<double>(total))));
    for (int b = 0; b < n; ++b)
      out.push_back({static_cast<int>(l), static_cast<double>(b) / n, static_cast<double>(b + 1) / n});
  }
  return out;
}

std::pair<long, long> rows_in_block(const Series& s, const Block& b) {
  const auto n = static_cast<double>(s.count);
  const long from = std::lround(b.from * n), to = std::lround(b.to * n);
  return {s.first + from, to - from};
}

// Zero on the rows of a fold, one elsewhere.
Eigen::VectorXd without_fold(const Subject& subject, const std::vector<Block>& blocks, int folds, int fold) {
  Eigen::VectorXd mask = Eigen::VectorXd::Ones(data_rows(subject));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (static_cast<int>(b) % folds != fold) continue;
    for (const Series& s : subject.series())
      if (s.log == blocks[b].log) {
        const auto [at, n] = rows_in_block(s, blocks[b]);
        mask.segment(at, n).setZero();
      }
  }
  return mask;
}

// The step of the free numbers alone: the rest are held where they are.
Eigen::VectorXd free_step(const Eigen::MatrixXd& h, const Eigen::VectorXd& g, const std::vector<long>& free) {
  return -Eigen::MatrixXd(h(free, free)).ldlt().solve(Eigen::VectorXd(g(free)));
}

// Where a fit goes with its rows weighed so: one Gauss-Newton step, walls held.
Point stepped(const ExplainedFit& fit, const Eigen::VectorXd& weights) {
  const long n = fit.jacobian.cols();
  Eigen::MatrixXd j = fit.jacobian;
  Eigen::VectorXd r = fit.residual;
  j.topRows(weights.size()).array().colwise() *= weights.array();
  r.head(weights.size()).array() *= weights.array();
  Eigen::MatrixXd h = j.transpose() * j;
  const Eigen::VectorXd g = j.transpose() * r;
  h.diagonal() += gauss_newton_damping * h.diagonal() + Eigen::VectorXd::Constant(n, gauss_newton_least);
  std::vector<char> held(static_cast<std::size_t>(n), 0);
  Point x = fit.point;
  for (int round = 0; round < wall_rounds; ++round) {
    std::vector<long> free;
    for (long k = 0; k < n; ++k)
      if (!held[static_cast<std::size_t>(k)]) free.push_back(k);
    if (free.empty()) break;
    const Eigen::VectorXd step = free_step(h, g, free);
    bool again = false;
    for (std::size_t a = 0; a < free.size(); ++a) {
      const auto k = static_cast<std::size_t>(free[a]);
      const double to = fit.point[k] + step[static_cast<long>(a)];
      if (to < 0 || to > 1) held[k] = 1, again = true;
      x[k] = std::clamp(to, 0.0, 1.0);
    }
    if (!again) break;
    for (std::size_t k = 0; k < x.size(); ++k)
      if (held[k]) x[k] = fit.point[k];
  }
  return x;
}

std::vector<double> by_block(const ExplainedFit& fit) {
  std::vector<double> out;
  for (const std::vector<double>& block : fit.heldout) out.push_back(std::accumulate(block.begin(), block.end(), 0.0));
  return out;
}

std::vector<double> by_block(const Subject& subject, const ExplainedFit& fit, std::string_view signal) {
  std::vector<double> out;
  for (const std::vector<double>& block : fit.heldout) {
    double sum = 0;
    for (std::size_t i = 0; i < block.size(); ++i)
      if (subject.series()[i].signal == signal) sum += block[i];
    out.push_back(sum);
  }
  return out;
}

}  // namespace

void cross_validate(const Subject& subject, ExplainedFit& fit, const Folds& folds) {
  const std::vector<Block> blocks = blocks_of(subject, folds.blocks);
  const auto& series = subject.series();
  fit.heldout.assign(blocks.size(), std::vector<double>(series.size(), 1e300));
  fit.heldout_residual = subject.physical(fit.residual);
  const Eigen::VectorXd weights = weights_at(subject, fit.residual).head(data_rows(subject));
  std::vector<Point> moved;
  for (int fold = 0; fold < folds.folds; ++fold)
    moved.push_back(stepped(fit, without_fold(subject, blocks, folds.folds, fold).cwiseProduct(weights)));
  const std::vector<Evaluation> runs = fit.fit.problem.evaluate(moved);
  for (int fold = 0; fold < folds.folds; ++fold) {
    const Evaluation& e = runs[static_cast<std::size_t>(fold)];
    const Eigen::VectorXd physical = e.ok ? subject.physical(e.residual) : fit.heldout_residual;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (std::size_t i = 0; i < series.size(); ++i) {
        if (static_cast<int>(b) % folds.folds != fold) continue;
        if (series[i].log != blocks[b].log) {
          fit.heldout[b][i] = 0;
          continue;
        }
        const auto [at, n] = rows_in_block(series[i], blocks[b]);
        fit.heldout[b][i] = e.ok ? e.residual.segment(at, n).squaredNorm() : failed_square;
        fit.heldout_residual.segment(at, n) = physical.segment(at, n);
      }
  }
}

Interval heldout_gain(const ExplainedFit& before, const ExplainedFit& after, std::uint64_t seed) {
  return heldout_gain(by_block(before), by_block(after), seed, bootstrap_draws);
}

Interval heldout_share(const Subject& subject, const Cause& cause, const ExplainedFit& before,
                       const ExplainedFit& after, std::uint64_t seed) {
  if (!is_of_sensor(cause)) return heldout_gain(before, after, seed);
  return heldout_gain(by_block(subject, before, cause.of_channel), by_block(subject, after, cause.of_channel), seed,
                      bootstrap_draws);
}

}  // namespace servodx
