// The misfit of the model to logs as least squares over the unit cube: shared parameters and, log by log, nuisances.
//
// residual = filtered (measured - simulated) / sigma, channel by channel, then the priors. All lanes of all logs are
// filled in one batch; a nuisance's column costs only its own log's simulation.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fit/chart.h"
#include "fit/fit_work.h"
#include "fit/log_data.h"
#include "optimise/box_least_squares.h"
#include "optimise/robust_loss.h"
#include "optimise/unit_cube.h"
#include "signals/filters.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {

// Step of a Jacobian through contacts and frictions, which roughen the response. [of the unit interval]
inline constexpr double step_through_contacts = 1e-3;

class FitProblem {
 public:
  FitProblem(std::vector<const LogData*> logs, ParameterVector base, std::vector<FreeValue> free,
             SimulateOptions options = {});

  int n() const { return chart_.n(); }
  const Chart& chart() const { return chart_; }
  const std::vector<FreeValue>& free() const { return chart_.free(); }
  const std::vector<const LogData*>& logs() const { return logs_; }
  Point start() const { return chart_.start(); }
  // The candidate of a log at a point.
  ParameterVector candidate(const Point& x, int log) const { return chart_.candidate(x, log); }

  // Step of the Jacobian, of the unit interval. Wider where contacts and friction roughen the response; where columns
  // are so many that they follow the run (simulate_near), it moves only what is around the steps.
  double difference_step = 1e-4;

  // Whitening: sigma of (log, channel), the same at every sample, or sample by sample.
  void set_sigma(int log, int channel, double sigma);
  void set_sigma(int log, int channel, std::vector<double> sigma);
  const std::vector<double>& sigma(int log, int channel) const { return sigma_[log][channel]; }

  std::vector<Evaluation> evaluate(std::span<const Point> points) const;
  // 0.5 * sum of the squared residuals as `loss` changes them (robust_loss.h); infinite where a run fails. Keeps no
  // residuals, and from the second call on asks for no memory but its result's, unless a channel has a moving average
  // or a notch. `ranking`: fast and rough, to compare points (ranking_steps). `bounds`, one a point or none:
  // some logs are run at a time, and a point that they put above its bound is left at that.
  std::vector<double> costs(std::span<const Point> points, RobustLoss loss, double scale, bool ranking = false,
                            std::span<const double> bounds = {}) const;
  bool jacobian(const Point& x, const Eigen::VectorXd& residual, Eigen::MatrixXd& j) const;
  // Of the free values that are `asked` for alone; the other columns of j, which has its size, stay as they are.
  bool columns(const Point& x, const Eigen::VectorXd& residual, const std::vector<char>& asked,
               Eigen::MatrixXd& j) const;
  LeastSquaresProblem least_squares() const;

  // Raw residual (measured - simulated, filtered as the channel is) of a log's channel. [SI] NaN where missing.
  std::vector<double> raw_residual(int log, int channel, const Trajectory& t) const;
  std::vector<Trajectory> trajectories(const Point& x) const;
  // Rows of the residual that belong to (log, channel): first row and count.
  std::pair<long, long> rows(int log, int channel) const {
    return {offset_[log][channel], static_cast<long>(logs_[log]->scenario.time.size())};
  }
  // Of each row of the residual, priors included, the log that it is of; -1: the prior of a shared value.
  std::vector<int> logs_of_rows() const;
  long data_rows() const { return data_rows_; }
  long total_rows() const { return total_rows_; }  // the priors' behind those of the data
  long simulations() const { return work_.simulations; }
  long failed_simulations() const { return work_.failed; }
  // So far; may be set: what a checkpoint holds is not run again, and counts all the same.
  FitWork& work() const { return work_; }
  // Hash of what its costs rest on beside the logs' samples: the base, the free values and the weights.
  std::string content_hash() const;

 private:
  std::span<const Trajectory> run(std::span<const Point> points, std::span<const std::size_t> which, std::size_t first,
                                  std::size_t last, bool ranking) const;
  // Of one run, of a channel: raw, and whitened.
  void residual(int log, int channel, const Trajectory& t, std::vector<double>& r) const;
  void whitened(int log, int channel, const Trajectory& t, std::vector<double>& r) const;
  double prior_residual(std::size_t j, double x) const;
  void fill(int log, const Trajectory& t, Eigen::Ref<Eigen::VectorXd> out) const;
  // Of a Jacobian: a number of the point, moved by dx in the run of one log.
  struct Column {
    int j, log;
    double dx;
  };
  std::vector<Column> columns_asked(const Point& x, const std::vector<char>& asked) const;
  std::size_t end_of_batch(std::span<const Column> columns, std::size_t first) const;
  // Runs them. False where one fails; else `from` becomes the residual that they differ from.
  bool run_moved(const Point& x, std::span<const Column> columns, Eigen::VectorXd& from) const;
  void difference(std::span<const Column> columns, const Eigen::VectorXd& from, Eigen::MatrixXd& jac) const;
  void prior_rows(Eigen::MatrixXd& jac) const;
  int threads() const;
  std::vector<const LogData*> logs_;
  Chart chart_;
  SimulateOptions options_;
  std::vector<std::vector<std::vector<double>>> sigma_;
  std::vector<std::vector<long>> offset_;
  std::vector<std::vector<std::optional<HighPass>>> drift_;  // the channels' high-passes, made ready
  long data_rows_ = 0, total_rows_ = 0;
  mutable FitWork work_;
};

}  // namespace servodx
