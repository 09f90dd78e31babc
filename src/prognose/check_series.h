// One check over a valve's life, as the growth model takes it: its points in the coordinate of its growth, and what its
// name and the valve's table say of it.
//
// Temperature enters as the log of the oil's viscosity and its square, and of the paper's figures as the model's own
// expectation. What maintenance renewed, and what rests on another tuned table, is left out.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "faults/fault.h"
#include "prognose/check_name.h"
#include "prognose/growth.h"
#include "prognose/reading_scale.h"
#include "prognose/seeded.h"
#include "prognose/valve_history.h"

namespace servodx {

struct CheckSeries {
  CheckName name;
  std::string unit, cause;
  const Fault* fault = nullptr;
  std::optional<double> tuned;       // the row's value in the table that the checks rest on
  std::optional<double> per_newton;  // [A/N] of the spool's friction
  ReadingScale scale;
  ReadingCurve curve;  // of valves with known wear, where there is one
  std::vector<GrowthPoint> points;
  std::vector<double> temperature;  // [K]
};

struct SeriesOfValve {
  std::vector<CheckSeries> checks;
  std::size_t of_other_tables = 0;  // recordings left out
};
SeriesOfValve series_of(const ValveHistory& history);

// Readings as the wear at which valves with parts of known wear read the same, in the coordinate of the growth.
void take_seeded(CheckSeries& series, const std::vector<SeededReading>& seeded);
// A table that no data sheet and no log gave the screen's own size reads a clean one as partly blocked: where health
// reads so, that is the clean drop, and wear is of it.
void take_clean(CheckSeries& series, std::size_t healthy);

// [A/N] coil current that holds a force on the spool: the pilot pressure that balances it presses on the flapper,
// nozzle over spool area, against the motor. From the tuned rows. A log holds currents and motion; what a current is in
// newtons at the spool rests on the motor's gain and the nozzles' bore, and what a table has wrong of them all its
// friction has.
double friction_current(const std::vector<double>& tuned);

}  // namespace servodx
