// Worn corners of the metering edges: each rounds by the radius. Leakage at null rises and the pressure gain falls, as
// with a worn clearance; but an edge that is open by more than the radius flows as a new one does, and oil that is hot
// does not make it worse (Merritt, Hydraulic Control Systems, 1967, sec. 5.3; Borello 2009). Dirty oil does it.
//
// It has no level of failure of its own: `trend` follows the clearance, which wears with the corners.
#pragma once
#include "effects/edge_radius.h"
#include "effects/registry.h"
#include "faults/fault.h"
#include "faults/radial_clearance_wear.h"

namespace servodx {

inline const Fault corner_wear{
    .name = "corner_wear",
    .meaning = "the corners of the metering edges are rounded",
    .unit = "m",
    .healthy = 0.0,
    .worst = 1e-4,
    .log_scale = false,
    .prior = 0.3,      // seldom without the clearance, which is a fault of its own
    .least = 2.5e-6,   // what grinding leaves of a new edge, twice (1 to 3 um: data sheets' pressure gain)
    .spread = 1.5e-6,  // the model's smooth corner stands for an arc
    .starts = {4e-6, 1e-5, 4e-5},
    .test =
        "slow sweep through null with ports loaded, in cold and in hot oil: pressure gain falls alike in both, where "
        "a clearance makes it fall more in hot oil",
    .action = "abnormal: call service",
    .apply =
        [](double* v, double s) {
          v[effect_row<EdgeRadius>(0)] += s;
          v[effect_row<EdgeRadius>(1)] += s;
        },
    .twin = &radial_clearance_wear};  // both open the edges at null, and the laws of either err by as much

}  // namespace servodx
