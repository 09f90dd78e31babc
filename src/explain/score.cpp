#include "explain/score.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "explain/constants.h"
#include "explain/deviance.h"
#include "explain/kept.h"
#include "optimise/unit_cube.h"
#include "parameters/coordinate.h"

namespace servodx {
namespace {

using explain_constants::least_square;

// What the free numbers of a fit, priors included, cannot imitate of a change.
struct Imitation {
  Eigen::HouseholderQR<Eigen::MatrixXd> qr;
  long columns = 0;
  Eigen::VectorXd apart(const Eigen::VectorXd& v) const {
    Eigen::VectorXd y = qr.householderQ().transpose() * v;
    y.head(std::min<long>(columns, y.size())).setZero();
    return qr.householderQ() * y;
  }
};
// `but`: the free number of this name has no say; empty: all have.
Imitation imitation_of(const ExplainedFit& at, const std::string& but) {
  Eigen::MatrixXd imitated(at.jacobian.rows(), 0);
  for (long j = 0; j < at.jacobian.cols(); ++j) {
    const double u = at.point[static_cast<std::size_t>(j)];
    if (!off_walls(u)) continue;  // a wall holds it
    if (!but.empty() && at.fit.numbers[static_cast<std::size_t>(j)].name == but) continue;
    imitated.conservativeResize(Eigen::NoChange, imitated.cols() + 1);
    imitated.col(imitated.cols() - 1) = at.jacobian.col(j);
  }
  const long columns = imitated.cols();
  return Imitation{Eigen::HouseholderQR<Eigen::MatrixXd>(imitated), columns};
}

// Where the fit stands, then every probe of every cause that is looked at.
std::vector<Point> probe_points(const Subject& subject, const SubjectFit& whole, const Point& at,
                                const std::vector<char>& looked_at) {
  std::vector<Point> points = {at};
  std::size_t first = whole.numbers.size();
  for (const Cause& c : subject.causes()) first -= c.numbers.size();
  for (std::size_t k = 0; k < subject.causes().size(); ++k) {
    const Cause& c = subject.causes()[k];
    for (const auto& alternative : c.probes)
      for (const auto& probe : alternative) {
        if (!looked_at[k]) continue;
        Point p = at;
        for (std::size_t j = 0; j < c.numbers.size(); ++j) p[first + j] = c.numbers[j].to_unit(probe[j]);
        points.push_back(std::move(p));
      }
    first += c.numbers.size();
  }
  return points;
}

// A cause that begins at a wall cannot be less than absent.
bool begins_at_wall(const Cause& cause, const std::vector<double>& probe) {
  for (std::size_t j = 0; j < cause.numbers.size(); ++j) {
    const Number& n = cause.numbers[j];
    if (n.size && probe[j] != n.off && (probe[j] > n.off ? n.off > n.lower : n.off < n.upper)) return false;
  }
  return true;
}

// Mean of the base's numbers that a cause is atop of; 1 where the fit has none.
double mean_under(const Subject& subject, const ExplainedFit& at, const std::string& atop) {
  double n = 0, sum = 0;
  for (std::size_t j = 0; j < base_size(subject, at); ++j)
    if (const Number& number = at.fit.numbers[j]; number.name == atop) sum += number.from_unit(at.point[j]), ++n;
  return n > 0 ? sum / n : 1;
}

// Scores the alternatives of one cause at a fit.
class CauseScorer {
 public:
  CauseScorer(const Subject& subject, const ExplainedFit& at, const Cause& cause, const Imitation& imitation)
      : subject_(subject),
        fit_(at),
        cause_(cause),
        imitation_(imitation),
        rows_(data_rows(subject)),
        deviance_(deviance_of(subject, at.residual)) {}

  // `runs`: an evaluation a probe; `off`: where the fit stands.
  void alternative(std::size_t a, const Evaluation* runs, const Evaluation& off, CauseScore& s) const {
    Eigen::MatrixXd directions(fit_.residual.size(), 0);
    for (std::size_t k = 0; k < cause_.probes[a].size(); ++k) {
      ProbeScore p;
      p.std_error = std::nan("");
      if (runs[k].ok && off.ok) probe(cause_.probes[a][k], runs[k], off, p, s, directions);
      s.probes.push_back(p);
    }
    together(directions, a, s);
  }

 private:
  void probe(const std::vector<double>& at, const Evaluation& run, const Evaluation& off, ProbeScore& p, CauseScore& s,
             Eigen::MatrixXd& directions) const {
    const Eigen::VectorXd& r0 = fit_.residual;
    Eigen::VectorXd v = Eigen::VectorXd::Zero(r0.size());
    v.head(rows_) = run.residual.head(rows_) - off.residual.head(rows_);
    v = imitation_.apart(v);
    const double square = v.squaredNorm();
    if (!(square > least_square)) return;
    p.size = -v.dot(r0) / square;
    p.std_error = 1.0 / std::sqrt(square);
    if (begins_at_wall(cause_, at) && p.size < 0) return;
    // As it is at the probe: a large effect is no straight line.
    s.gain = std::max(s.gain, deviance_ - deviance_of(subject_, r0 + v));
    directions.conservativeResize(Eigen::NoChange, directions.cols() + 1);
    directions.col(directions.cols() - 1) = v;
  }
  // The probes of an alternative, each at its best size, weighed as what they leave is.
  void together(const Eigen::MatrixXd& directions, std::size_t a, CauseScore& s) const {
    const Eigen::VectorXd& r0 = fit_.residual;
    Eigen::VectorXd r = r0;
    for (int pass = 0; pass < 2 && directions.cols() > 0; ++pass) {
      const Eigen::VectorXd w = weights_at(subject_, r);
      r = r0 - directions * (w.asDiagonal() * directions).colPivHouseholderQr().solve(w.cwiseProduct(r0));
      if (const double gain = deviance_ - deviance_of(subject_, r); gain > s.gain)
        s.gain = gain, s.alternative = static_cast<int>(a);
    }
  }
  const Subject& subject_;
  const ExplainedFit& fit_;
  const Cause& cause_;
  const Imitation& imitation_;
  long rows_;
  double deviance_;  // of the fit
};

// `all`: the causes, `whole`: the fit with them.
std::vector<CauseScore> scored(const Subject& subject, const ExplainedFit& at, const std::vector<int>& all,
                               const SubjectFit& whole, const std::vector<char>& looked_at) {
  const std::vector<Cause>& causes = subject.causes();
  const std::vector<Evaluation> e =
      whole.problem.evaluate(probe_points(subject, whole, carried(subject, at, whole, all), looked_at));
  const Imitation of_all = imitation_of(at, "");
  std::vector<CauseScore> out;
  std::size_t k = 1;
  for (std::size_t c = 0; c < causes.size(); ++c) {
    const Cause& cause = causes[c];
    CauseScore& s = out.emplace_back();
    s.cause = static_cast<int>(c);
    if (!looked_at[c]) continue;
    const bool atop = !cause.atop.empty();
    if (atop) s.of = mean_under(subject, at, cause.atop);
    const Imitation of_rest = atop ? imitation_of(at, cause.atop) : Imitation{};
    const CauseScorer scorer(subject, at, cause, atop ? of_rest : of_all);
    for (std::size_t a = 0; a < cause.probes.size(); ++a) {
      scorer.alternative(a, &e[k], e[0], s);
      k += cause.probes[a].size();
    }
  }
  return out;
}

}  // namespace

std::vector<CauseScore> score_causes(const Subject& subject, const ExplainedFit& at,
                                     const std::function<bool(const Cause&)>& among) {
  std::vector<char> looked_at;
  for (const Cause& c : subject.causes()) looked_at.push_back(!among || among(c));
  std::vector<int> all(subject.causes().size());
  std::iota(all.begin(), all.end(), 0);
  const SubjectFit whole = subject.fit(all, at.wide);
  const auto make = [&] { return scored(subject, at, all, whole, looked_at); };
  if (!subject.stages.keeps()) return make();
  std::vector<std::vector<double>> weights;
  for (const Series& s : subject.series()) weights.push_back(*s.sigma);
  std::vector<std::vector<std::vector<std::vector<double>>>> probes;
  for (const Cause& c : subject.causes()) probes.push_back(c.probes);
  return counted(*whole.work, subject.stages, "score", make, at.causes, at.wide, at.point, at.deviance, looked_at, weights,
                 probes);
}

}  // namespace servodx
