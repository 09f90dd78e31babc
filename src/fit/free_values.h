// The free numbers of a fit: the table's rows to estimate, the effects asked for, and each log's nuisances.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fit/chart.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "parameters/table.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {

// Rows with estimate = 1 that all logs share (row 41 and the air are nuisances of each log), with a prior around
// its nominal. Half the row's range is its width, as a datasheet's bounds already say what is likely; of an effect it
// is the effect's typical size.
std::vector<FreeValue> shared_values(const Table& table);

// Narrower priors for what the rig file, or the valve's kind, says of the pilot stage. Logs of motion and pressure
// hardly show it: the nozzles' diameter sets the scale of all forces on the spool, orifices and gap trade with what is
// laminar beside them, the motor's lag with the driver's. Left alone, friction, flow force and the answer to another
// oil end anywhere along a valley, and a plugged nozzle or a lost wire would be one of another valve. So is the
// piston's leak, which under a light load moves the piston as a slower valve does. A row that a prior is `asked` for
// keeps it.
void hold_to_sheet(std::vector<FreeValue>& shared, const Table& table, const RigFile& rig,
                   const std::map<std::string, double>& asked);

// Whether the rig file states what the width of the ports follows from.
bool states_width(const RigFile& rig);

// A row that the rig file states, whose tuned value stands at the end of what the table allows: it does duty for
// something that the model lacks.
struct OffDrawing {
  std::string row;
  double times = 1;  // the tuned value over the drawing's
};
std::vector<OffDrawing> rows_off_drawing(const Table& tuned, const Table& nominal, const RigFile& rig);

// The tuned value of a row over that of its drawing; 1 where the rig file states none.
double times_drawing(int row, const Table& tuned, const RigFile& rig);

// A log's own: null, free air, viscosity where no temperature was logged, command between samples, offsets of spool and
// pressure sensors; only those that the log can show. `null_limit` [fraction of rated] bounds the null about the
// base's. Prior widths: docs/model.md, "Nuisances".
std::vector<FreeValue> nuisance_values(const LogData& log, int log_index, const ParameterVector& base,
                                       double null_limit);

// Where a log starts, true less measured: spool, chamber pressures, piston speed, each bounded by what its sensor's
// noise makes likely. The first sample is in the misfit like any other, so the prior is wide. Held at zero, the first
// sample's noise drives the whole first transient, and parameters take it for theirs.
std::vector<FreeValue> start_values(const LogData& log, int log_index);

// Appends rows for effects that the table lacks, free and at their typical size, or off where a number may lie on
// either side of nought. Throws InputError for an unknown name.
void add_effect_rows(Table& table, const std::vector<std::string>& effects);

// Value at which a parameter of a candidate switches its effect off; none for the 41 rows and for what only shapes.
std::optional<double> off_value(int position);

}  // namespace servodx
