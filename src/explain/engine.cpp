#include "explain/engine.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/random.h"

namespace servodx {

double Number::to_unit(double value) const {
  const double v = std::clamp(value, lower, upper);
  return log_scale ? std::log(v / lower) / std::log(upper / lower) : (v - lower) / (upper - lower);
}
double Number::from_unit(double u) const {
  return log_scale ? lower * std::pow(upper / lower, u) : lower + u * (upper - lower);
}

void tie(SubjectFit& fit, const std::vector<Cause>& all, const std::vector<int>& causes) {
  struct Row {
    std::size_t first;  // of its numbers
    std::vector<double> weights;
  };
  std::vector<Row> rows;
  std::size_t at = fit.numbers.size();
  for (int c : causes) at -= all[static_cast<std::size_t>(c)].numbers.size();
  for (int c : causes) {
    const Cause& cause = all[static_cast<std::size_t>(c)];
    for (const std::vector<double>& weights : cause.ties) rows.push_back({at, weights});
    at += cause.numbers.size();
  }
  if (rows.empty()) return;
  const auto m = static_cast<long>(rows.size());
  fit.problem.evaluate = [plain = fit.problem.evaluate, numbers = fit.numbers, rows, m](std::span<const Point> points) {
    std::vector<Evaluation> e = plain(points);
    for (std::size_t k = 0; k < e.size(); ++k) {
      Eigen::VectorXd& r = e[k].residual;
      r.conservativeResize(r.size() + m);
      for (long i = 0; i < m; ++i) {
        const Row& row = rows[static_cast<std::size_t>(i)];
        double sum = 0;
        for (std::size_t j = 0; j < row.weights.size(); ++j)
          sum += row.weights[j] * numbers[row.first + j].from_unit(points[k][row.first + j]);
        r[r.size() - m + i] = sum;
      }
    }
    return e;
  };
  if (!fit.problem.jacobian) return;
  fit.problem.jacobian = [plain = fit.problem.jacobian, numbers = fit.numbers, rows, m](
                             const Point& x, const Eigen::VectorXd& r, Eigen::MatrixXd& j) {
    const long own = r.size() - m;
    if (!plain(x, r.head(own), j)) return false;
    j.conservativeResize(own + m, Eigen::NoChange);
    j.bottomRows(m).setZero();
    for (long i = 0; i < m; ++i) {
      const Row& row = rows[static_cast<std::size_t>(i)];
      for (std::size_t k = 0; k < row.weights.size(); ++k)  // straight: a step of the whole range is its slope
        j(own + i, static_cast<long>(row.first + k)) =
            row.weights[k] * (numbers[row.first + k].upper - numbers[row.first + k].lower);
    }
    return true;
  };
}

namespace {

std::size_t base_size(const Subject& subject, const ExplainedFit& f) {
  std::size_t n = f.fit.numbers.size();
  for (int c : f.causes) n -= subject.causes()[static_cast<std::size_t>(c)].numbers.size();
  return n;
}

// A point of `from` in the numbers of `to`; numbers that `from` lacks stand at their start.
Point carried(const Subject& subject, const ExplainedFit& from, const SubjectFit& to, const std::vector<int>& causes) {
  Point x = to.start;
  const std::size_t base = base_size(subject, from);
  for (std::size_t j = 0; j < base; ++j)
    for (std::size_t k = 0; k < to.numbers.size(); ++k)
      if (j == k && to.numbers[k].name == from.fit.numbers[j].name) x[k] = from.point[j];
  std::size_t to_base = to.numbers.size();
  for (int c : causes) to_base -= subject.causes()[static_cast<std::size_t>(c)].numbers.size();
  std::size_t at = to_base;
  for (int c : causes) {
    const std::size_t n = subject.causes()[static_cast<std::size_t>(c)].numbers.size();
    std::size_t there = base;
    for (int f : from.causes) {
      const std::size_t m = subject.causes()[static_cast<std::size_t>(f)].numbers.size();
      if (f == c)
        for (std::size_t j = 0; j < n; ++j) x[at + j] = from.point[there + j];
      there += m;
    }
    at += n;
  }
  return x;
}

LeastSquaresOptions how(int iterations, bool curve) {
  LeastSquaresOptions o;
  if (curve) o.damping_trials = 3;  // no batch makes its runs cheap
  o.max_iterations = iterations;
  o.difference = Difference::forward;
  o.cost_tolerance = 1e-4;
  return o;
}

// Where a fit goes when the rows that `mask` zeroes are left out: one Gauss-Newton step, walls held.
Point stepped(const ExplainedFit& fit, const Eigen::VectorXd& mask) {
  const long n = fit.jacobian.cols();
  Eigen::MatrixXd j = fit.jacobian;
  Eigen::VectorXd r = fit.residual;
  j.topRows(mask.size()).array().colwise() *= mask.array();
  r.head(mask.size()).array() *= mask.array();
  Eigen::MatrixXd h = j.transpose() * j;
  const Eigen::VectorXd g = j.transpose() * r;
  h.diagonal() += 1e-6 * h.diagonal() + Eigen::VectorXd::Constant(n, 1e-9);
  std::vector<char> held(static_cast<std::size_t>(n), 0);
  Point x = fit.point;
  for (int round = 0; round < 8; ++round) {
    std::vector<long> free;
    for (long k = 0; k < n; ++k)
      if (!held[static_cast<std::size_t>(k)]) free.push_back(k);
    if (free.empty()) break;
    const auto m = static_cast<long>(free.size());
    Eigen::MatrixXd hf(m, m);
    Eigen::VectorXd gf(m);
    for (long a = 0; a < m; ++a) {
      gf[a] = g[free[static_cast<std::size_t>(a)]];
      for (long b = 0; b < m; ++b) hf(a, b) = h(free[static_cast<std::size_t>(a)], free[static_cast<std::size_t>(b)]);
    }
    const Eigen::VectorXd step = -hf.ldlt().solve(gf);
    bool again = false;
    for (long a = 0; a < m; ++a) {
      const auto k = static_cast<std::size_t>(free[static_cast<std::size_t>(a)]);
      const double to = fit.point[k] + step[a];
      if (to < 0 || to > 1) held[k] = 1, again = true;
      x[k] = std::clamp(to, 0.0, 1.0);
    }
    if (!again) break;
    for (std::size_t k = 0; k < x.size(); ++k)
      if (held[k]) x[k] = fit.point[k];
  }
  return x;
}

long data_rows(const Subject& subject) {
  long n = 0;
  for (const Series& s : subject.series()) n = std::max(n, s.first + s.count);
  return n;
}

// Blocks of time: every log is cut into pieces of about the same length, which all its channels share.
struct Block {
  int log;
  double from, to;  // fraction of the log's samples
};
std::vector<Block> blocks_of(const Subject& subject, int wanted) {
  std::vector<long> samples;
  for (const Series& s : subject.series()) {
    if (static_cast<std::size_t>(s.log) >= samples.size()) samples.resize(static_cast<std::size_t>(s.log) + 1, 0);
    samples[static_cast<std::size_t>(s.log)] = std::max(samples[static_cast<std::size_t>(s.log)], s.count);
  }
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
std::pair<long, long> rows_of(const Series& s, const Block& b) {
  const auto n = static_cast<double>(s.count);
  const long from = std::lround(b.from * n), to = std::lround(b.to * n);
  return {s.first + from, to - from};
}

// deviance_of as a sum of squares: about this residual, the weight of each row that makes their gradients alike.
// Refitted with the weights of what is left, a sum of squares arrives where the deviance is least.
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

}  // namespace

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

ExplainedFit fit_causes(const Subject& subject, const std::vector<int>& causes, const ExplainedFit* from,
                        const CauseScore* score, int iterations, bool quick, bool wide) {
  ExplainedFit out;
  out.causes = causes;
  out.wide = wide || (from && from->wide);
  out.fit = subject.fit(causes, out.wide);
  std::vector<Point> starts = {from ? carried(subject, *from, out.fit, causes) : out.fit.start};
  if (score) {
    // The cause comes last. It begins where its score says, and at its probes; the best goes on.
    const Cause& cause = subject.causes()[static_cast<std::size_t>(score->cause)];
    const std::size_t at = out.fit.numbers.size() - cause.numbers.size();
    const Point x = starts.front();
    starts.clear();
    std::size_t k = 0;
    for (const auto& alternative : cause.probes) {
      Point together = x;
      for (const auto& probe : alternative) {
        Point alone = x;
        for (std::size_t j = 0; j < cause.numbers.size(); ++j) {
          const Number& n = cause.numbers[j];
          const double moved = n.size ? n.off + score->probes[k].size * (probe[j] - n.off) : probe[j];
          if (n.size && probe[j] == n.off) continue;
          together[at + j] = n.to_unit(moved);
          alone[at + j] = n.to_unit(probe[j]);
        }
        if (alternative.size() == 1) starts.push_back(alone);
        ++k;
      }
      starts.push_back(together);
    }
  }
  Point start = starts.front();
  std::optional<Eigen::VectorXd> weights;  // none where nothing is known of the start
  if (from) {
    const std::vector<Evaluation> e = out.fit.problem.evaluate(starts);
    double best = 1e300;
    for (std::size_t i = 0; i < e.size(); ++i)
      if (const double d = e[i].ok ? deviance_of(subject, e[i].residual) : 1e300; d < best) {
        best = d, start = starts[i];
        weights = weights_at(subject, e[i].residual);
      }
  }
  LeastSquaresProblem problem = out.fit.problem;
  if (score && quick) {
    // What was free before keeps its derivatives; only the new numbers' are taken again: a few runs in place of many.
    const long old = from->jacobian.cols(), n = out.fit.problem.n;
    problem.jacobian = [p = out.fit.problem, kept = from->jacobian, old, n](const Point& x, const Eigen::VectorXd& r,
                                                                            Eigen::MatrixXd& j) {
      constexpr double step = 1e-3;
      std::vector<Point> moved;
      std::vector<double> dx;
      for (long k = old; k < n; ++k) {
        moved.push_back(x);
        dx.push_back(x[static_cast<std::size_t>(k)] + step <= 1 ? step : -step);
        moved.back()[static_cast<std::size_t>(k)] += dx.back();
      }
      const std::vector<Evaluation> e = p.evaluate(moved);
      j.setZero(r.size(), n);
      j.topLeftCorner(kept.rows(), old) = kept;  // priors of the new numbers come last
      for (std::size_t k = 0; k < e.size(); ++k) {
        if (!e[k].ok) return false;
        j.col(old + static_cast<long>(k)) = (e[k].residual - r) / dx[k];
      }
      return true;
    };
  }
  const bool curve = std::any_of(causes.begin(), causes.end(),
                                 [&](int c) { return subject.causes()[static_cast<std::size_t>(c)].curve; });
  // Twice where weights are in play: what is left of a channel once the cause is in it is not what it began with.
  const int passes = weights && weights->minCoeff() < 1 ? 2 : 1;
  for (int pass = 0; pass < passes; ++pass) {
    const bool plain = passes == 1;
    const LeastSquaresResult r =
        minimise_least_squares(plain ? problem : weighed(problem, *weights), start, how(iterations, curve));
    if (r.reason == StopReason::start_failed) return out;
    const Eigen::VectorXd residual = plain ? r.residual : r.residual.cwiseQuotient(*weights);
    const double deviance = deviance_of(subject, residual);
    if (out.ok && deviance > out.deviance) break;
    out.ok = true;
    out.point = start = r.point;
    out.misfit = residual.squaredNorm();
    out.deviance = deviance;
    out.residual = residual;
    out.jacobian = r.jacobian;
    if (!plain) out.jacobian.array().colwise() /= weights->array();
    weights = weights_at(subject, residual);
  }
  return out;
}

Point numbers_of_causes(const Subject& subject, const ExplainedFit& fit) {
  return {fit.point.begin() + static_cast<long>(base_size(subject, fit)), fit.point.end()};
}

ExplainedFit hold_causes(const Subject& subject, const std::vector<int>& causes, const Point& numbers,
                         const ExplainedFit& from, int iterations) {
  ExplainedFit out;
  out.wide = from.wide;
  out.causes = causes;
  out.fit = subject.fit(causes, out.wide);
  const std::size_t base = base_size(subject, out);
  const auto whole = [&](Point x) {
    x.insert(x.end(), numbers.begin(), numbers.end());
    return x;
  };
  LeastSquaresProblem held;
  held.n = static_cast<int>(base);
  held.evaluate = [&](std::span<const Point> points) {
    std::vector<Point> all;
    for (const Point& p : points) all.push_back(whole(p));
    return out.fit.problem.evaluate(all);
  };
  const Point start(from.point.begin(), from.point.begin() + static_cast<long>(base));
  const LeastSquaresResult r = minimise_least_squares(held, start, how(iterations, false));
  if (r.reason == StopReason::start_failed) return out;
  out.ok = true;
  out.point = whole(r.point);
  out.residual = r.residual;
  out.misfit = r.residual.squaredNorm();
  out.deviance = deviance_of(subject, r.residual);
  out.jacobian.setZero(r.jacobian.rows(), static_cast<long>(out.point.size()));
  out.jacobian.leftCols(r.jacobian.cols()) = r.jacobian;
  return out;
}

std::vector<CauseScore> score_causes(const Subject& subject, const ExplainedFit& at,
                                     const std::function<bool(const Cause&)>& among) {
  std::vector<int> all(subject.causes().size());
  std::iota(all.begin(), all.end(), 0);
  const auto looked_at = [&](const Cause& c) { return !among || among(c); };
  const SubjectFit whole = subject.fit(all, at.wide);
  const Point here = carried(subject, at, whole, all);
  std::vector<Point> points = {here};
  std::size_t base = whole.numbers.size();
  for (const Cause& c : subject.causes()) base -= c.numbers.size();
  std::size_t first = base;
  for (const Cause& c : subject.causes()) {
    for (const auto& alternative : c.probes)
      for (const auto& probe : alternative) {
        if (!looked_at(c)) continue;
        Point p = here;
        for (std::size_t j = 0; j < c.numbers.size(); ++j) p[first + j] = c.numbers[j].to_unit(probe[j]);
        points.push_back(std::move(p));
      }
    first += c.numbers.size();
  }
  const std::vector<Evaluation> e = whole.problem.evaluate(points);
  // What the free numbers, priors included, cannot imitate.
  const long rows = data_rows(subject);
  struct Imitation {
    Eigen::HouseholderQR<Eigen::MatrixXd> qr;
    long columns = 0;
    Eigen::VectorXd apart(const Eigen::VectorXd& v) const {
      Eigen::VectorXd y = qr.householderQ().transpose() * v;
      y.head(std::min<long>(columns, y.size())).setZero();
      return qr.householderQ() * y;
    }
  };
  const auto but = [&](const std::string& atop) {
    Eigen::MatrixXd imitated(at.jacobian.rows(), 0);
    for (long j = 0; j < at.jacobian.cols(); ++j) {
      const double u = at.point[static_cast<std::size_t>(j)];
      if (u < 1e-6 || u > 1 - 1e-6) continue;  // a wall holds it
      if (!atop.empty() && at.fit.numbers[static_cast<std::size_t>(j)].name == atop) continue;
      imitated.conservativeResize(Eigen::NoChange, imitated.cols() + 1);
      imitated.col(imitated.cols() - 1) = at.jacobian.col(j);
    }
    const long columns = imitated.cols();
    return Imitation{Eigen::HouseholderQR<Eigen::MatrixXd>(imitated), columns};
  };
  const Imitation of_all = but("");
  const Eigen::VectorXd& r0 = at.residual;
  const double left = deviance_of(subject, r0);
  std::vector<CauseScore> out;
  std::size_t k = 1;
  for (std::size_t c = 0; c < subject.causes().size(); ++c) {
    const Cause& cause = subject.causes()[c];
    CauseScore s;
    s.cause = static_cast<int>(c);
    if (!looked_at(cause)) {
      out.push_back(std::move(s));
      continue;
    }
    std::optional<Imitation> of_rest;
    if (!cause.atop.empty()) {
      of_rest = but(cause.atop);
      double n = 0, sum = 0;
      for (std::size_t j = 0; j < base_size(subject, at); ++j)
        if (const Number& number = at.fit.numbers[j]; number.name == cause.atop)
          sum += number.from_unit(at.point[j]), ++n;
      if (n > 0) s.of = sum / n;
    }
    const Imitation& imitation = of_rest ? *of_rest : of_all;
    for (std::size_t a = 0; a < cause.probes.size(); ++a) {
      Eigen::MatrixXd d(at.residual.size(), 0);
      for (const auto& probe : cause.probes[a]) {
        const Evaluation& one = e[k++];
        ProbeScore p;
        p.std_error = std::nan("");
        if (one.ok && e[0].ok) {
          Eigen::VectorXd v = Eigen::VectorXd::Zero(at.residual.size());
          v.head(rows) = one.residual.head(rows) - e[0].residual.head(rows);
          v = imitation.apart(v);
          const double square = v.squaredNorm();
          if (square > 1e-12) {
            p.size = -v.dot(r0) / square;
            p.std_error = 1.0 / std::sqrt(square);
            // A cause that begins at a wall cannot be less than absent.
            bool wall = true;
            for (std::size_t j = 0; j < cause.numbers.size(); ++j) {
              const Number& n = cause.numbers[j];
              if (n.size && probe[j] != n.off && (probe[j] > n.off ? n.off > n.lower : n.off < n.upper)) wall = false;
            }
            if (!(wall && p.size < 0)) {
              // As it is at the probe: a large effect is no straight line.
              s.gain = std::max(s.gain, left - deviance_of(subject, r0 + v));
              d.conservativeResize(Eigen::NoChange, d.cols() + 1);
              d.col(d.cols() - 1) = v;
            }
          }
        }
        s.probes.push_back(p);
      }
      Eigen::VectorXd r = r0;
      for (int pass = 0; pass < 2 && d.cols() > 0; ++pass) {
        const Eigen::VectorXd w = weights_at(subject, r);
        r = r0 - d * (w.asDiagonal() * d).colPivHouseholderQr().solve(w.cwiseProduct(r0));
        if (const double gain = left - deviance_of(subject, r); gain > s.gain)
          s.gain = gain, s.alternative = static_cast<int>(a);
      }
    }
    out.push_back(std::move(s));
  }
  return out;
}

void cross_validate(const Subject& subject, ExplainedFit& fit, const EngineOptions& options) {
  const std::vector<Block> blocks = blocks_of(subject, options.blocks);
  const auto& series = subject.series();
  fit.heldout.assign(blocks.size(), std::vector<double>(series.size(), 1e300));
  fit.heldout_residual = subject.physical(fit.residual);
  const long rows = data_rows(subject);
  const auto held = [&](std::size_t b, int fold) { return static_cast<int>(b) % options.folds == fold; };
  // Without its blocks the minimum moves a little: one Gauss-Newton step on the box finds it.
  std::vector<Point> moved;
  for (int fold = 0; fold < options.folds; ++fold) {
    Eigen::VectorXd mask = Eigen::VectorXd::Ones(rows);
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (const Series& s : series)
        if (held(b, fold) && s.log == blocks[b].log) {
          const auto [at, n] = rows_of(s, blocks[b]);
          mask.segment(at, n).setZero();
        }
    moved.push_back(stepped(fit, mask.cwiseProduct(weights_at(subject, fit.residual).head(rows))));
  }
  const std::vector<Evaluation> runs = fit.fit.problem.evaluate(moved);
  for (int fold = 0; fold < options.folds; ++fold) {
    const Evaluation& e = runs[static_cast<std::size_t>(fold)];
    const Eigen::VectorXd physical = e.ok ? subject.physical(e.residual) : fit.heldout_residual;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (std::size_t i = 0; i < series.size(); ++i) {
        if (!held(b, fold)) continue;
        if (series[i].log != blocks[b].log) {
          fit.heldout[b][i] = 0;
          continue;
        }
        const auto [at, n] = rows_of(series[i], blocks[b]);
        fit.heldout[b][i] = e.ok ? e.residual.segment(at, n).squaredNorm() : 1e12;
        fit.heldout_residual.segment(at, n) = physical.segment(at, n);
      }
  }
}

Interval heldout_gain(const ExplainedFit& before, const ExplainedFit& after, std::uint64_t seed) {
  constexpr int draws = 1000;
  const std::size_t n = before.heldout.size();
  std::vector<double> was(n), is(n);
  for (std::size_t b = 0; b < n; ++b) {
    was[b] = std::accumulate(before.heldout[b].begin(), before.heldout[b].end(), 0.0);
    is[b] = std::accumulate(after.heldout[b].begin(), after.heldout[b].end(), 0.0);
  }
  const auto gain = [](double w, double i) { return w > 0 ? 1.0 - i / w : 0.0; };
  std::vector<double> drawn;
  for (int k = 0; k < draws; ++k) {
    Random random(seed, static_cast<std::uint32_t>(k), 0xb00f);
    double w = 0, i = 0;
    for (std::size_t b = 0; b < n; ++b) {
      const auto pick = static_cast<std::size_t>(random.below(static_cast<std::uint32_t>(n)));
      w += was[pick], i += is[pick];
    }
    drawn.push_back(gain(w, i));
  }
  std::sort(drawn.begin(), drawn.end());
  return {gain(std::accumulate(was.begin(), was.end(), 0.0), std::accumulate(is.begin(), is.end(), 0.0)),
          drawn[draws / 20], drawn[draws - 1 - draws / 20]};
}

namespace {

// Values and standard errors of the last cause of a fit.
void size_up(const Subject& subject, const ExplainedFit& f, CauseResult& out) {
  const long n = f.jacobian.cols();
  Eigen::MatrixXd gram = f.jacobian.transpose() * f.jacobian;
  std::vector<char> free(static_cast<std::size_t>(n));
  for (long j = 0; j < n; ++j) {
    const double u = f.point[static_cast<std::size_t>(j)];
    free[static_cast<std::size_t>(j)] = u > 1e-6 && u < 1 - 1e-6;
    if (!free[static_cast<std::size_t>(j)]) gram.row(j).setZero(), gram.col(j).setZero(), gram(j, j) = 1;
  }
  gram.diagonal().array() += 1e-12 * gram.diagonal().maxCoeff();
  const Eigen::MatrixXd covariance = gram.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  // The likelihood already counts the model's own error; where it fits worse than that, the errors are wider.
  const double worse = std::sqrt(std::max(1.0, f.misfit / std::max(1.0, degrees_of(subject))));
  std::size_t at = base_size(subject, f);
  for (int c : f.causes) {
    const Cause& cause = subject.causes()[static_cast<std::size_t>(c)];
    if (c == out.cause) {
      out.value.clear(), out.std_error.clear();
      for (std::size_t j = 0; j < cause.numbers.size(); ++j) {
        const Number& number = cause.numbers[j];
        const double u = f.point[at + j];
        const double value = number.from_unit(u);
        const double slope =
            number.log_scale ? value * std::log(number.upper / number.lower) : number.upper - number.lower;
        const auto k = static_cast<long>(at + j);
        out.value.push_back(value);
        out.std_error.push_back(free[at + j] ? worse * slope * std::sqrt(std::max(0.0, covariance(k, k)))
                                             : std::nan(""));
      }
    }
    at += cause.numbers.size();
  }
}

double delta_bic(const ExplainedFit& before, const ExplainedFit& after, double degrees) {
  const double numbers = static_cast<double>(after.fit.numbers.size()) - static_cast<double>(before.fit.numbers.size());
  return before.deviance - after.deviance - numbers * std::log(std::max(2.0, degrees));
}

}  // namespace

ExplainedFit fit_base(Subject& subject, int iterations) {
  ExplainedFit fit = fit_causes(subject, {}, nullptr, nullptr, iterations, false);
  if (fit.ok && subject.rescale(fit.residual)) fit = fit_causes(subject, {}, &fit, nullptr, iterations / 2, false);
  return fit;
}

Explanation explain(Subject& subject, const EngineOptions& options, const Explanation* begun) {
  constexpr int quick_iterations = 4, full_iterations = 4;
  Explanation out;
  const auto stopped = [&] { return options.stop && options.stop->load(); };
  const auto tell = [&](double f) {
    if (options.progress) options.progress(f);
  };
  out.before = begun ? begun->before : fit_base(subject, options.iterations);
  tell(0.1);
  out.after = out.before;
  out.degrees = degrees_of(subject);
  if (!out.before.ok || stopped()) return out;
  if (!begun) cross_validate(subject, out.before, options);
  tell(0.15);
  const std::size_t n = subject.causes().size();
  out.candidates.resize(n);
  for (std::size_t c = 0; c < n; ++c) out.candidates[c].cause = static_cast<int>(c);
  if (begun) {
    out.wide = begun->wide;
  } else if (subject.retunes() && !subject.holds()) {
    out.wide = fit_causes(subject, {}, &out.before, nullptr, full_iterations, false, true);
    if (out.wide.ok) cross_validate(subject, out.wide, options);
  }
  if (out.wide.ok) out.retuned = heldout_gain(out.before, out.wide, options.seed);
  ExplainedFit retuned = out.wide;
  tell(0.2);

  ExplainedFit now = out.before;
  std::vector<ExplainedFit> steps;  // before each accepted cause
  for (int round = 0; round < options.most && !stopped(); ++round) {
    const std::vector<CauseScore> scores = score_causes(subject, now, options.among);
    if (round == 0) out.scores = scores;
    // A second false alarm on the same data shall be as rare as two.
    const double share = options.p_left ? 0.5 * options.level : options.level;
    const double level = round == 0 ? share : share * share;
    const bool abnormal = options.p_left && options.p_left(now, round) <= level;
    const bool abnormal_rows = abnormal && options.p_left(now, round + 1) <= level;  // not by its blocks alone
    std::vector<double> p(n, options.p_new ? 1.0 : 0.0);
    for (std::size_t c = 0; c < n; ++c) {
      if (scores[c].probes.empty()) continue;  // not looked at
      if (options.p_new) p[c] = options.p_new(scores[c], round);
      CandidateResult& r = out.candidates[c];
      if (round == 0) r.predicted_gain = scores[c].gain, r.p_new = p[c], r.fate = Fate::score_too_small;
    }
    // Where the data are abnormal as a whole, a cause need not be news by itself. Where they are not, what is found
    // suffices, and a rare cause beside it only takes some of its size.
    const bool suffices = round > 0 && options.p_left && !abnormal;
    const auto is_new = [&](int c) {
      const auto k = static_cast<std::size_t>(c);
      if (scores[k].probes.empty()) return false;  // not looked at
      if (suffices && subject.causes()[k].prior < 1) return false;
      return p[k] <= level || abnormal;
    };
    // In already, or it goes by a number of one that is: two names of one number would leave the first without a say.
    const auto in = [&](int c) {
      const auto& mine = subject.causes()[static_cast<std::size_t>(c)].numbers;
      return std::any_of(now.causes.begin(), now.causes.end(), [&](int taken) {
        const auto& its = subject.causes()[static_cast<std::size_t>(taken)].numbers;
        return taken == c || std::any_of(mine.begin(), mine.end(), [&](const Number& a) {
                 return std::any_of(its.begin(), its.end(), [&](const Number& b) { return a.name == b.name; });
               });
      });
    };
    std::vector<CauseScore> order = scores;
    const auto news = [&](int c) { return p[static_cast<std::size_t>(c)] <= level; };  // by itself
    // What is new first, by itself before what is so only because the data are abnormal; then by what it promises. In
    // the first round a few that are not new are looked at as well: what stands in healthy data is said.
    std::stable_sort(order.begin(), order.end(), [&](const CauseScore& a, const CauseScore& b) {
      if (is_new(a.cause) != is_new(b.cause)) return is_new(a.cause);
      if (is_new(a.cause) && news(a.cause) != news(b.cause)) return news(a.cause);
      return a.gain > b.gain;
    });
    std::vector<ExplainedFit> fits;
    int standing_left = round == 0 && options.p_new && !begun ? 2 : 0;
    int new_left = options.fitted, rare_left = options.fitted / 2;
    for (const CauseScore& s : order) {
      if (stopped()) break;
      if (options.among && !options.among(subject.causes()[static_cast<std::size_t>(s.cause)])) continue;
      if (in(s.cause) || s.gain < std::log(std::max(2.0, out.degrees))) continue;
      const bool rare = subject.causes()[static_cast<std::size_t>(s.cause)].prior < 1;
      if ((is_new(s.cause) ? rare ? rare_left : new_left : standing_left)-- <= 0) continue;
      std::vector<int> causes = now.causes;
      causes.push_back(s.cause);
      ExplainedFit f = fit_causes(subject, causes, &now, &s, quick_iterations, true);
      if (f.ok) fits.push_back(std::move(f));
      tell(0.15 +
           0.6 * (round + std::min(1.0, static_cast<double>(fits.size()) / (1.5 * options.fitted))) / options.most);
    }
    const auto prior_of = [&](const ExplainedFit& f) {
      return subject.causes()[static_cast<std::size_t>(f.causes.back())].prior;
    };
    // The commoner first, then what is news by itself, then by what they gain.
    std::stable_sort(fits.begin(), fits.end(), [&](const ExplainedFit& a, const ExplainedFit& b) {
      if (prior_of(a) != prior_of(b)) return prior_of(a) > prior_of(b);
      if (news(a.causes.back()) != news(b.causes.back())) return news(a.causes.back());
      return delta_bic(now, a, out.degrees) > delta_bic(now, b, out.degrees);
    });
    std::vector<int> judged;                        // positions in fits
    std::vector<ExplainedFit> beside(fits.size());  // the same on top of re-tuning
    std::vector<Interval> beyond(fits.size());
    int new_judged = 0, rare_judged = 0;
    for (std::size_t i = 0; i < fits.size() && !stopped(); ++i) {
      const int c = fits[i].causes.back();
      CandidateResult later, &r = round == 0 ? out.candidates[static_cast<std::size_t>(c)] : later;
      r.fitted = true;
      r.delta_bic = delta_bic(now, fits[i], out.degrees);
      r.fate = r.delta_bic <= 0 ? Fate::not_worth_its_numbers : Fate::others_fit_better;
      const bool rare = prior_of(fits[i]) < 1;
      int& counted = rare ? rare_judged : new_judged;
      if (r.delta_bic <= 0 || (is_new(c) && counted >= (rare ? options.judged / 2 : options.judged))) continue;
      counted += is_new(c);
      ExplainedFit whole = fit_causes(subject, fits[i].causes, &fits[i], nullptr, full_iterations, false);
      if (whole.ok && whole.deviance < fits[i].deviance) fits[i] = std::move(whole);
      r.delta_bic = delta_bic(now, fits[i], out.degrees);
      cross_validate(subject, fits[i], options);
      r.heldout_gain = heldout_gain(now, fits[i], options.seed);
      if (retuned.ok) {
        const CauseScore* score =
            &*std::find_if(scores.begin(), scores.end(), [&](const auto& s) { return s.cause == c; });
        ExplainedFit with = fit_causes(subject, fits[i].causes, &retuned, score, quick_iterations, true);
        if (with.ok) cross_validate(subject, with, options);
        r.beyond_retuning = with.ok ? heldout_gain(retuned, with, options.seed) : Interval{};
        beyond[i] = r.beyond_retuning;
        beside[i] = std::move(with);
      }
      // A name that is not news by itself has to be what makes the data abnormal.
      const bool restores = subject.causes()[static_cast<std::size_t>(c)].curve || news(c) || !is_new(c) ||
                            !abnormal_rows || options.p_left(fits[i], round + 1) > level;
      if (!restores) {
        r.fate = Fate::abnormal_with_it;
        if (round == 0 && r.heldout_gain.lower > 0) out.refused.push_back(fits[i]);
      } else if (retuned.ok && r.beyond_retuning.value <= 0) {
        r.fate = Fate::retuning_does_as_well;
      } else if (r.heldout_gain.lower > 0) {
        judged.push_back(static_cast<int>(i));
      } else {
        r.fate = Fate::no_heldout_gain;
      }
    }
    const auto make_result = [&](std::size_t i, bool fresh) {
      CauseResult r;
      r.cause = fits[i].causes.back();
      r.is_new = fresh;
      r.heldout_gain = heldout_gain(now, fits[i], options.seed);
      r.delta_bic = delta_bic(now, fits[i], out.degrees);
      r.misfit_gain = now.deviance - fits[i].deviance;
      r.beyond_retuning = beyond[i];
      size_up(subject, fits[i], r);
      return r;
    };
    int best = -1;
    for (int i : judged) {
      const std::size_t k = static_cast<std::size_t>(i);
      const int c = fits[k].causes.back();
      if (!is_new(c)) {
        out.candidates[static_cast<std::size_t>(c)].fate = Fate::not_beyond_healthy;
        out.standing.push_back(make_result(k, false));
        continue;
      }
      // A rarer cause has to do better than a commoner one on held-out data, beyond the interval; and one that leaves
      // the data as healthy ones are left need not be outdone.
      const auto suffices_alone = [&](const ExplainedFit& f) {
        return options.p_left && options.p_left(f, round + 1) > level;
      };
      const auto better = [&](int j, int than) {
        const ExplainedFit &a = fits[static_cast<std::size_t>(j)], &b = fits[static_cast<std::size_t>(than)];
        if (prior_of(a) < prior_of(b)) return !suffices_alone(b) && heldout_gain(b, a, options.seed).lower > 0;
        if (prior_of(a) > prior_of(b)) return suffices_alone(a) || heldout_gain(a, b, options.seed).lower <= 0;
        return delta_bic(now, a, out.degrees) > delta_bic(now, b, out.degrees);
      };
      if (best < 0 || better(i, best)) best = i;
    }
    if (best < 0) break;
    const std::size_t b = static_cast<std::size_t>(best);
    CauseResult taken = make_result(b, true);
    for (int i : judged) {
      const std::size_t k = static_cast<std::size_t>(i);
      if (i == best) continue;
      // As good in its place: within the interval of the difference, or at odds below twenty to one. Something is new,
      // so one whose size healthy data show as well may be what it is.
      constexpr double odds = 5.99;  // 2 ln 20
      if (heldout_gain(fits[k], fits[b], options.seed).lower <= 0 ||
          taken.delta_bic - delta_bic(now, fits[k], out.degrees) < odds)
        taken.confusable_with.push_back(fits[k].causes.back());
    }
    out.candidates[static_cast<std::size_t>(taken.cause)].fate = Fate::taken;
    steps.push_back(now);
    now = fits[b];
    if (retuned.ok) retuned = std::move(beside[b]);
    out.causes.push_back(std::move(taken));
  }
  // Leave each out again, the last one excepted: it has just shown its worth beside the others.
  for (std::size_t i = 0; out.causes.size() > 1 && i + 1 < out.causes.size() && !stopped();) {
    std::vector<int> without = now.causes;
    std::erase(without, out.causes[i].cause);
    ExplainedFit f = fit_causes(subject, without, &now, nullptr, full_iterations, false);
    if (f.ok) cross_validate(subject, f, options);
    const Interval worth = f.ok ? heldout_gain(f, now, options.seed) : Interval{1, 1, 1};
    if (worth.lower <= 0) {
      out.candidates[static_cast<std::size_t>(out.causes[i].cause)].fate = Fate::not_missed_later;
      out.causes.erase(out.causes.begin() + static_cast<long>(i));
      now = std::move(f);
    } else {
      out.causes[i].heldout_gain = worth;
      ++i;
    }
  }
  for (CauseResult& r : out.causes) size_up(subject, now, r);
  if (out.causes.size() == 1 && steps.size() > 1) {  // what came before it is out again
    out.causes.front().heldout_gain = heldout_gain(out.before, now, options.seed);
    out.causes.front().delta_bic = delta_bic(out.before, now, out.degrees);
  }
  out.after = std::move(now);
  if (!out.causes.empty() && subject.retunes() && subject.holds() && !stopped()) {
    if (!out.wide.ok) {
      out.wide = fit_causes(subject, {}, &out.before, nullptr, full_iterations, false, true);
      if (out.wide.ok) cross_validate(subject, out.wide, options);
    }
    if (out.wide.ok) {
      out.retuned = heldout_gain(out.before, out.wide, options.seed);
      for (CauseResult& r : out.causes) r.beyond_retuning = heldout_gain(out.wide, out.after, options.seed);
    }
  }
  tell(0.85);
  return out;
}

}  // namespace servodx
