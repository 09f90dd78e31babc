// Worn piston seal: oil crosses from chamber to chamber in proportion to the load pressure.
#pragma once
#include "faults/fault.h"
#include "model/open_valve.h"
#include "parameters/list.h"

namespace servodx {

// Sizes are those beside the usual valve (model/open_valve.h).
inline const Fault cylinder_leakage{
    .name = "cylinder_leakage",
    .meaning = "leakage across the piston seal",
    .unit = "m3/s/Pa",
    .healthy = 0.0,
    .worst = usual_worst_leak,
    .log_scale = false,
    .prior = 0.1,
    .least = 7e-14,  // half a per cent of what it passes; new seals leak a tenth of that
    .spread = 2.6e-14,
    .starts = {2e-13, 1.3e-12, 4e-12},
    .test = "hold against a load with the spool at null: the piston creeps in proportion to the load pressure",
    .action = "abnormal: call service",
    .apply = [](double* v, double s) { v[row::cross_piston_leakage] += s; },
    .stated_at_40_degrees = true,
    .times = times_usual_valve};

}  // namespace servodx
