// Long sweeps of a test stand, thinned to what their dynamics need: a sweep of minutes is logged at a hundred samples a
// second, and the valve, its ports and the flow meter have nothing to say in less than some tenths of a second.
//
// Neighbouring samples are replaced by their means, inputs and outputs alike, in groups over which the command moves by
// no more than `thin_travel` and which last no longer than `thin_time`. A mean keeps what noise and rounding of the
// readings leave of the information, and what it loses of a curve is its curvature over a group. The log as a whole is
// thinned by its fastest second, or not at all; a log of an actuator never is.
#pragma once
#include "fit/log_data.h"
#include "fit/recorder.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {

inline constexpr double thin_travel = 2e-3;  // of rated current: some thirty groups over the peak of a leakage sweep
inline constexpr double thin_time = 0.2;     // [s] ports fill, and meters follow, in half a second and more

Log thinned(const Log& log, const RigFile& rig);

// The same made ready to be fitted: between means the command runs in a line, and nothing is left to be estimated
// there.
LogData prepare_thinned(const Log& log, const RigFile& rig, const Recorder& recorder = {});

// [s] largest substep on a stand that suits all of these logs (SimulateOptions::creep_step).
double creep_step_of(const std::vector<Log>& logs, const RigFile& rig);

}  // namespace servodx
