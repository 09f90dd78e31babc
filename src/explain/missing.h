// The valve's missing current, force, flow or pressure over time, at each place where something may be missing: the
// smoother (explain/smoother.h) on the model linearised along its run (simulate/linearise.h). Works with whatever
// channels a log has; where they do not tell two places apart it says so.
//
// Noise is what is usual of a channel on healthy logs, its memory included, or without them the sensor's, and white.
// Leaves out: valves on a test stand; sensors as places; what re-tuning could imitate.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "explain/valve.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct MissingInput {
  std::string where, quantity, unit;
  double rms = 0, std_error = 0;  // [unit] over time, and rms of its standard error
  double gain = 0;                // log likelihood over nothing missing, less what its one number costs (BIC)
  bool likely = false;            // preferred to nothing missing, and no other place is preferred to it
  std::string variable = {};      // that it follows most closely, in a line
  double share = 0;               // of its square that this line takes
  std::vector<std::vector<double>> value = {}, error = {};  // [log][sample] of MissingInputs::time; [unit]
};
struct MissingInputs {
  std::vector<MissingInput> places;       // the likeliest first; empty: not looked at
  std::vector<std::vector<double>> time;  // [log][sample] [s]
};

// At a point of fit({}). `told`: fraction done; false from it ends the work.
MissingInputs missing_inputs(const ValveSubject& subject, const Point& point,
                             const std::function<bool(double)>& told = {});

}  // namespace servodx
