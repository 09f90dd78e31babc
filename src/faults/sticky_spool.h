// Sticky spool: silt or lacquer multiplies the friction between spool and sleeve. Silt that packs while the spool
// stands (silt lock) gives way once it moves; lacquer and a bent spool drag on: the shape says which.
#pragma once
#include "effects/registry.h"
#include "effects/stiction.h"
#include "faults/fault.h"
#include "parameters/list.h"

namespace servodx {

inline const Fault sticky_spool{
    .name = "sticky_spool",
    .meaning = "friction between spool and sleeve",
    .unit = "times the tuned friction",
    .healthy = 1.0,
    .worst = 60.0,
    .log_scale = true,
    .least = 2.5,
    .spread =
        0.9,  // the healthy friction that it multiplies is hardly seen: the eight sticky spools of rigs A and B
              // (docs/lab/independent_rigs.md) were read a factor e^0.96 (rms) off, all of one rig to the same side
    .starts = {4.0, 20.0},
    .test =
        "slow small sine: the spool stands still at each reversal, longer the slower; backlash does not care for rate",
    .action = "abnormal: call service",
    .apply =
        [](double* v, double s) {
          v[row::spool_friction] *= s;
          v[effect_row<Stiction>(0)] *= s;
        },
    .failed = 20.0,  // the end of what Borello 2009 studies
    .shapes = {{.name = "share that only holds the spool at rest",
                .lower = 0.0,
                .upper = 1.0,
                .start = 0.3,
                .in_health = 0.0,
                .apply =
                    [](double* v, double share) {
                      v[effect_row<Stiction>(0)] += share * v[row::spool_friction];
                      v[row::spool_friction] *= 1.0 - share;
                    }},
               // Friction laws differ in it: a bristle of one stiffness yields in proportion to the force it holds,
               // asperities of one size not at all. Of the logs of rig B 5 times the friction wants none of it, 20
               // times it 5 um.
               {.name = "way over which it yields before it slips, above a clean one's [m]",
                .lower = 0.0,
                .upper = 1.5e-5,
                .start = 3e-6,
                .in_health = 0.0,
                .apply = [](double* v, double yield) { v[effect_row<Stiction>(1)] += yield; }}}};

}  // namespace servodx
