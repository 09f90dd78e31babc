// The servovalve as a subject of `explain`: logs of one valve in one state, its tuned table, and what might be missing.
//
// Free in every fit: each log's nuisances, and the rows that `tune` freed, about their tuned values. With healthy logs
// to compare with the rows hold: what they have wrong is the same there, and no news; freed, they would take up what a
// missing effect does, differently on every log. A residual is then weighed by what is usual on healthy logs. Causes:
// every effect of the registry, the effects that are rows, sensors and mains pick-up channel by channel, and every row
// that was held. The mains notch is off: a filter that could hide an effect is none here.
//
// Residuals wander: a null that is a little off drives the piston away for good. Rows are therefore what a sample's
// residual says beyond the one before, r(k) - a r(k-1), a the channel's own correlation from sample to sample
// (Cochrane & Orcutt 1949): what comes and goes with the motion counts in full, and what merely drifts, once.
// Not so on a test stand: what is wrong of a sweep is a slow curve of its command, and to be seen as that.
#pragma once
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "explain/subject.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/unit_cube.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {

// How a channel errs on one healthy log, as tuned.
struct UsualError {
  std::string signal;
  double size = 1;       // rms, of the error that the tuned table states
  double memory = 0;     // correlation from sample to sample
  double effective = 1;  // fraction of the samples' news that counts as independent
  double rate = 1000;    // [1/s] of the samples
};
// What is known of a rig from its healthy logs.
struct KnownRig {
  std::vector<UsualError> errors;     // of all logs
  std::vector<double> air;            // fraction, a log each
  std::vector<double> command_slope;  // of the command between samples, a log each: how the logger takes it
  std::vector<double> drive_delay;    // [s] from the command to the coil current, a log each (explain/drive.h)
};

class ValveSubject : public Subject {
 public:
  // `known`: the rig's rows hold; may be empty. Throws InputError where logs or table cannot be used.
  ValveSubject(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, int threads,
               std::optional<KnownRig> known = {});

  const std::vector<Cause>& causes() const override { return causes_; }
  const std::vector<Series>& series() const override { return series_; }
  SubjectFit fit(const std::vector<int>& causes, bool wide) const override;
  bool retunes() const override { return true; }
  bool holds() const override { return known_.has_value(); }
  double thickness() const override;
  bool rescale(const Eigen::VectorXd& residual) override;
  Eigen::VectorXd physical(const Eigen::VectorXd& rows) const override;
  // Mean square of the residual behind the rows in units of the model's error on the tuning logs, all channels alike: 1
  // when as wrong as there.
  double adequacy(const Eigen::VectorXd& rows) const;
  // The same channel by channel, the root of it; and of what each sample says beyond the one before.
  std::vector<Miss> misses(const Eigen::VectorXd& rows) const;
  std::vector<UsualError> errors(const Eigen::VectorXd& rows) const;
  // Where fit(causes) starts, and the candidate of a log at a point of it. Neither simulates.
  Point start(const std::vector<int>& causes) const { return chart(causes).start(); }
  ParameterVector candidate(const std::vector<int>& causes, const Point& point, int log) const {
    return chart(causes).candidate(point, log);
  }
  // A nuisance of a log at a point of fit({}); NaN where the rig file states it.
  double own(int log, int at, const Point& point) const;
  // Whether a nuisance of some log stands at the upper end of where it may go, at a point of fit({}).
  bool own_at_end(int at, const Point& point) const;
  long simulations() const override;
  long failed_simulations() const override;
  int threads() const override { return options_.threads; }

  const std::vector<LogData>& logs() const { return logs_; }
  // The least-squares problem behind fit().
  std::shared_ptr<FitProblem> problem(const std::vector<int>& causes, bool wide = false) const;
  // What a cause moves: positions in a candidate, a number each; air is a factor on the log's own.
  const std::vector<FreeValue>& values(int cause) const { return values_[static_cast<std::size_t>(cause)]; }
  // Another cause, a learnt curve.
  int add(Cause cause, std::vector<FreeValue> values);
  // Another size at which a cause is tried, and a fit of it may begin.
  void try_at(int cause, std::vector<double> numbers) {
    causes_[static_cast<std::size_t>(cause)].probes.push_back({std::move(numbers)});
  }
  // Correlation from sample to sample that a series is weighed with.
  double memory(std::size_t series) const { return memory_[series]; }
  const ParameterVector& base() const { return base_; }
  const Table& table() const { return table_; }

 private:
  // Steps of the constructor.
  void prepare_logs(const std::vector<Log>& logs, const RigFile& rig);
  void free_own(double null_limit);  // [fraction of rated current]
  void free_rows();
  void weigh_as_tuned();
  void add_series(std::size_t log, std::size_t channel);
  std::size_t base_count(bool wide) const { return known_ && !wide ? own_ : free_.size(); }
  // The base's free numbers, and those of the causes.
  std::vector<FreeValue> free_for(const std::vector<int>& causes, bool wide) const;
  Chart chart(const std::vector<int>& causes) const { return {base_, free_for(causes, false)}; }
  struct PooledError {  // of a channel over all logs, in units of the tuned model's error
    std::string signal;
    double whole = 0, news = 0;  // rms; news: of what a sample says beyond the one before
  };
  std::vector<PooledError> pooled_errors(const Eigen::VectorXd& rows) const;
  Eigen::VectorXd in_tuned_errors(const Eigen::VectorXd& rows) const;
  bool of_stand(std::size_t log) const { return logs_[log].scenario.ports != Ports::actuator; }
  void remember(Eigen::Ref<Eigen::VectorXd> rows) const;  // r(k) to r(k) - a r(k-1), series by series
  void forget(Eigen::Ref<Eigen::VectorXd> rows) const;    // and back
  std::vector<LogData> logs_;
  Table table_;
  ParameterVector base_;
  ErrorModel error_;
  SimulateOptions options_;
  std::optional<KnownRig> known_;
  std::vector<FreeValue> free_;  // the base's: each log's own, then the rows
  std::size_t own_ = 0;          // of these, the logs' own
  std::vector<Cause> causes_;
  std::vector<std::vector<FreeValue>> values_;
  std::vector<std::vector<std::vector<double>>> sigma_;  // [log][channel][sample] whitening
  std::vector<std::vector<double>> tuned_sigma_;         // [series][sample] the same as the tuned table says it
  std::vector<double> memory_;                           // [series] a
  std::vector<std::vector<char>> afresh_;                // [series][sample] nothing is known of the sample before
  std::vector<Series> series_;
  mutable std::mutex making_;
  mutable std::vector<std::shared_ptr<FitProblem>> made_;
};

}  // namespace servodx
