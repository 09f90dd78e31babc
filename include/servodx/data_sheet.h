// What a valve's data sheet, by its rig file, says of a parameter table: rows that follow from facts, and the dynamics
// that it states beside those of the table's valve. docs/parameters.md.
#pragma once
#include <string>
#include <vector>

#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {

// Returns the table with the rows that follow from facts overridden; their `source` becomes "rig.toml: KEY".
// `where_from` receives one line a row: "port_width = 0.005 m: rig.toml: valve.no_load_flow; formula".
// A tuned table (with std_error) keeps its values: they were measured, the data sheet only promises.
// Throws InputError at the fact that cannot hold.
Table apply_rig_facts(const Table& table, const Rig& rig, std::vector<std::string>* where_from = nullptr);

enum class SheetKind { step_rise_time, gain, phase_lag };

struct SheetFigure {
  SheetKind kind = SheetKind::step_rise_time;
  double frequency = 0;  // [Hz] of the sine
  double amplitude = 1;  // [fraction of rated current] of step or sine
  double stated = 0;     // [s], [dB], [rad]
  double tolerance = 0;  // the same, one standard deviation
};

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

// Every dynamic figure stated, phase_lag_90_frequency as one of them, at +-40 % of rated current.
std::vector<SheetFigure> sheet_figures(const Rig& rig);

// The dynamics that the sheet states beside those of the table's valve, its rows as apply_rig_facts makes them.
SheetFit data_sheet(const Table& table, const Rig& rig);

}  // namespace servodx
