// Numbers that decide how a growing log is watched: what each is for.
//
// No half and no double of any was run.
#pragma once
#include <array>
#include <cstddef>

namespace servodx::online_constants {

// The simulation goes on by parts of this length: half of the time that an alarm may take after its evidence. [s]
inline constexpr double part = 10e-3;
inline constexpr std::size_t most_in_part = 1000;  // samples, at any rate
inline constexpr long late_is_set_back = 200;      // samples in a row: the clock was set back

// Squared errors are averaged over these times: a fracture shows in the first, a jam in slow motion in the last. [s]
inline constexpr std::array<double, 3> windows = {5e-3, 50e-3, 0.5};
inline constexpr int n_windows = static_cast<int>(windows.size());
inline constexpr double largest_square = 1e6;  // [deviates^2] of a sample: one spike does not fill a window for good

// The run beside the log (residuals.cpp).
inline constexpr double longest_gap = 0.25;   // [s] beyond it the valve may be anywhere: the run begins anew
inline constexpr double settling = 0.1;       // [s] after a beginning: what was not measured has not settled
inline constexpr double driver_floor = 0.01;  // of rated current: class of a shunt and of an amplifier
inline constexpr double driver_timing = 1.0;  // [ms] by which the lag of driver and recorder may be off

// What is kept in memory. [s]
inline constexpr double kept = 5.0;  // for the diagnosis
inline constexpr double after_alarm =
    1.0;  // until the diagnosis: its change point needs a tenth of the window behind it
inline constexpr double gross_window = 0.25;       // that a finding without a model is looked for in
inline constexpr double gross_every = 0.05;        // a fifth of it: so much later at most such a finding is told
inline constexpr double command_to_spool = 15e-3;  // a spool that moves has begun to

// Alarms.
inline constexpr double quiet_square = 9.0;  // [deviates^2] of the shortest window: three deviates
inline constexpr double quiet_part = 0.25;   // of the limit, where that is more: what healthy data have shown
inline constexpr double cleared_part = 0.5;  // of every limit, for so long:
inline constexpr double cleared_time = 1.0;  // [s]
inline constexpr std::array<double, 3> named_again = {0.03, 0.1,
                                                      0.3};  // [s] after an alarm the name is looked at again

// The supply's own record: a mean over this time is held against its band. [s] A pump drops under flow; further from
// its level than this part of it, or twice what healthy logs show, it has failed.
inline constexpr double supply_window = 50e-3;
inline constexpr double supply_strays = 0.1, supply_beyond_healthy = 2.0;

// Limits (alarm_limits.cpp).
inline constexpr double block = 0.5;           // [s] of healthy data: its largest level is one figure
inline constexpr double beyond_healthy = 4.0;  // of the largest level of healthy data: the least limit
inline constexpr double least_limit =
    25.0;                                   // [deviates^2] five deviates: healthy data that are quieter promise no more
inline constexpr double usual_level = 4.0;  // [deviates^2] largest of a block, where no log says
inline constexpr double usual_blocks = 2.0;  // that it counts for

// Naming (watcher.cpp).
inline constexpr double lead = 3e-3;  // [s] a failure has begun before it shows

}  // namespace servodx::online_constants
