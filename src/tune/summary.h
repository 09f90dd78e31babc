// What a tune leaves of each log and channel, and what it says beside its figures.
#pragma once
#include <string>
#include <vector>

#include "fit/problem.h"
#include "fit/recorder.h"
#include "fit/tuned_state.h"
#include "optimise/unit_cube.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "simulate/scenario.h"
#include "tune/scope.h"
#include "tune/tune.h"

namespace servodx {

// `settled`: of the last fit. `heldout`: of the fit that had not seen the last part of every log.
std::vector<LogResult> results_by_log(const std::vector<Log>& logs, const TuneScope& scope, const FitProblem& problem,
                                      const Point& point, const std::vector<Trajectory>& settled,
                                      const std::vector<Trajectory>& heldout, double heldout_part);
// [-] What `runs` leave of the last part of every log over the sensors' noise, geometric mean over the channels; NaN
// where nothing is held out.
double heldout_over_noise(const FitProblem& problem, const std::vector<Trajectory>& runs, double heldout_part);
// Root of the mean square over the logs that have the channel.
std::vector<ChannelResult> pooled_channels(const std::vector<LogResult>& logs);
// Channels that are left so far beyond their sensor's noise, and by so much of what they can do, that a verdict by this
// table means little. `tuned`: a candidate of it.
std::vector<Unfollowed> unfollowed_channels(const std::vector<ChannelResult>& pooled, const ParameterVector& tuned);
// Nulls and air belong to the logs; the table keeps their medians.
void take_medians(Table& table, const std::vector<LogResult>& logs);
// How the command ran between samples, and the oil where no temperature was logged.
std::vector<Note> notes_of_logs(const std::vector<LogResult>& logs, const std::optional<CommandSlope>& usual,
                                const TuneScope& scope, const RigFile& rig);

}  // namespace servodx
