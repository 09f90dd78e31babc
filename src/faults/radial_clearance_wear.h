// Worn spool and sleeve: a larger radial clearance leaks at null, the pressure gain falls. Shows in chamber pressures
// and piston, hardly in the spool.
#pragma once
#include "effects/edge_radius.h"
#include "effects/registry.h"
#include "faults/fault.h"
#include "parameters/list.h"

namespace servodx {

inline const Fault radial_clearance_wear{
    .name = "radial_clearance_wear",
    .meaning = "clearance between spool and sleeve has grown",
    .unit = "times the tuned clearance",
    .healthy = 1.0,
    .worst = 15.0,
    .log_scale = true,
    .least = 1.8,
    .spread = 0.15,  // leakage goes with a power of the clearance that depends on the edge
    .starts = {3.0, 8.0},
    .test = "small sine about null with ports loaded: pressure gain falls and leakage rises, more in hot oil",
    .action = "abnormal: call service",
    .apply = [](double* v, double s) { v[row::radial_clearance] *= s; },
    .failed = 10.0,  // the end of what Borello 2009 studies
    // What wears the lands wears their corners (Borello 2009), and laws of an edge near null differ in how much of a
    // clearance acts as a rounding.
    .shapes = {{.name = "rounding of the edges that goes with it, of the clearance",
                .lower = 0.0,
                .upper = 1.0,
                .start = 0.3,
                .in_health = 0.0,
                .apply =
                    [](double* v, double share) {
                      v[effect_row<EdgeRadius>(0)] += share * v[row::radial_clearance];
                      v[effect_row<EdgeRadius>(1)] += share * v[row::radial_clearance];
                    }}},
    .counted_in = row::radial_clearance};

}  // namespace servodx
