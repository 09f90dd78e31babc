// Worn ball of the feedback wire: the spool moves through a clearance before the wire pulls.
#pragma once
#include "faults/fault.h"
#include "parameters/list.h"

namespace servodx {

inline const Fault feedback_wire_backlash{
    .name = "feedback_wire_backlash",
    .meaning = "clearance between the ball of the feedback wire and the spool",
    .unit = "m",
    .healthy = 0.0,
    .worst = 1e-4,
    .log_scale = false,
    .least = 3e-6,
    .spread = 1.5e-6,  // ball contact is not a sharp gap
    .starts = {6e-6, 2e-5},
    .test = "small sine about null: the spool jumps through the clearance at each reversal, whatever the rate",
    .action = "abnormal: call service",
    .apply = [](double* v, double s) { v[row::valve_glitch] += s; },
    .failed = 20e-6};  // the end of what Borello 2009 studies

}  // namespace servodx
