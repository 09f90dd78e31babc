#include "tune/earned.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "effects/effect.h"
#include "effects/registry.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "parameters/coordinate.h"
#include "parameters/list.h"

namespace servodx {
namespace {

// Fall of the held-out cost, half a sum of squares, that keeps an effect: by chance alone a number gains a half, and
// an effect has one to six. Not examined.
constexpr double least_gain = 1.0;

// A freed effect: its numbers' places among the free ones, and the unit values at which it is off.
struct FreedEffect {
  std::string name;
  std::vector<long> at;     // all of its numbers
  std::vector<double> off;  // NaN: only shapes what another switches
};

std::vector<FreedEffect> freed_effects(const std::vector<FreeValue>& free) {
  std::vector<FreedEffect> out;
  for (const EffectInfo& e : effect_list()) {
    FreedEffect f{e.name, {}, {}};
    for (std::size_t j = 0; j < free.size(); ++j) {
      const int k = free[j].at - e.first;
      if (free[j].log >= 0 || free[j].at < n_parameters || k < 0 || k >= static_cast<int>(e.parameters.size()))
        continue;
      const std::optional<double> off = off_value(free[j].at);
      f.at.push_back(static_cast<long>(j));
      f.off.push_back(off ? free[j].to_unit(*off) : std::nan(""));
    }
    if (!f.at.empty()) out.push_back(std::move(f));
  }
  return out;
}

// The misfit in two parts, and how the seen one pulls.
class Parts {
 public:
  Parts(const FitProblem& problem, double held) : problem_(problem), seen_(Eigen::VectorXd::Ones(rows())) {
    for (std::size_t l = 0; l < problem.logs().size(); ++l)
      for (std::size_t c = 0; c < problem.logs()[l]->channels.size(); ++c) {
        const auto [first, n] = problem.rows(static_cast<int>(l), static_cast<int>(c));
        const auto from = static_cast<long>((1.0 - held) * static_cast<double>(n));
        seen_.segment(first + from, n - from).setZero();
      }
  }
  // False where there are no derivatives.
  bool linearise(const Point& x) {
    const Evaluation e = problem_.evaluate(std::span(&x, 1)).front();
    Eigen::MatrixXd j;
    if (!e.ok || !problem_.jacobian(x, e.residual, j)) return false;
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(e.residual.size());
    weight.head(rows()) = seen_;
    curvature_ = j.transpose() * weight.asDiagonal() * j;
    return true;
  }
  double held_cost(const Evaluation& e) const {
    if (!e.ok) return std::numeric_limits<double>::infinity();
    return 0.5 * ((1.0 - seen_.array()) * e.residual.head(rows()).array().square()).sum();
  }
  // The others where the seen part is least once some numbers are moved, inside their walls.
  Point without(const Point& x, const std::vector<const FreedEffect*>& gone) const {
    const long n = curvature_.rows();
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
    std::vector<char> fixed(static_cast<std::size_t>(n), 0);
    for (long j = 0; j < n; ++j) fixed[static_cast<std::size_t>(j)] = !off_walls(x[static_cast<std::size_t>(j)]);
    for (const FreedEffect* f : gone)
      for (std::size_t k = 0; k < f->at.size(); ++k) {
        fixed[static_cast<std::size_t>(f->at[k])] = 1;
        if (!std::isnan(f->off[k])) step[f->at[k]] = f->off[k] - x[static_cast<std::size_t>(f->at[k])];
      }
    std::vector<long> left;
    for (long j = 0; j < n; ++j)
      if (!fixed[static_cast<std::size_t>(j)]) left.push_back(j);
    const Eigen::VectorXd pull = -(curvature_ * step);
    const Eigen::VectorXd moved = Eigen::MatrixXd(curvature_(left, left)).ldlt().solve(Eigen::VectorXd(pull(left)));
    for (std::size_t k = 0; k < left.size(); ++k) step[left[k]] = moved[static_cast<long>(k)];
    Point out = x;
    for (std::size_t j = 0; j < out.size(); ++j) out[j] = std::clamp(out[j] + step[static_cast<long>(j)], 0.0, 1.0);
    return out;
  }

 private:
  long rows() const { return problem_.data_rows(); }
  const FitProblem& problem_;
  Eigen::VectorXd seen_;  // 1 for a row of data that the fit has seen
  Eigen::MatrixXd curvature_;
};

void take_out(TuneScope& scope, const FreedEffect& effect, const std::vector<FreeValue>& free) {
  for (std::size_t k = 0; k < effect.at.size(); ++k) {
    const FreeValue& f = free[static_cast<std::size_t>(effect.at[k])];
    if (const std::optional<double> off = off_value(f.at)) {
      scope.table.rows[static_cast<std::size_t>(scope.table.find(f.name))].nominal = *off;
      scope.base[static_cast<std::size_t>(f.at)] = *off;
    }
    std::erase_if(scope.shared, [&](const FreeValue& v) { return v.name == f.name; });
  }
}

}  // namespace

std::vector<EarnedEffect> keep_earned(TuneScope& scope, const FitProblem& problem, double held, Point& end,
                                      TuneWatch& watch) {
  std::vector<EarnedEffect> out;
  const std::vector<FreeValue> free = problem.free();
  const std::vector<FreedEffect> effects = freed_effects(free);
  Parts parts(problem, held);
  if (effects.empty() || held <= 0 || watch.stopped() || !parts.linearise(end)) return out;
  std::vector<const FreedEffect*> gone, left;
  for (const FreedEffect& f : effects) left.push_back(&f);
  Point x = end;
  double cost = parts.held_cost(problem.evaluate(std::span(&x, 1)).front());
  std::vector<double> gains;
  while (!left.empty() && !watch.stopped()) {
    std::vector<Point> points;
    for (const FreedEffect* f : left) {
      std::vector<const FreedEffect*> all = gone;
      all.push_back(f);
      points.push_back(parts.without(end, all));
    }
    gains.clear();
    for (const Evaluation& e : problem.evaluate(points)) gains.push_back(parts.held_cost(e) - cost);
    const auto least = std::min_element(gains.begin(), gains.end());
    if (!(*least < least_gain)) break;
    const auto k = static_cast<std::size_t>(least - gains.begin());
    out.push_back({left[k]->name, *least, false});
    x = points[k];
    cost += *least;
    gone.push_back(left[k]);
    left.erase(left.begin() + static_cast<long>(k));
    gains.erase(least);
  }
  for (std::size_t k = 0; k < left.size() && k < gains.size(); ++k) out.push_back({left[k]->name, gains[k], true});
  for (const FreedEffect* f : gone) take_out(scope, *f, free);
  end.clear();
  for (std::size_t j = 0; j < free.size(); ++j) {
    const bool taken = std::any_of(gone.begin(), gone.end(), [&](const FreedEffect* f) {
      return std::find(f->at.begin(), f->at.end(), static_cast<long>(j)) != f->at.end();
    });
    if (!taken) end.push_back(x[j]);
  }
  return out;
}

}  // namespace servodx
