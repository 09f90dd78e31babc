// The pump, its relief valve or an accumulator: the valve gets less pressure than it had on healthy logs. Where the log
// records the supply the record tells; else the pressure is a hypothesis.
#pragma once
#include "faults/fault.h"
#include "parameters/list.h"
#include "faults/record.h"

namespace servodx {

inline const Fault supply_fault{.name = "supply_fault",
                                .meaning = "the supply pressure is not what it is on healthy logs",
                                .unit = "of the healthy supply pressure",
                                .healthy = 1.0,
                                .worst = 0.3,
                                .log_scale = true,
                                .prior = 0.3,
                                .least = 0.94,   // stands are set to some per cent
                                .spread = 0.02,  // and droop with the flow, which the row does not
                                .starts = {0.85, 0.6},
                                .test = "the same test with the supply pressure recorded at the valve",
                                .action = "abnormal: call service",
                                .apply = [](double* v, double s) { v[row::supply_pressure] *= s; },
                                .told_by = Record::supply};

}  // namespace servodx
