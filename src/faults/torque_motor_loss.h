// Loss of torque gain: shorted turns or weakened magnets. The spool's static gain and its slew fall together.
#pragma once
#include "faults/driver_fault.h"
#include "faults/fault.h"
#include "parameters/list.h"

namespace servodx {

inline const Fault torque_motor_loss{
    .name = "torque_motor_loss",
    .meaning = "the torque motor makes less torque per current",
    .unit = "fraction of the torque gain left",
    .healthy = 1.0,
    .worst = 0.05,
    .log_scale = true,
    .least = 0.9,
    .spread = 0.05,  // torque gain and wire stiffness share the static gain
    .starts = {0.8, 0.3},
    .test = "small and full steps: static gain and slew fall together, where a soft wire raises the gain",
    .action = "abnormal: call service",
    .apply = [](double* v, double s) { v[row::torque_motor_gain] *= s; },
    .failed = 0.2,  // the end of what Borello 2009 studies
    .twin = &driver_fault};

}  // namespace servodx
