// Worn piston seal: oil crosses from chamber to chamber in proportion to the load pressure.
#pragma once
#include "faults/fault.h"
#include "parameters/list.h"

namespace servodx {

inline const Fault cylinder_leakage{
    .name = "cylinder_leakage",
    .meaning = "leakage across the piston seal",
    .unit = "m3/s/Pa",
    .healthy = 0.0,
    .worst = 2e-11,
    .log_scale = false,
    .prior = 0.1,
    .least = 2e-13,
    .spread = 1e-13,
    .starts = {5e-13, 4e-12},
    .test = "hold against a load with the spool at null: the piston creeps in proportion to the load pressure",
    .action = "abnormal: call service",
    .apply = [](double* v, double s) { v[row::cross_piston_leakage] += s; }};

}  // namespace servodx
