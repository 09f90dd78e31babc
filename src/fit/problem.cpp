#include "fit/problem.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/bytes.h"
#include "base/sha256.h"
#include "base/tiny.h"
#include "signals/filters.h"
#include "simulate/company.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

// What a thread's runs are made in, kept from call to call: a search asks for the same megabytes in every generation.
struct Workspace {
  std::vector<ParameterVector> candidates;
  std::vector<Trajectory> runs;
  std::vector<Job> jobs;
  std::vector<std::size_t> which;  // of the points

  void hold(std::size_t n) {
    if (runs.size() < n) candidates.resize(n), runs.resize(n);
    jobs.clear();
  }
};
Workspace& workspace() {
  thread_local Workspace w;
  return w;
}
std::vector<double>& residual_space() {
  thread_local std::vector<double> r;
  return r;
}

}  // namespace

FitProblem::FitProblem(std::vector<const LogData*> logs, ParameterVector base, std::vector<FreeValue> free,
                       SimulateOptions options)
    : logs_(std::move(logs)), chart_(std::move(base), std::move(free)), options_(std::move(options)) {
  options_.wanted.fill(false);
  long at = 0;
  for (const LogData* log : logs_) {
    auto& offsets = offset_.emplace_back();
    auto& sigmas = sigma_.emplace_back();
    auto& drifts = drift_.emplace_back();
    for (const FitChannel& c : log->channels) {
      options_.wanted[c.simulated] = true;
      offsets.push_back(at);
      sigmas.emplace_back(log->scenario.time.size(), std::max(c.noise, tiny));
      drifts.emplace_back();
      if (c.filter.drift > 0.0) drifts.back().emplace(log->scenario.time, c.measured, c.filter.drift);
      at += static_cast<long>(log->scenario.time.size());
    }
  }
  data_rows_ = at;
  for (const FreeValue& f : chart_.free()) at += std::isfinite(f.prior_sd);
  total_rows_ = at;
}

std::string FitProblem::content_hash() const {
  std::string bytes;
  write_bytes(bytes, chart_.candidate(start(), 0));
  for (const FreeValue& f : free()) {
    write_bytes(bytes, f.name);
    for (const double x : {f.lower, f.upper, f.start, f.prior_sd}) write_bytes(bytes, x);
    write_bytes(bytes, f.log_scale), write_bytes(bytes, f.at), write_bytes(bytes, f.log);
  }
  write_bytes(bytes, sigma_);
  write_bytes(bytes, difference_step);
  return sha256(bytes);
}

void FitProblem::set_sigma(int log, int channel, double sigma) {
  std::fill(sigma_[log][channel].begin(), sigma_[log][channel].end(), sigma);
}
void FitProblem::set_sigma(int log, int channel, std::vector<double> sigma) { sigma_[log][channel] = std::move(sigma); }

void FitProblem::residual(int log, int channel, const Trajectory& t, std::vector<double>& r) const {
  const FitChannel& c = logs_[log]->channels[channel];
  r.assign(t.signals[c.simulated].begin(), t.signals[c.simulated].end());
  c.show(r);
  for (std::size_t k = 0; k < r.size(); ++k) r[k] = c.measured[k] - r[k];
  Filter before = c.filter;
  before.drift = 0.0;
  if (before.window != 1 || before.mains > 0.0) r = before(logs_[log]->scenario.time, r);
  if (const auto& drift = drift_[log][channel]) (*drift)(r);
}

void FitProblem::whitened(int log, int channel, const Trajectory& t, std::vector<double>& r) const {
  residual(log, channel, t, r);
  const double* sigma = sigma_[log][channel].data();
  for (std::size_t k = 0; k < r.size(); ++k) {  // what is missing is NaN, and whitened so
    const double whitened = r[k] / sigma[k];
    r[k] = whitened == whitened ? whitened : 0.0;
  }
}

std::vector<double> FitProblem::raw_residual(int log, int channel, const Trajectory& t) const {
  std::vector<double> r;
  residual(log, channel, t, r);
  return r;
}

void FitProblem::fill(int log, const Trajectory& t, Eigen::Ref<Eigen::VectorXd> out) const {
  std::vector<double>& r = residual_space();
  for (std::size_t c = 0; c < logs_[log]->channels.size(); ++c) {
    whitened(log, static_cast<int>(c), t, r);
    std::copy(r.begin(), r.end(), out.data() + offset_[log][c]);
  }
}

double FitProblem::prior_residual(std::size_t j, double x) const {
  return (x - free()[j].to_unit(free()[j].start)) / free()[j].prior_sd;
}

std::vector<int> FitProblem::logs_of_rows() const {
  std::vector<int> out;
  for (std::size_t l = 0; l < logs_.size(); ++l)
    out.insert(out.end(), logs_[l]->channels.size() * logs_[l]->scenario.time.size(), static_cast<int>(l));
  for (const FreeValue& f : free())
    if (std::isfinite(f.prior_sd)) out.push_back(f.log);
  return out;
}

int FitProblem::threads() const {
  if (company()) return 1;  // the others have the rest
  return options_.threads > 0 ? options_.threads : omp_get_max_threads();
}

std::vector<Trajectory> FitProblem::trajectories(const Point& x) const {
  std::vector<Trajectory> t(logs_.size());
  std::vector<ParameterVector> v(logs_.size());
  std::vector<Job> jobs;
  for (std::size_t l = 0; l < logs_.size(); ++l) {
    v[l] = chart_.candidate(x, static_cast<int>(l));
    jobs.push_back({&logs_[l]->scenario, &v[l], &t[l]});
  }
  simulate(jobs, options_);
  work_.simulations += static_cast<long>(jobs.size());
  return t;
}

// Logs [first, last) at some of the points, a log's points side by side; valid until this thread's next runs.
std::span<const Trajectory> FitProblem::run(std::span<const Point> points, std::span<const std::size_t> which,
                                            std::size_t first, std::size_t last, bool ranking) const {
  const std::size_t n = (last - first) * which.size();
  Workspace& w = workspace();
  w.hold(n);
  for (std::size_t l = first; l < last; ++l)
    for (const std::size_t k : which) {
      const std::size_t i = w.jobs.size();
      chart_.candidate(points[k], static_cast<int>(l), w.candidates[i]);
      w.jobs.push_back({&logs_[l]->scenario, &w.candidates[i], &w.runs[i]});
    }
  simulate(w.jobs, ranking ? ranking_steps(options_) : options_);
  work_.simulations += static_cast<long>(n);
  return {w.runs.data(), n};
}

std::vector<Evaluation> FitProblem::evaluate(std::span<const Point> points) const {
  const auto n_points = static_cast<long>(points.size());
  std::vector<std::size_t>& which = workspace().which;
  which.resize(points.size());
  std::iota(which.begin(), which.end(), 0);
  const auto runs = run(points, which, 0, logs_.size(), false);
  std::vector<Evaluation> out(points.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads())
  for (long i = 0; i < n_points; ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (std::size_t l = 0; l < logs_.size(); ++l) out[k].ok = out[k].ok && runs[l * points.size() + k].ok;
    if (!out[k].ok) continue;
    out[k].residual.setZero(total_rows_);
    for (std::size_t l = 0; l < logs_.size(); ++l)
      fill(static_cast<int>(l), runs[l * points.size() + k], out[k].residual);
    long at = data_rows_;
    for (std::size_t j = 0; j < free().size(); ++j)
      if (std::isfinite(free()[j].prior_sd)) out[k].residual[at++] = prior_residual(j, points[k][j]);
  }
  for (const Evaluation& e : out) work_.failed += !e.ok;
  return out;
}

std::vector<double> FitProblem::costs(std::span<const Point> points, RobustLoss loss, double scale, bool ranking,
                                      std::span<const double> bounds) const {
  constexpr double failed = std::numeric_limits<double>::infinity();
  // With bounds, logs by so many runs at a time, the same on every machine: a pack of floats for each of eight threads.
  constexpr std::size_t runs_at_once = 128;
  std::vector<double> out(points.size(), 0.0);  // until the end twice the cost
  std::vector<std::size_t>& left = workspace().which;
  left.resize(points.size());
  std::iota(left.begin(), left.end(), 0);
  for (std::size_t first = 0, last; first < logs_.size() && !left.empty(); first = last) {
    last = logs_.size();
    if (!bounds.empty()) last = std::min(last, first + (runs_at_once + left.size() - 1) / left.size());
    const auto runs = run(points, left, first, last, ranking);
    const auto n_left = static_cast<long>(left.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads())
    for (long i = 0; i < n_left; ++i) {
      const std::size_t k = left[static_cast<std::size_t>(i)];
      double sum = out[k];
      std::vector<double>& r = residual_space();
      for (std::size_t l = first; l < last; ++l) {
        const Trajectory& t = runs[(l - first) * left.size() + static_cast<std::size_t>(i)];
        if (!t.ok) {
          sum = failed;
          break;
        }
        for (std::size_t c = 0; c < logs_[l]->channels.size(); ++c) {
          whitened(static_cast<int>(l), static_cast<int>(c), t, r);
          for (const double e : r) sum += robust_square(loss, scale, e);
        }
      }
      out[k] = sum;
    }
    // Squares only add up, so what is above its bound stays there.
    std::erase_if(left, [&](std::size_t k) {
      work_.failed += out[k] == failed;
      return out[k] == failed || (!bounds.empty() && 0.5 * out[k] > bounds[k]);
    });
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (std::size_t j = 0; j < free().size(); ++j)
      if (std::isfinite(free()[j].prior_sd)) out[k] += robust_square(loss, scale, prior_residual(j, points[k][j]));
    out[k] *= 0.5;
  }
  return out;
}

bool FitProblem::jacobian(const Point& x, const Eigen::VectorXd& residual, Eigen::MatrixXd& jac) const {
  jac.resize(total_rows_, n());
  return columns(x, residual, std::vector<char>(free().size(), 1), jac);
}

std::vector<FitProblem::Column> FitProblem::columns_asked(const Point& x, const std::vector<char>& asked) const {
  const double step = difference_step;
  std::vector<Column> columns;
  for (std::size_t l = 0; l < logs_.size(); ++l)
    for (std::size_t j = 0; j < free().size(); ++j)
      if (asked[j] && (free()[j].log < 0 || free()[j].log == static_cast<int>(l)))
        columns.push_back({static_cast<int>(j), static_cast<int>(l), x[j] + step <= 1.0 ? step : -step});
  return columns;
}

// Some logs at a time: what keeps the threads busy, and not all logs' trajectories in memory.
std::size_t FitProblem::end_of_batch(std::span<const Column> columns, std::size_t first) const {
  std::size_t last = first;
  const auto enough = [&] {
    return last - first >= 64 && columns[last].log - columns[first].log >= std::min(threads(), 8);
  };
  while (last < columns.size() && (last == first || columns[last].log == columns[last - 1].log || !enough())) ++last;
  return last;
}

bool FitProblem::run_moved(const Point& x, std::span<const Column> columns, Eigen::VectorXd& from) const {
  Workspace& w = workspace();
  w.hold(columns.size());
  Point moved = x;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    moved[columns[c].j] = x[columns[c].j] + columns[c].dx;
    chart_.candidate(moved, columns[c].log, w.candidates[c]);
    moved[columns[c].j] = x[columns[c].j];
    w.jobs.push_back({&logs_[columns[c].log]->scenario, &w.candidates[c], &w.runs[c]});
  }
  std::vector<ParameterVector> bases(logs_.size());
  std::vector<Trajectory> followed(logs_.size());
  std::vector<NearJobs> near;
  for (std::size_t c = 0; c < columns.size();) {
    const std::size_t begin = c;
    const int l = columns[c].log;
    while (c < columns.size() && columns[c].log == l) ++c;
    chart_.candidate(x, l, bases[l]);
    near.push_back({&bases[l], std::span(w.jobs).subspan(begin, c - begin), &followed[l]});
  }
  work_.simulations += simulate_near(near, options_);
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (!w.runs[c].ok) {
      ++work_.failed;
      return false;
    }
  // Followers are compared with the very run that they followed.
  for (const NearJobs& n : near)
    if (n.of_base->ok) fill(static_cast<int>(n.of_base - followed.data()), *n.of_base, from);
  return true;
}

void FitProblem::difference(std::span<const Column> columns, const Eigen::VectorXd& from, Eigen::MatrixXd& jac) const {
  const std::vector<Trajectory>& runs = workspace().runs;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads())
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const int l = columns[c].log;
    std::vector<double>& r = residual_space();
    for (std::size_t channel = 0; channel < logs_[l]->channels.size(); ++channel) {
      whitened(l, static_cast<int>(channel), runs[c], r);
      const long at = offset_[l][channel], samples = static_cast<long>(r.size());
      jac.col(columns[c].j).segment(at, samples) =
          (Eigen::Map<const Eigen::VectorXd>(r.data(), samples) - from.segment(at, samples)) / columns[c].dx;
    }
  }
}

void FitProblem::prior_rows(Eigen::MatrixXd& jac) const {
  jac.bottomRows(total_rows_ - data_rows_).setZero();
  long at = data_rows_;
  for (std::size_t j = 0; j < free().size(); ++j)
    if (std::isfinite(free()[j].prior_sd)) jac(at++, static_cast<long>(j)) = 1.0 / free()[j].prior_sd;
}

bool FitProblem::columns(const Point& x, const Eigen::VectorXd& residual, const std::vector<char>& asked,
                         Eigen::MatrixXd& jac) const {
  const std::vector<Column> all = columns_asked(x, asked);
  for (std::size_t j = 0; j < free().size(); ++j)  // what a log's own value does not touch
    if (asked[j] && free()[j].log >= 0) jac.col(static_cast<long>(j)).head(data_rows_).setZero();
  prior_rows(jac);
  for (std::size_t first = 0, last; first < all.size(); first = last) {
    last = end_of_batch(all, first);
    const std::span<const Column> batch = std::span(all).subspan(first, last - first);
    Eigen::VectorXd from = residual;
    if (!run_moved(x, batch, from)) return false;
    difference(batch, from, jac);
  }
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
