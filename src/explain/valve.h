// The servovalve as a subject of `explain`: logs of one valve in one state, its tuned table, and what might be missing.
//
// Free in every fit: each log's nuisances, and the rows that `tune` freed, about their tuned values: re-tuning. Causes:
// every effect of the registry, the effects that are rows, sensors and mains pick-up channel by channel, and every row
// that was held. The mains notch is off: a filter that could hide an effect is none here.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "explain/subject.h"
#include "fit/error_model.h"
#include "fit/problem.h"
#include "parameters/table.h"
#include "signals/rig_file.h"

namespace servodx {

class ValveSubject : public Subject {
 public:
  // Throws InputError where logs or table cannot be used.
  ValveSubject(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, int threads);

  const std::vector<Cause>& causes() const override { return causes_; }
  const std::vector<Series>& series() const override { return series_; }
  SubjectFit fit(const std::vector<int>& causes, bool wide) const override;
  bool retunes() const override { return true; }
  bool rescale(const Eigen::VectorXd& residual) override;
  // Misfit per independent sample before the weights were rescaled: 1 when as wrong as on the tuning logs.
  double adequacy() const { return adequacy_; }
  long simulations() const override;
  long failed_simulations() const override;

  const std::vector<LogData>& logs() const { return logs_; }
  // The least-squares problem behind fit().
  std::shared_ptr<FitProblem> problem(const std::vector<int>& causes, bool wide = false) const;
  // What a cause moves: positions in a candidate, a number each; air is a factor on the log's own.
  const std::vector<FreeValue>& values(int cause) const { return values_[static_cast<std::size_t>(cause)]; }
  // Another cause, a learnt curve.
  int add(Cause cause, std::vector<FreeValue> values);
  const ParameterVector& base() const { return base_; }
  const Table& table() const { return table_; }

 private:
  void add_causes(const RigFile& rig);
  std::vector<LogData> logs_;
  Table table_;
  ParameterVector base_;
  ErrorModel error_;
  SimulateOptions options_;
  std::vector<FreeValue> free_;  // the base's
  std::vector<Cause> causes_;
  std::vector<std::vector<FreeValue>> values_;
  std::vector<std::vector<std::vector<double>>> sigma_;  // [log][channel][sample] whitening
  std::vector<Series> series_;
  double adequacy_ = 1;
  mutable std::vector<std::shared_ptr<FitProblem>> made_;
};

}  // namespace servodx
