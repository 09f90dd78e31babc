// Worn spool and sleeve: a larger radial clearance leaks at null, the pressure gain falls. Shows in chamber pressures
// and piston, hardly in the spool.
#pragma once
#include <algorithm>

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
    // Worn corners are further off new ones than the laws of an edge are off each other. Two arcs begin to part before
    // sharp corners would: the lap is less by a part of the radius of the model's smooth corner, which stands for arcs
    // of 0.4 times its own. 0.3 is the gap between two arcs without a clearance; 0.3 to 0.5 fit it with one. Without
    // that, the virtual rig's worn edges read two thirds of their clearance or less (0, 0.2, 0.3, 0.4, 0.5 and 0.7 were
    // tried on three logs). Shares of its edge_wear come to 1.6 and 3.8, of a clearance that wears alone to 0 to 0.15.
    .along = WornAlong{.name = "rounding of the edges, of what the clearance has grown",
                       .likely = 1.0,
                       .most = 6.0,
                       .apply =
                           [](double* v, const double* healthy, double share) {
                             constexpr double recession = 0.3;
                             const double grown = v[row::radial_clearance] - healthy[row::radial_clearance],
                                          radius = share * std::max(0.0, grown);
                             for (const int edge : {0, 1}) v[effect_row<EdgeRadius>(edge)] += radius;
                             for (const int lap : {row::lap_pa, row::lap_pb, row::lap_at, row::lap_bt})
                               v[lap] -= recession * radius;
                           }},
    .counted_in = row::radial_clearance};

}  // namespace servodx
