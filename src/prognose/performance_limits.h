// Failure levels of the checks from a stated performance limit of the valve, through its tuned table.
//
//   bandwidth=L      the valve's bandwidth has fallen to the part L: the filter's blockage (row 1) that halves the
//                    pilot pressure so far, and r of a spool slower by 1/L
//   gain=G           its static gain has fallen to the part G: row 3, and r = 1/G
//   hysteresis=H     H of rated current: backlash b = H i GM / KSF (row 9); friction whose break-away takes as much
//                    current (row 14)
//   phase_margin=P   [deg] of the position loop of a velocity gain (`loop`, [1/s]): integrator and first-order valve,
//                    P = 90 deg - atan(loop / bandwidth); then as bandwidth
//   margin=G dB      what the position loop has to spare (loop_margins.h), in gain or in phase: every degradation
//   margin=P deg     whose model row, alone, brings it down to that. Spool moving as in the preflight sine
// Linear theory at 40 degC and the table's supply. Leaves out what one degradation does to another; all but margin
// leave out limit cycles.
#pragma once
#include <string>

#include "parameters/table.h"
#include "prognose/trend.h"
#include "prognose/trend_options.h"

namespace servodx {

enum class LimitKind { bandwidth, gain, hysteresis, phase_margin, loop_gain_margin, loop_phase_margin };

struct PerformanceLimit {
  LimitKind kind = LimitKind::bandwidth;
  double value = 0;
  std::string text;  // as the user gave it
};
// Throws InputError for what is not NAME=VALUE of a known limit; a margin's value ends in dB or deg.
PerformanceLimit read_limit(const std::string& text);

// Adds to `options`. Throws InputError for a value out of range, or a limit that the healthy valve does not hold.
void add_limit(const PerformanceLimit& limit, const Table& tuned, double loop, TrendSettings& options);

// r of a first-order spool `slower` times slower than the monitor, at the monitor's 95 % response.
double fidelity_of_slower(double slower);

}  // namespace servodx
