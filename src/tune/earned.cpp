#include "tune/earned.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "effects/effect.h"
#include "effects/registry.h"
#include "fit/chart.h"
#include "fit/fit_work.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "optimise/normal_equations.h"
#include "optimise/robust_loss.h"
#include "parameters/coordinate.h"
#include "parameters/list.h"
#include "tune/constants.h"
#include "tune/kept.h"

namespace servodx {
namespace {

using tune_constants::least_gain;

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

// A misfit to second order about a point: the part that the fit has seen, and the priors.
struct Valley {
  Point at;
  Eigen::MatrixXd jacobian;  // rows that the fit has not seen are zero
  RowBlocks blocks;
  NormalEquations floor;

  // Its floor once `gone` are off, inside the walls. What is gone already stands at its off value.
  Point floor_without(const std::vector<const FreedEffect*>& gone) const {
    const long n = floor.gradient.size();
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
    std::vector<char> fixed(static_cast<std::size_t>(n), 0);
    for (long j = 0; j < n; ++j) fixed[static_cast<std::size_t>(j)] = !off_walls(at[static_cast<std::size_t>(j)]);
    for (const FreedEffect* f : gone)
      for (std::size_t k = 0; k < f->at.size(); ++k) {
        fixed[static_cast<std::size_t>(f->at[k])] = 1;
        if (!std::isnan(f->off[k])) step[f->at[k]] = f->off[k] - at[static_cast<std::size_t>(f->at[k])];
      }
    std::vector<long> left;
    for (long j = 0; j < n; ++j)
      if (!fixed[static_cast<std::size_t>(j)]) left.push_back(j);
    const Eigen::VectorXd pull = -(floor.gradient + floor.matrix * step);
    const Eigen::VectorXd moved = Eigen::MatrixXd(floor.matrix(left, left)).ldlt().solve(Eigen::VectorXd(pull(left)));
    for (std::size_t k = 0; k < left.size(); ++k) step[left[k]] = moved[static_cast<long>(k)];
    Point out = at;
    for (std::size_t j = 0; j < out.size(); ++j) out[j] = std::clamp(out[j] + step[static_cast<long>(j)], 0.0, 1.0);
    return out;
  }
};

// The misfit in two parts: what the fit has seen of each log, and what it has not.
class Parts {
 public:
  Parts(const FitProblem& problem, double held)
      : problem_(problem), seen_(Eigen::VectorXd::Ones(problem.total_rows())) {
    for (std::size_t l = 0; l < problem.logs().size(); ++l)
      for (std::size_t c = 0; c < problem.logs()[l]->channels.size(); ++c) {
        const auto [first, n] = problem.rows(static_cast<int>(l), static_cast<int>(c));
        const auto from = static_cast<long>(seen_samples(static_cast<std::size_t>(n), held));
        seen_.segment(first + from, n - from).setZero();
      }
  }
  // [half a sum of squares] infinite where a run fails.
  double held_cost(const Evaluation& e) const {
    if (!e.ok) return std::numeric_limits<double>::infinity();
    return 0.5 * ((1.0 - seen_.array()) * e.residual.array().square()).sum();
  }
  double seen_cost(const Evaluation& e) const {
    return e.ok ? 0.5 * e.residual.squaredNorm() - held_cost(e) : std::numeric_limits<double>::infinity();
  }
  // Nothing where there are no derivatives.
  std::optional<Valley> valley(const Point& x, const Evaluation& at) const {
    Eigen::MatrixXd j;
    if (!at.ok || !problem_.jacobian(x, at.residual, j)) return std::nullopt;
    j.array().colwise() *= seen_.array();
    RowBlocks blocks = row_blocks(j);
    return valley(x, at, std::move(j), std::move(blocks));
  }
  // About a point nearby, by what the way there has taught: a Jacobian of its own costs a hundred runs of every log.
  std::optional<Valley> next(const Valley& from, const Evaluation& at_from, const Point& x,
                             const Evaluation& at) const {
    if (!at.ok) return std::nullopt;
    const auto n = static_cast<long>(x.size());
    const Eigen::VectorXd step =
        Eigen::Map<const Eigen::VectorXd>(x.data(), n) - Eigen::Map<const Eigen::VectorXd>(from.at.data(), n);
    Eigen::MatrixXd j = from.jacobian;
    learn_step(j, from.blocks, step,
               seen_.cwiseProduct(at.residual - at_from.residual) - product(j, from.blocks, step));
    return valley(x, at, std::move(j), from.blocks);
  }

 private:
  Valley valley(const Point& x, const Evaluation& at, Eigen::MatrixXd j, RowBlocks blocks) const {
    NormalEquations floor = normal_equations(j, blocks, at.residual, RobustLoss::none, 1);
    return {x, std::move(j), std::move(blocks), std::move(floor)};
  }
  const FitProblem& problem_;
  Eigen::VectorXd seen_;  // 1 for a row of data that the fit has seen, and for a prior's
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

// Backward from all that are free: the one that is missed least goes, until each of the rest is missed.
class Elimination {
 public:
  Elimination(const FitProblem& problem, double held, const std::vector<FreedEffect>& effects, const Point& end)
      : problem_(problem), parts_(problem, held), here_(taken(end)) {
    for (const FreedEffect& f : effects) asked_.push_back(&f);
  }

  std::vector<EarnedEffect> run(TuneWatch& watch) {
    std::vector<EarnedEffect> kept;
    valley_ = parts_.valley(here_.point, here_.run);
    const auto all = static_cast<double>(asked_.size());
    while (!asked_.empty() && valley_ && !watch.stopped()) {
      watch.tell(tune_constants::work.effects.at(1 - static_cast<double>(asked_.size()) / all), problem_);
      auto [k, without] = least_missed();
      if (missed(without) >= least_gain) without = nearer_floor(std::move(without), *asked_[k]);
      const double gain = missed(without);
      const FreedEffect* effect = asked_[k];
      asked_.erase(asked_.begin() + static_cast<long>(k));
      if (gain >= least_gain) {
        kept.push_back({effect->name, gain, true});
        continue;
      }
      out_.push_back({effect->name, gain, false});
      gone_.push_back(effect);
      move(std::move(without));
    }
    out_.insert(out_.end(), kept.begin(), kept.end());
    return out_;
  }
  const Point& point() const { return here_.point; }

 private:
  struct Place {
    Point point;
    Evaluation run;
  };
  Place taken(Point x) const {
    Evaluation e = problem_.evaluate(std::span(&x, 1)).front();
    return {std::move(x), std::move(e)};
  }
  double missed(const Place& without) const { return parts_.held_cost(without.run) - parts_.held_cost(here_.run); }
  std::vector<const FreedEffect*> gone_with(const FreedEffect& f) const {
    std::vector<const FreedEffect*> all = gone_;
    all.push_back(&f);
    return all;
  }
  void move(Place to) {
    valley_ = parts_.next(*valley_, here_.run, to.point, to.run);
    here_ = std::move(to);
  }

  // The free ones, then with each of those asked off.
  std::vector<Point> floors() const {
    std::vector<Point> points = {valley_->floor_without(gone_)};
    for (const FreedEffect* f : asked_) points.push_back(valley_->floor_without(gone_with(*f)));
    return points;
  }
  // The free ones take the same step first, so that what is missed is the effect and not the step. A step that leads up
  // nobody takes.
  std::pair<std::size_t, Place> least_missed() {
    std::vector<Point> points = floors();
    std::vector<Evaluation> runs = problem_.evaluate(points);
    if (parts_.seen_cost(runs[0]) < parts_.seen_cost(here_.run)) {
      move({points[0], runs[0]});
    } else {
      valley_->floor.gradient.setZero();
      points = floors();
      runs = problem_.evaluate(points);
    }
    std::size_t least = 1;
    for (std::size_t k = 2; k < runs.size(); ++k)
      if (parts_.held_cost(runs[k]) < parts_.held_cost(runs[least])) least = k;
    return {least - 1, {std::move(points[least]), std::move(runs[least])}};
  }
  // A second step from there, where the seen part takes it.
  Place nearer_floor(Place without, const FreedEffect& f) const {
    const std::optional<Valley> valley = parts_.next(*valley_, here_.run, without.point, without.run);
    if (!valley) return without;
    Place next = taken(valley->floor_without(gone_with(f)));
    return parts_.seen_cost(next.run) < parts_.seen_cost(without.run) ? std::move(next) : without;
  }

  const FitProblem& problem_;
  Parts parts_;
  Place here_;
  std::optional<Valley> valley_;  // about here
  std::vector<const FreedEffect*> asked_, gone_;
  std::vector<EarnedEffect> out_;
};

struct Trials {
  std::vector<EarnedEffect> effects;  // in the order of trial
  Point point;
  FitWork work;
};
auto fields(Trials& t) {
  auto& [effects, point, work] = t;
  return std::tie(effects, point, work);
}

}  // namespace

std::vector<EarnedEffect> keep_earned(TuneScope& scope, const FitProblem& problem, double held, Point& end,
                                      TuneWatch& watch) {
  const std::vector<FreeValue> free = problem.free();
  const std::vector<FreedEffect> effects = freed_effects(free);
  if (effects.empty() || held <= 0 || watch.stopped()) return {};
  const auto trials = [&] {
    Elimination elimination(problem, held, effects, end);
    std::vector<EarnedEffect> tried = elimination.run(watch);
    return Trials{std::move(tried), elimination.point(), problem.work()};
  };
  const std::string weights = watch.kept.keeps() ? problem.content_hash() : "";
  Trials out = watch.kept.made("effects", trials, weights, end, held, watch.work_so_far(problem));
  problem.work() = out.work;
  std::vector<char> taken(free.size(), 0);
  for (const EarnedEffect& tried : out.effects)
    for (const FreedEffect& f : effects) {
      if (tried.kept || tried.effect != f.name) continue;
      take_out(scope, f, free);
      for (const long j : f.at) taken[static_cast<std::size_t>(j)] = 1;
    }
  end.clear();
  for (std::size_t j = 0; j < free.size(); ++j)
    if (!taken[j]) end.push_back(out.point[j]);
  return std::move(out.effects);
}

}  // namespace servodx
