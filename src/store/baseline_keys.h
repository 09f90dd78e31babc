// What a baseline's file, and a verdict's, call the places and figures of a log.
#pragma once
#include <string>

#include "diagnose/record_figures.h"
#include "servodx/operating_point.h"

namespace servodx::store {

std::string key_of(Condition condition);  // supply_pressure | return_pressure | oil_temperature | load_force | drive
std::string key_of(FigureKind kind);      // "supply_level"

}  // namespace servodx::store
