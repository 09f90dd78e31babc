// Random valves with a life each, as the study of lives follows them. What is made is kept under a folder and taken up
// again by the next run, so that a change of the table, of the checks or of the judging repeats only what follows it:
//
//   tests/UNIT/a1.csv ...    acceptance logs: a mixed drive, and preflight tests at 20, 40 and 60 degC
//   tests/UNIT/t01.csv ...   its preflight tests
//   valves/UNIT.csv          its own table: the type's, tuned on the acceptance logs
//   seeded.csv               the seeded-fault test, as `servodx trend --seeded` reads it
//   seeded/VALVE-FAULT.csv   looks at valves with a fault of known severities
//   units/UNIT.csv           its history of checks, which `servodx history import` reads
#pragma once
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "parameters/table.h"
#include "prognose/valve_history.h"
#include "prognosis/study.h"
#include "rig/rig_model.h"
#include "store/history.h"

namespace servodx::study {

struct Unit {
  std::string name;
  const Degradation* degradation = nullptr;  // none: healthy
  std::uint64_t valve = 0;
  double power = 1, onset = 0, life = 0;  // onset as a part of the life [h]
  std::uint32_t stream = 0;

  double progress(double s) const { return s <= onset ? 0.0 : std::pow((s - onset) / (1 - onset), power); }
};

// Units `first` to `first + units` of every degradation, and as many healthy ones. Every other one grows linearly, the
// others as s^p with p of 0.7 to 2; every other pair begins later than the valve.
std::vector<Unit> plan(int first, int units);

// With the severity at which this valve has failed: the level of failure is a clearance, whatever it was when the valve
// was new.
Degradation end_of(Degradation degradation, const rig::RigModel& type, const rig::RigModel& valve);
// The worn quantity itself, of this valve: newtons of a friction, metres of a clearance, else the severity.
double truth_of(const Degradation& degradation, const rig::RigModel& valve, double severity);
// What a valve's own acceptance logs say of it, from the type's table.
Table own_table(const Bench& bench, const std::string& name, const rig::RigModel& valve, std::uint32_t stream,
                const std::string& folder);
// One of the valves of the seeded-fault test, with a fault that has come so far on its way to failure (none: healthy):
// a recording for each part and temperature in turn, numbered by `at`.
inline constexpr int seeded_valves = 12;
inline constexpr double seeded_parts[] = {0.125, 0.25, 0.5, 0.75, 1}, seeded_celsius[] = {-25, 0, 25, 60};
inline double seeded_part(const Recording& look) {
  return seeded_parts[static_cast<std::size_t>(look.at) / std::size(seeded_celsius)];
}
rig::RigModel seeded_valve(const Bench& bench, int valve);
ValveHistory seeded_looks(const Bench& bench, int valve, const Degradation* fault, const std::string& folder);
ValveHistory history_of(const Bench& bench, const Unit& unit, int checks, const std::string& folder);

}  // namespace servodx::study
