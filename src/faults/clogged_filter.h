// Clogged pilot filter: both rows of the blockage together. Pilot pressure falls, and with it the slew of the spool;
// the fixed orifices set the pilot flow until about half of the area is gone, so a mild one shows only in fast moves.
#pragma once
#include <algorithm>

#include "faults/fault.h"
#include "parameters/list.h"
#include "servodx/maintenance.h"

namespace servodx {

inline const Fault clogged_filter{
    .name = "clogged_filter",
    .meaning = "dirt in the pilot filter starves the first stage",
    .unit = "blocked fraction of the filter area",
    .healthy = 0.0,
    .worst = 0.98,
    .log_scale = false,
    .least = 0.15,
    .spread = 0.1,  // the size of the clean filter is not on data sheets
    .starts = {0.5, 0.8},
    .test = "full-amplitude steps at the coldest oil: the spool's slew falls, its static gain does not",
    .action = "critical: stop the machine",
    .apply = [](double* v, double s) { v[row::filter_blockage_positive] = v[row::filter_blockage_negative] = s; },
    .failed = 0.75,  // the end of what Borello 2009 studies
    .part_lost = true,
    .renewed_by = EventKind::filter_changed,
    .shapes = {{.name = "part of it at one direction of flow only, negative for the other",
                .lower = -1.0,
                .upper = 1.0,
                .start = 0.0,
                .in_health = 0.0,
                .apply = [](double* v, double one_way) {
                  v[row::filter_blockage_negative] *= 1.0 - std::max(0.0, one_way);
                  v[row::filter_blockage_positive] *= 1.0 - std::max(0.0, -one_way);
                }}}};

}  // namespace servodx
