// How wrong the tuned model is, channel by channel, beyond the sensor's noise.
//
// sigma(t)^2 = noise^2 + floor^2 + (per_activity * activity(t))^2, where activity is how far the simulated channel
// moves in a millisecond, averaged over the last 20 ms: a model is wrong in timing and gain, so it errs where things
// move. Learnt from fault-free logs; in every likelihood it stands for the model's own error. Residuals are
// correlated in time: `independent` is how many of them a second count. A model's error lasts as long at any sample
// rate, so a log taken twice as fast does not tell twice as much.
#pragma once
#include <string>
#include <vector>

#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/unit_cube.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "simulate/scenario.h"

namespace servodx {

struct ChannelError {
  Signal signal;
  double floor = 0;         // [SI]
  double per_activity = 0;  // [-] channel movement per millisecond to error
  double independent = 50;  // [1/s]
};

struct ErrorModel {
  std::vector<ChannelError> channels;
  const ChannelError* find(Signal s) const;
};

inline constexpr double activity_time = 20e-3;  // [s] memory of the activity

// [SI per ms] see above; one entry a sample.
std::vector<double> activity(const std::vector<double>& time, const std::vector<double>& simulated);

// sigma(t) [SI] of a channel with sensor noise `noise`. `error` may be null: noise alone.
std::vector<double> sigma_of(const ChannelError* error, double noise, const std::vector<double>& activity);

// The same of a channel of a log beside a run of it. Where the run failed, the measured channel stands in for it.
std::vector<double> channel_sigma(const ErrorModel& model, const LogData& log, std::size_t channel,
                                  const Trajectory& run);

// Fraction of the samples at `time` that count as independent, at most 1. `error` may be null: a channel that no tuning
// log held.
double effective_of(const ChannelError* error, const std::vector<double>& time);

// Fraction of independent samples of a whitened series: 1 over the integrated autocorrelation time (initial positive
// sequence, Geyer 1992).
double effective_fraction(const std::vector<double>& whitened);

// Takes out the channels that no tuning log held, and says so, a note each: how wrong the model is there is not known,
// and a sensor's noise is no measure of it.
std::vector<Note> leave_out_unknown_channels(LogData& log, const ErrorModel& model);

// Maximum-likelihood floor and slope from the residuals of the problem's logs at x, pooled by signal.
ErrorModel learn_error_model(const FitProblem& problem, const Point& x);

// Sets the problem's whitening from the model at x: sigma(t) / sqrt(effective fraction), so that 0.5 |residual|^2 is a
// log-likelihood. Of logs that run one programme (LogData::alike) each holds its part of what they tell of the model's
// error: their noise averages out, the error comes back in each. `each_log`: a channel of a log that the model fits
// worse than the others counts for less, and one that it fits better for more; its variance has an inverse-gamma prior
// about the pooled one.
void apply_error_model(FitProblem& problem, const ErrorModel& model, const Point& x, bool each_log = false);

}  // namespace servodx
