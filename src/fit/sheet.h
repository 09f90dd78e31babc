// What a data sheet says of a valve's dynamics, beside what a table's valve does; and the rows of the pilot stage and
// its driver that meet it (GA paper, "Servovalve simulation design": tuned to frequency and step response of the maker
// before any log).
//
// The figures are read from the model itself on a test stand with free ports at 40 degC: a step of the current, and
// sines of the stated amplitudes. Rows 4, 5, 6, 8 and 11, as far as the table leaves them free, are then least squares:
// figures by their tolerances, rows by their priors about the drawings' values (fit/free_values.h).
// Limits: the current is the command (no dither); the output is the spool, whose flow without load follows it.
#pragma once
#include <vector>

#include "servodx/data_sheet.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {

// The keys that ask for the fit: step_rise_time, frequency_response. A phase_lag_90_frequency by itself does not: the
// formula of nominal.cpp serves it.
bool states_dynamics(const RigFile& rig);

// Of `table`, whose rows follow the rig's other facts. `fit`: they are moved to meet the figures.
SheetFit beside_sheet(const Table& table, const RigFile& rig, bool fit);

// Farthest figure, in tolerances; infinite where one is missing.
double farthest(const std::vector<SheetFigure>& figures, const std::vector<double>& simulated);

}  // namespace servodx
