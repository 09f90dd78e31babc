// Cracked or broken feedback wire: the spool's static gain rises; without any wire the valve integrates its current and
// the spool runs to its stop.
#pragma once
#include "faults/fault.h"
#include "faults/gross_finding.h"
#include "parameters/list.h"

namespace servodx {

inline const Fault feedback_wire_lost{
    .name = "feedback_wire_lost",
    .meaning = "the feedback wire is cracked or broken",
    .unit = "fraction of the wire stiffness left",
    .healthy = 1.0,
    .worst = 0.0,
    .log_scale = false,
    .least = 0.9,
    .spread = 0.05,  // torque gain and wire stiffness share the static gain
    .starts = {0.8, 0.5, 0.1},
    .test = "small steps: the static gain rises as the stiffness falls; without a wire the spool does not stop",
    .action = "critical: stop the machine",
    .apply = [](double* v, double s) { v[row::feedback_wire_stiffness] *= s; },
    .ends_whole = true,
    .seen_outright = SeenOutright{GrossFinding::spool_on_both_stops, 0.1}};  // only the wire holds the spool

}  // namespace servodx
