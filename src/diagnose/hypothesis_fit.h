// One hypothesis, fitted from one start.
#pragma once
#include <vector>

#include "diagnose/hypotheses.h"

namespace servodx {

// What every fit about a log shares.
struct HypothesisData {
  const LogData& log;
  const ParameterVector& base;
  const ErrorModel& error;
  const HypothesisSettings& settings;
  Trajectory reference;
};

struct Attempt {
  const Fault* fault = nullptr;
  double start = 0;  // of the severity
  HypothesisFit fit = {};
  std::vector<double> square = {};  // a sample: mean over the channels of the squared whitened residual
  FitWork work = {};
};

// Goes on where the attempt got to before; else begins at its start and, for the rest, at what `health` came to.
void run(Attempt& attempt, const HypothesisData& data, const HypothesisFit* health, int iterations);

struct Screened {
  const Fault* fault = nullptr;
  double severity = 0, misfit = 1e300;  // with the rest as in health
  FitWork work = {};
};
void screen(Screened& screened, const HypothesisData& data, const HypothesisFit& health);

}  // namespace servodx
