// How the simulation is wrong, before any cause is named: channel by channel, against the sensor's noise, the inputs,
// frequency, and the operating point.
//
// Whiteness and correlation with the inputs are judged by the 99 % band of white noise, 2.58 / sqrt(n): for an
// output-error fit the correlation with inputs is what says that dynamics are missing; a residual that is merely not
// white may be the sensor (Ljung, System Identification, 1999, sec. 16.6). Spectrum and coherence by Welch's method.
#pragma once
#include <string>
#include <vector>

#include "explain/valve.h"
#include "optimise/unit_cube.h"
#include "servodx/log.h"

namespace servodx {

struct InputCorrelation {
  std::string input;
  double correlation = 0;  // the largest, of residual now and input `lag` ago
  double lag = 0;          // [s]
  double band = 0;         // 99 % of white noise
};
struct MapBin {
  double from = 0, to = 0;      // [SI of the variable]
  double mean = 0, rms = 0;     // [SI] of the residual
  double time = 0, excess = 0;  // share of the samples and of the squared residual above noise
};
struct ResidualMap {
  std::string variable, unit;
  std::vector<MapBin> bins;  // equally many samples each
};
// Where the squared residual beyond the noise gathers most for the time that it takes there.
struct ExcessPlace {
  enum class Kind {
    none,           // nothing is beyond the sensor's noise
    spread,         // evenly
    near_reversal,  // within explain_constants::shown::near_event
    near_jump,      // of the command; the same
    lowest_part,    // the first of the parts that a variable's map is cut into
    highest_part    // the last
  };
  Kind kind = Kind::none;
  std::string variable = {};   // of the map
  double share = 0, time = 0;  // of the excess, of the samples
};
// The event or the end of a map that holds the largest share of the excess for its time; of equals the first.
ExcessPlace where_most_gathers(const std::vector<ExcessPlace>& places);

struct ShownChannel {
  std::string signal, unit;   // unit of the log
  double rms = 0, noise = 0;  // [SI]
  double memory = 0;          // [s] integrated autocorrelation time
  double beyond_band = 0;     // share of the first 50 lags outside the 99 % band of white noise
  std::vector<InputCorrelation> inputs;
  std::vector<std::pair<double, double>> spectrum;   // [Hz], [SI/sqrt(Hz)]
  std::vector<std::pair<double, double>> coherence;  // [Hz], with the command
  std::vector<ResidualMap> maps;
  ExcessPlace excess;
};

// Of the residual at a point of fit({}); logs pooled.
std::vector<ShownChannel> show(const ValveSubject& subject, const std::vector<Log>& logs, const Point& point);

}  // namespace servodx
