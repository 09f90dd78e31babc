// The metering edges of a candidate as the detailed map HF takes them.
#pragma once
#include "prognose/monitor.h"
#include "simulate/scenario.h"
#include "valve_maps/high_fidelity.h"

namespace servodx {

// `candidate`: rows in SI. Corner radius, eccentricity and discharge are HF's own.
valve_maps::ValveGeometry geometry_of(const ParameterVector& candidate, const Supply& at);

}  // namespace servodx
