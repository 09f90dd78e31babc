// How the channels of a log move, whatever they drift: differences of means over blocks of time. And how much of that
// a simulation leaves.
//
// A part that is left is of the motion measured and of the motion that a healthy valve would show, together: 0 where
// the simulation moves as the log does, about 1 where the two have nothing in common, 2 where they are opposite. A
// valve that hardly moves though it should leaves little to a simulation that hardly moves either. Where the log does
// move, a simulation that leaves as much of a channel as a constant would has said nothing of it, and leaves all.
#pragma once
#include <vector>

#include "fit/log_data.h"
#include "servodx/log.h"
#include "signals/signal.h"
#include "simulate/scenario.h"

namespace servodx {

// Means over blocks of time: what rings or lags within a block averages out.
struct Blocks {
  std::vector<double> time, value;  // NaN where no sample of the block is present
};
Blocks means_of(const std::vector<double>& time, const std::vector<double>& x, bool of_size = false);

// Each block's mean less the one ahead.
std::vector<double> moves(const std::vector<double>& time, const std::vector<double>& x);

// 0 where one of them does not move.
double correlation(const std::vector<double>& a, const std::vector<double>& b);

struct MotionLeft {
  Signal signal = Signal::spool_position;
  double part = 1;
};
// Of each channel that moves, or would in health, beyond its noise. A simulation that failed leaves all.
std::vector<MotionLeft> motion_left(const LogData& log, const Trajectory& healthy, const Trajectory& simulated);
// Their mean; of no channel `none`.
double mean_left(const std::vector<MotionLeft>& left, double none);

}  // namespace servodx
