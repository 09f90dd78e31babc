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

#include "parameters/table.h"
#include "servodx/rig.h"

namespace servodx {

enum class SheetKind { step_rise_time, gain, phase_lag };

struct SheetFigure {
  SheetKind kind = SheetKind::step_rise_time;
  double frequency = 0;  // [Hz] of the sine
  double amplitude = 1;  // [fraction of rated current] of step or sine
  double stated = 0;     // [s], [dB], [rad]
  double tolerance = 0;  // the same, one standard deviation
};

// The keys that ask for the fit: step_rise_time, frequency_response. A phase_lag_90_frequency by itself does not: the
// formula of nominal.cpp serves it.
bool states_dynamics(const RigFile& rig);

// Every dynamic figure stated, phase_lag_90_frequency as one of them, at +-40 % of rated current.
std::vector<SheetFigure> sheet_figures(const RigFile& rig);

struct SheetRow {
  int position = 0;              // in the table
  double before = 0, after = 0;  // [unit]
  double tells = 0;              // [deviates] by which a tenth more of it moves all figures together, at `after`
};

// formulas: the rows follow from the sheet's other facts alone; fitted: the search moved them; tuned: logs told them.
enum class SheetRows { formulas, fitted, tuned };

struct SheetFit {
  SheetRows rows_are = SheetRows::formulas;
  std::vector<SheetFigure> figures;
  std::vector<double> before, after;  // simulated; the same where nothing was fitted; empty: it left finite numbers
  std::vector<SheetRow> rows;         // strongest first
};

// Of `table`, whose rows follow the rig's other facts. `fit`: they are moved to meet the figures.
SheetFit beside_sheet(const Table& table, const RigFile& rig, bool fit);

// Farthest figure, in tolerances; infinite where one is missing.
double farthest(const std::vector<SheetFigure>& figures, const std::vector<double>& simulated);

}  // namespace servodx
