// Data-sheet facts of a rig file into a parameter table: each fact sets the nominal value and the bounds of the rows
// that follow from it, by the formulas of docs/parameters.md.
//
// Where the sheet states a step or a frequency response, the rows that these tell are then fitted to it (fit/sheet.h).
//
// Valid for two-stage flapper-nozzle valves with a feedback wire; a jet pipe is refused. Leaves out: everything that a
// data sheet does not say (frictions, laps, lags), which keeps the table's values. The bounds that a fact sets are the
// spread of real parts about a data sheet, widened where a fault moves the row.
#pragma once
#include "servodx/data_sheet.h"

namespace servodx {

// Discharge coefficients behind the formulas; a test holds them equal to the model's.
namespace nominal {
inline constexpr double cd_metering = 0.61;
inline constexpr double cd_orifice = 0.65;
inline constexpr double cd_nozzle = 0.64;
inline constexpr double clean_filter_area_ratio = 5.0;
inline constexpr double slot_resistance = 0.845;
inline constexpr double jet_angle_factor = 0.43;
}  // namespace nominal

}  // namespace servodx
