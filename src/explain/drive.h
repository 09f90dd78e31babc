// Between the command and the coil current, where a log has both: what the driver and the line to it do needs no valve
// to be told, and the valve's simulation, which the measured current drives, shows nothing of it.
//
// Felt = gain times the command as it was a delay ago, behind a first-order lag, and an offset. The command goes in a
// line from sample to sample. Gain and offset are free in every log: `diagnose` judges them
// (diagnose/record_figures.h). Leaves out: clipping, dead zones, a lag of second order.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "explain/subject.h"
#include "explain/valve.h"
#include "optimise/unit_cube.h"
#include "servodx/log.h"

namespace servodx {

// The command of a log, sent through a driver. delay, lag [s]; the result begins settled. [A]
std::vector<double> through_driver(const std::vector<double>& time, const std::vector<double>& command, double delay,
                                   double lag);

class DriveSubject : public Subject {
 public:
  static constexpr int by_delay = 0, by_lag = 1;  // positions of its causes
  // `known`: the delay of the rig's healthy logs is no cause, and the residual is weighed by what theirs is.
  explicit DriveSubject(const std::vector<Log>& logs, const KnownRig& known = {});
  DriveSubject(const DriveSubject&) = delete;  // series point into it
  DriveSubject& operator=(const DriveSubject&) = delete;
  bool empty() const { return series_.empty(); }  // a log lacks one of the two, or its command stands still

  double sample_period() const;                             // [s] of the first log, on the mean
  double time_beyond_usual(int cause, double value) const;  // [s] that the current comes later; value: of its number
  // The driver may take the command anywhere between two samples: evenly spread, a sample over the root of twelve. [s]
  double time_error() const;
  double error_beside(int cause, std::size_t k) const override;
  const std::vector<Cause>& causes() const override { return causes_; }
  const std::vector<Series>& series() const override { return series_; }
  SubjectFit fit(const std::vector<int>& causes, bool wide) const override;
  bool holds() const override { return true; }  // what healthy drivers do is seen on healthy logs
  bool rescale(const Eigen::VectorXd& residual) override;

 private:
  struct Pair {  // of a log
    std::vector<double> time, command, current, sigma;
    double span = 0;  // [A] of the command
  };
  Eigen::VectorXd rows(const Point& x, const std::vector<int>& causes, const std::vector<Number>& numbers) const;
  double usual_delay_ = 0;  // [s]
  std::vector<UsualError> usual_;
  std::vector<Pair> pairs_;
  std::vector<Series> series_;
  std::vector<Cause> causes_;
};

// What is usual of a healthy log: the delay that follows it best, and what that leaves.
struct UsualDrive {
  double delay = 0;  // [s]
  UsualError error;  // [A]
};
// Empty where the log has not both, or nothing can be fitted.
std::optional<UsualDrive> usual_drive(const Log& log);

}  // namespace servodx
