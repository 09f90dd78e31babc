#include "fit/problem.h"

#include <algorithm>
#include <cmath>

namespace servodx {

double FreeValue::to_unit(double value) const {
  const double v = std::clamp(value, lower, upper);
  return log_scale ? std::log(v / lower) / std::log(upper / lower) : (v - lower) / (upper - lower);
}
double FreeValue::from_unit(double u) const {
  return log_scale ? lower * std::pow(upper / lower, u) : lower + u * (upper - lower);
}

FitProblem::FitProblem(std::vector<const LogData*> logs, ParameterVector base, std::vector<FreeValue> free,
                       SimulateOptions options)
    : logs_(std::move(logs)), base_(std::move(base)), free_(std::move(free)), options_(std::move(options)) {
  options_.wanted.fill(false);
  long at = 0;
  for (const LogData* log : logs_) {
    auto& offsets = offset_.emplace_back();
    auto& sigmas = sigma_.emplace_back();
    for (const FitChannel& c : log->channels) {
      options_.wanted[c.simulated] = true;
      offsets.push_back(at);
      sigmas.emplace_back(log->scenario.time.size(), std::max(c.noise, 1e-300));
      at += static_cast<long>(log->scenario.time.size());
    }
  }
  data_rows_ = at;
  for (const FreeValue& f : free_) at += std::isfinite(f.prior_sd);
  total_rows_ = at;
}

Point FitProblem::start() const {
  Point x;
  for (const FreeValue& f : free_) x.push_back(f.to_unit(f.start));
  return x;
}

ParameterVector FitProblem::candidate(const Point& x, int log) const {
  ParameterVector v = base_;
  for (std::size_t j = 0; j < free_.size(); ++j)
    if ((free_[j].log < 0 || free_[j].log == log) && !free_[j].apply) v[free_[j].at] = free_[j].from_unit(x[j]);
  for (std::size_t j = 0; j < free_.size(); ++j)
    if ((free_[j].log < 0 || free_[j].log == log) && free_[j].apply) free_[j].apply(v.data(), free_[j].from_unit(x[j]));
  return v;
}

void FitProblem::set_sigma(int log, int channel, double sigma) {
  std::fill(sigma_[log][channel].begin(), sigma_[log][channel].end(), sigma);
}
void FitProblem::set_sigma(int log, int channel, std::vector<double> sigma) { sigma_[log][channel] = std::move(sigma); }

std::vector<double> FitProblem::raw_residual(int log, int channel, const Trajectory& t) const {
  const FitChannel& c = logs_[log]->channels[channel];
  const std::vector<double>& simulated = t.signals[c.simulated];
  std::vector<double> r(c.measured.size());
  for (std::size_t k = 0; k < r.size(); ++k) r[k] = c.measured[k] - simulated[k];
  return c.filter(logs_[log]->scenario.time, r);
}

void FitProblem::fill(const Point&, int log, const Trajectory& t, Eigen::Ref<Eigen::VectorXd> out) const {
  for (std::size_t c = 0; c < logs_[log]->channels.size(); ++c) {
    const std::vector<double> r = raw_residual(log, static_cast<int>(c), t);
    const long at = offset_[log][c];
    const double* sigma = sigma_[log][c].data();
    double* to = out.data() + at;
    for (std::size_t k = 0; k < r.size(); ++k) {  // what is missing is NaN, and whitened so
      const double whitened = r[k] / sigma[k];
      to[k] = whitened == whitened ? whitened : 0.0;
    }
  }
}

std::vector<Trajectory> FitProblem::trajectories(const Point& x) const {
  std::vector<Trajectory> t(logs_.size());
  std::vector<ParameterVector> v(logs_.size());
  std::vector<Job> jobs;
  for (std::size_t l = 0; l < logs_.size(); ++l) {
    v[l] = candidate(x, static_cast<int>(l));
    jobs.push_back({&logs_[l]->scenario, &v[l], &t[l]});
  }
  simulate(jobs, options_);
  simulations_ += static_cast<long>(jobs.size());
  return t;
}

std::vector<Evaluation> FitProblem::evaluate(std::span<const Point> points, bool ranking) const {
  const std::size_t n_logs = logs_.size(), n_points = points.size();
  std::vector<ParameterVector> v(n_logs * n_points);
  std::vector<Trajectory> t(v.size());
  std::vector<Job> jobs;
  for (std::size_t l = 0; l < n_logs; ++l)
    for (std::size_t k = 0; k < n_points; ++k) {
      v[l * n_points + k] = candidate(points[k], static_cast<int>(l));
      jobs.push_back({&logs_[l]->scenario, &v[l * n_points + k], &t[l * n_points + k]});
    }
  SimulateOptions options = options_;
  options.ranking = ranking;
  simulate(jobs, options);
  simulations_ += static_cast<long>(jobs.size());
  std::vector<Evaluation> out(n_points);
  for (std::size_t k = 0; k < n_points; ++k) {
    for (std::size_t l = 0; l < n_logs; ++l) out[k].ok = out[k].ok && t[l * n_points + k].ok;
    if (!out[k].ok) {
      ++failed_;
      continue;
    }
    out[k].residual.setZero(total_rows_);
    for (std::size_t l = 0; l < n_logs; ++l) fill(points[k], static_cast<int>(l), t[l * n_points + k], out[k].residual);
    long at = data_rows_;
    for (std::size_t j = 0; j < free_.size(); ++j)
      if (std::isfinite(free_[j].prior_sd))
        out[k].residual[at++] = (points[k][j] - free_[j].to_unit(free_[j].start)) / free_[j].prior_sd;
  }
  return out;
}

bool FitProblem::jacobian(const Point& x, const Eigen::VectorXd& residual, Eigen::MatrixXd& jac) const {
  const double step = difference_step;
  struct Column {
    int j, log;
    double dx;
  };
  std::vector<Column> columns;
  for (std::size_t l = 0; l < logs_.size(); ++l)
    for (std::size_t j = 0; j < free_.size(); ++j)
      if (free_[j].log < 0 || free_[j].log == static_cast<int>(l))
        columns.push_back({static_cast<int>(j), static_cast<int>(l), x[j] + step <= 1.0 ? step : -step});
  jac.setZero(total_rows_, n());
  // A log at a time keeps the trajectories of one log's columns in memory, not of all.
  std::vector<char> failed(columns.size(), 0);
  std::size_t first = 0;
  Eigen::VectorXd scratch(total_rows_);
  while (first < columns.size()) {
    std::size_t last = first;
    while (last < columns.size() && (columns[last].log == columns[first].log || last - first < 64)) ++last;
    std::vector<ParameterVector> v(last - first);
    std::vector<Trajectory> t(last - first);
    std::vector<Job> jobs;
    for (std::size_t c = first; c < last; ++c) {
      Point moved = x;
      moved[columns[c].j] += columns[c].dx;
      v[c - first] = candidate(moved, columns[c].log);
      jobs.push_back({&logs_[columns[c].log]->scenario, &v[c - first], &t[c - first]});
    }
    simulate(jobs, options_);
    simulations_ += static_cast<long>(jobs.size());
    for (std::size_t c = first; c < last; ++c) {
      if (!t[c - first].ok) {
        ++failed_;
        return false;
      }
      const int l = columns[c].log;
      const long at = offset_[l].front();
      const long rows = static_cast<long>(logs_[l]->channels.size() * logs_[l]->scenario.time.size());
      fill(x, l, t[c - first], scratch);
      jac.col(columns[c].j).segment(at, rows) =
          (scratch.segment(at, rows) - residual.segment(at, rows)) / columns[c].dx;
    }
    first = last;
  }
  long at = data_rows_;
  for (std::size_t j = 0; j < free_.size(); ++j)
    if (std::isfinite(free_[j].prior_sd)) jac(at++, static_cast<long>(j)) = 1.0 / free_[j].prior_sd;
  return true;
}

LeastSquaresProblem FitProblem::least_squares() const {
  LeastSquaresProblem p;
  p.n = n();
  p.evaluate = [this](std::span<const Point> points) { return evaluate(points); };
  p.jacobian = [this](const Point& x, const Eigen::VectorXd& r, Eigen::MatrixXd& j) { return jacobian(x, r, j); };
  return p;
}

}  // namespace servodx
