// Logs that are sampled faster than a simulation steps. A fit steps by a third of a millisecond, by which it errs by
// 0.1 % rms (docs/model.md, Integration). Stepped from sample to sample, a log of 20 kHz would take twenty steps a
// millisecond for no more truth, and tell nothing more: what the model errs by lasts as long at any rate.
//
// Such a log is compared at points a millisecond apart, three steps, as a log of 1 kHz is.
// - The command drives the model at its own rate (simulate/fast_command.h).
// - A measured signal at a point is that of the parabola through the samples around it, half way to the next points, by
//   least squares. It passes what is smooth over a millisecond, so the simulation needs no such smoothing: a wave of
//   100 Hz is off by 4e-5 of itself. A point has a third of a sample's noise at 20 kHz. It
//   weighs as a sample all the same: `independent` was learnt with that noise, and a fast log is to tell no more.
// - Supply, return and load, freed of noise at their own rate, run in lines from point to point.
// Effects of the drive answer the mean of each step: hysteresis comes out within 0.05 % of range, a transport delay,
// which shifts the edges within a step with it, within 0.4 %. What it leaves out: what the load or the supply does
// above some 300 Hz, and what the sensors show of it.
#pragma once
#include "fit/log_data.h"
#include "fit/recorder.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {

// A fit's steps span several samples of such a log.
bool is_fast(const Log& log);

// A log made ready: at points where it is fast, else sample by sample.
LogData prepare_at_points(const Log& log, const RigFile& rig, const Recorder& recorder = {});
// The same, but by means where a stand's command creeps (fit/thin.h).
LogData prepare_to_fit(const Log& log, const RigFile& rig, const Recorder& recorder = {});

// The same of a fast log of which every sample is made ready.
LogData at_points(const LogData& every_sample);

}  // namespace servodx
