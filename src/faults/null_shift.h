// Null beyond what calibration covers. Within the rig's null limit a shifted null is adjusted, not a fault.
#pragma once
#include "faults/fault.h"
#include "parameters/list.h"

namespace servodx {

inline const Fault null_shift{
    .name = "null_shift",
    .meaning = "the current at which the spool is centred has moved, against the fault-free logs, beyond the limit",
    .unit = "fraction of rated current",
    .healthy = 0.0,
    .worst = 0.35,
    .log_scale = false,
    .least = 0.05,
    .spread = 0.005,  // hysteresis
    .starts = {0.1, 0.2, -0.1, -0.2},
    .test = "rest at zero command and read the spool",
    .action = "abuse: recalibrate the null",
    .apply = [](double* v, double s) { v[row::servovalve_null] += s; }};

}  // namespace servodx
