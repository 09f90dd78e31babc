// Whether a log holds a response that can be judged at all. A verdict about a log in which nothing moves, or in which
// noise is all, would be confident nonsense, whichever way it falls.
//
// By the samples alone: no fit, no hypothesis; the table gives sizes. Only what no valve and no fault of one can do
// counts; a jam or a dead supply leaves the sensors' noise and is judged.
#pragma once
#include "diagnose/ready_logs.h"
#include "fit/log_data.h"
#include "servodx/operating_point.h"
#include "simulate/scenario.h"

namespace servodx {

enum class Unjudgeable {
  no,
  nothing_asked,           // the command, and what else drives the valve, stands still
  sensors_still,           // every compared channel shows one value while the command moves
  command_missing,         // the spool moves, though the command asks for nothing
  noise_alone,             // no channel knows its own last sample, one of them far beyond a sensor's noise
  command_too_large,       // most of the time a multiple of what the valve is made for
  pressure_beyond_supply,  // chambers far above any supply
  position_beyond_travel,  // spool or piston far beyond where its stops let it go
  too_short,               // shorter than a valve's answer, or sampled more slowly
  pressures_out_of_order,  // a chamber below the return, or one that moves above the supply, most of the time
  rows_jump,               // the piston is elsewhere from one sample to the next: rows of two records, or out of order
  copied,                  // two channels are one signal
  coarse,                  // every channel that moves shows a handful of values
  oil_beyond,              // a temperature that no oil bears
};

// Half of the time the command is beyond what a driver gives.
bool asks_too_much(const Scenario& in);
Unjudgeable unjudgeable(const LogData& log, const ParameterVector& base);
// By where it was recorded.
Unjudgeable unjudgeable(const OperatingPoint& point);
// By either, of several logs of the first that is; `points`: of each log.
Unjudgeable unjudgeable(const ReadyLogs& logs, const ParameterVector& base, const std::vector<OperatingPoint>& points);

}  // namespace servodx
