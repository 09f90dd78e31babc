// Drifted gain of the piston position sensor. A steady closed loop hides it; it scales every indicated velocity.
#pragma once
#include "faults/fault.h"
#include "parameters/list.h"
#include "faults/record.h"

namespace servodx {

inline const Fault sensor_fault{.name = "sensor_fault",
                                .meaning = "the piston position sensor's gain has drifted",
                                .unit = "indicated over true travel",
                                .healthy = 1.0,
                                .worst = 0.5,
                                .log_scale = true,
                                .prior = 0.1,
                                .least = 0.98,
                                .spread = 0.01,
                                .starts = {0.95, 0.8},
                                .test = "full strokes open loop against a second position reference",
                                .action = "abnormal: call service",
                                .apply = [](double* v, double s) { v[row::position_sensor_gain] *= s; },
                                .told_by = Record::sensor};

}  // namespace servodx
