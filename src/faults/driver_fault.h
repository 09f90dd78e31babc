// The current amplifier or its wiring: an open coil, a dead or saturated amplifier, a wrong gain. Told by the measured
// coil current beside the command. Without it no log parts the driver from a weak torque motor.
#pragma once
#include "faults/fault.h"
#include "parameters/list.h"
#include "faults/record.h"

namespace servodx {

inline const Fault driver_fault{.name = "driver_fault",
                                .meaning = "the coil current is not what the command asks for",
                                .unit = "current that flows over current asked for",
                                .healthy = 1.0,
                                .worst = 0.02,
                                .log_scale = true,
                                .prior = 0.1,
                                .least = 0.95,
                                .spread = 0.01,
                                .starts = {0.9, 0.5},
                                .test = "the same test with the coil current recorded beside the command",
                                .action = "critical: stop the machine",
                                .apply = [](double* v, double s) { v[row::torque_motor_gain] *= s; },
                                .told_by = Record::driver};

}  // namespace servodx
