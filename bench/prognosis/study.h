// What the parts of the prognosis study share: a virtual valve that is checked, and its degradations.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/random.h"
#include "parameters/table.h"
#include "prognose/check.h"
#include "prognose/check_name.h"
#include "prognose/valve_history.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "store/history.h"

namespace servodx::study {

struct Bench {
  Table tuned;
  RigFile rig;
  rig::RigModel model;
  std::string test;  // of the lives: preflight_slew or preflight_wear
};

// How a seeded-fault test states what a parameter reads at its end: as it is, as a multiple of what that valve was
// tuned to, or as the current that it takes.
enum class Stated { value, multiple, current };

// The paper's degradations, each to the end of what it studies; the clearance alone and with its corners.
struct Degradation {
  const char* name;        // to the rig
  const char* fault;       // that it is to a check
  double healthy, failed;  // severity
  const char* figure;      // of Borello et al. 2009
  const char* check;       // that it shows
  Stated stated;
};
inline constexpr Degradation degradations[] = {
    {"clogged_filter", "clogged_filter", 0, 0.75, "8", "fidelity", Stated::value},
    {"torque_motor_loss", "torque_motor_loss", 1, 0.2, "9", "fidelity", Stated::multiple},
    {"feedback_wire_backlash", "feedback_wire_backlash", 0, 20e-6, "10", "mean_error", Stated::value},
    {"sticky_spool", "sticky_spool", 1, 20, "11", "mean_error", Stated::current},
    {"radial_clearance_wear", "radial_clearance_wear", 1, 10, "12", "correlation@5Hz", Stated::value},
    {"edge_wear", "radial_clearance_wear", 1, 10, "12", "correlation@5Hz", Stated::value}};
inline constexpr int of_the_paper = 5;  // the first of them
inline double severity_at(const Degradation& d, double s) { return d.healthy + (d.failed - d.healthy) * s; }

struct Condition {
  double celsius = 40, air = 0.005, null = 0;  // null: of rated current, beside the valve's own
};
// -30 to 70 degC, free air 0.2 to 2 %, null within 1.5 %.
Condition random_condition(Random& random);

// The log of one test as a file would hold it.
Log test_log(const rig::RigModel& valve, const std::string& fault, double severity, const Condition& at,
             rig::RigRun run);
// One of them at its full length.
rig::RigRun preflight(const std::string& test, std::uint64_t seed);

Recording recording_of(double at, const CheckResult& result);
const Check* find(const std::vector<Check>& checks, const CheckName& name);

// On all threads that OpenMP has; progress to standard error.
void for_each(int n, const std::string& what, const std::function<void(int)>& work);

void figures(const Bench& bench, const std::string& out);
// `only`: these degradations, or "healthy"; none: all.
void lives(const Bench& bench, const std::string& out, int units, int checks, int first,
           const std::vector<std::string>& only);
void series(const Bench& bench, const std::string& out, const std::vector<std::string>& folders);
void store(const std::string& file, long rows);
void speed(const Bench& bench);
void predictor(int units, int checks);

}  // namespace servodx::study
