// What the blocks of the model miss with measured signals in place of simulated ones (simulate/balance.h), as a subject
// of the engine: the missing flows and the missing force are its rows, the valve's causes its own.
//
// A replay does not run away. A piston that sticks in the simulation a moment sooner than on the rig is somewhere else
// from then on, and no size of any friction mends that; with the measured way of the rod the force that it takes is
// there to be read. What is wrong elsewhere does not reach it either. It needs piston, both pressures, and for the
// flows the spool; and it is blind to causes ahead of the spool, and to those with states of their own.
//
// Flows count in every window; the force only where the rod slides all through it, faster than its seals give before
// they slip: what they hold before that hangs on a way that the log does not tell to the micrometre. Near the ends of
// the stroke it does not count: cushions are no part of the model.
//
// A supply pressure that is measured drives the simulation, sag and all. Whether it sags by the flow that the rod
// draws, and more than on healthy logs, is told here.
#pragma once
#include <span>
#include <vector>

#include "explain/subject.h"
#include "explain/valve.h"
#include "optimise/unit_cube.h"
#include "simulate/balance.h"
#include "simulate/scenario.h"

namespace servodx {

class ReplaySubject : public Subject {
 public:
  // `at`: a point of valve.fit({}); each log's own numbers hold there. `known`: the rig's healthy logs. The valve
  // must outlive it.
  ReplaySubject(const ValveSubject& valve, const Point& at, const KnownRig& known = {});
  ReplaySubject(const ReplaySubject&) = delete;  // series point into it
  ReplaySubject& operator=(const ReplaySubject&) = delete;
  bool empty() const { return series_.empty(); }  // no log has the signals

  const std::vector<Cause>& causes() const override { return causes_; }  // the valve's
  const std::vector<Series>& series() const override { return series_; }
  // Free beside the causes: what each series misses on the mean, in its sigmas.
  SubjectFit fit(const std::vector<int>& causes, bool wide) const override;
  bool holds() const override { return true; }
  double thickness() const override { return valve_.thickness(); }
  bool rescale(const Eigen::VectorXd& residual) override;

  // rms of what is missing, over the logs [SI]; parts are named as the series are.
  std::vector<Miss> misses(const Eigen::VectorXd& rows) const;
  // The same log by log, for what is usual on healthy ones.
  std::vector<UsualError> errors(const Eigen::VectorXd& rows) const;

 private:
  struct Part {  // of one log
    std::size_t log = 0;
    std::vector<double> Balance::*missing = nullptr;
    std::vector<std::size_t> windows;
  };
  Eigen::VectorXd rows(const std::vector<int>& causes, std::span<const double> of_causes) const;
  Balance balance_of(std::size_t log, const ParameterVector& candidate) const;

  struct Quiet {  // of a log; empty where it does not show them
    std::vector<double> spool, piston;
  };
  const ValveSubject& valve_;
  std::vector<Quiet> quiet_;  // [log]
  std::vector<UsualError> usual_;
  std::vector<Cause> causes_;
  std::vector<ParameterVector> base_;  // [log]
  std::vector<Part> parts_;            // [series]
  std::vector<Series> series_;
  std::vector<std::vector<double>> time_, sigma_;  // [series]
};

}  // namespace servodx
