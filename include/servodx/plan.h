// Plan: the excitation that tells most, within limits, and what it would show. docs/plan.md.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "servodx/baseline.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "servodx/watch.h"

namespace servodx {

struct TestPlan;  // the library's own

// What the test must not pass, about the point where it starts.
struct PlanLimits {
  double current = 1.0;            // [1 of rated current] above 0, up to 1
  std::optional<double> stroke;    // [m] of the piston, either way; empty: three quarters of the way to its stop
  std::optional<double> speed;     // [m/s] of the piston; empty: none
  std::optional<double> pressure;  // [Pa] in either chamber; empty: none
};

// A fault to be found, and at which severity; NaN: the first of its identifiers ('servodx list faults').
struct PlanFault {
  std::string name;
  double severity = std::numeric_limits<double>::quiet_NaN();  // [the fault's unit]
};

struct PlanOptions {
  std::vector<PlanFault> faults = {};   // to be found and named; all of these empty: every fault
  std::vector<PlanFault> between = {};  // two, to be told apart
  std::vector<std::string> rows = {};   // rows of the table, to be estimated
  double seconds = 2.0;                 // [s] of the test, 0.3 to 30
  double rate = 1000.0;                 // [Hz] samples of the command, 200 to 20000
  PlanLimits limits = {};
  std::optional<double> loop_gain = {};  // [A/m] of a proportional position loop; empty: open loop
  int rounds = 6;                        // of exchange, 0 to 100; more take longer
  std::uint64_t seed = 1;
  int threads = 0;   // 0: all cores; the result does not depend on it
  Watch watch = {};  // stopped: the best so far

  // Throws InputError that names the option, as the program calls it.
  void validate() const;
};

struct PlannedTest {
  // A piece of the test: a shape, how large and how fast.
  struct Piece {
    std::string shape;
    double start = 0, seconds = 0;  // [s]
    double amplitude = 0;           // [1 of rated current]
    double rate = 0;                // [Hz]
  };
  // What the test would show of a fault.
  struct Fault {
    std::string name, unit;
    std::optional<double> least;  // [unit] the mildest found in 19 of 20 tests; empty: not even the worst is
    bool from_mildest = false;    // found as soon as it is called a fault: `least` is where the range begins
    double severity = 0;          // [unit] that the test is judged at
    double deviates = 0;          // by which that one stands out from health
    double found = 0, named = 0;  // chance at that severity; named: found, and likelier than every other fault
    std::string nearest;          // fault that it is least well told from
  };
  struct Pair {
    std::string first, second;
    double told = 0;  // chance that the wrong one is ruled out, the smaller of both ways
  };
  struct Row {
    std::string name, unit;
    double before = 0, after = 0;  // [unit] standard deviation without and with the test
  };
  struct Extremes {
    double current = 0;                          // [A]
    double stroke = 0, speed = 0;                // [m], [m/s]
    double pressure_low = 0, pressure_high = 0;  // [Pa] in the chambers
    bool cavitates = false;                      // a chamber may fall to where oil holds no tension
  };
  struct Figures {
    double information = 0;  // the search's measure: of two tests the better one's is larger
    std::vector<Fault> faults;
    std::vector<Pair> pairs;
    std::vector<Row> rows;
    Extremes extremes;  // of a healthy valve within its tolerances
  };
  std::vector<double> time, command;  // [s], [A]
  std::vector<double> setpoint;       // [m] of a closed loop; empty in open loop
  std::vector<Piece> pieces;
  Figures planned;
  std::vector<double> random_command;  // [A] pieces drawn blindly, within the same limits and as long
  Figures random;
  double threshold = 0;  // [deviates] that a finding needs
  std::vector<Note> notes;
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;
  std::shared_ptr<const TestPlan> whole;  // for the program's pages
};

// `baseline`: its threshold; null: what noise alone needs. `like`: a log of the rig whose operating point, sensors and
// noise the test will have; null: the table's and 40 degC. Throws InputError.
PlannedTest plan_test(const Tuned& tuned, const Rig& rig, const PlanOptions& options = {},
                      const Baseline* baseline = nullptr, const Log* like = nullptr);

// CSV: time and command [mA], and in closed loop the setpoint [mm]. Comments say what it is for.
void write_command(const std::string& path, const PlannedTest& test);
// The random test in the same form.
void write_random_command(const std::string& path, const PlannedTest& test);

}  // namespace servodx
