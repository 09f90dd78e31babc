// One hypothesis, fitted from one start.
#pragma once
#include <vector>

#include "diagnose/hypotheses.h"
#include "faults/fault.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "simulate/scenario.h"

namespace servodx {

// What every fit about a log shares.
struct HypothesisData {
  std::vector<const LogData*> logs;
  const ParameterVector& base;
  const ErrorModel& error;
  const HypothesisSettings& settings;
  std::vector<Trajectory> references;  // of each log
};
HypothesisData hypothesis_data(const std::vector<const LogData*>& logs, const ParameterVector& base,
                               const ErrorModel& error, const HypothesisSettings& settings);

struct Attempt {
  const Fault* fault = nullptr;
  double start = 0;  // of the severity
  const Fault* beside = nullptr;
  double start_beside = 0;
  HypothesisFit fit = {};
  std::vector<double> square =
      {};  // a sample of the first log: mean over the channels of the squared whitened residual
  FitWork work = {};
};

// Goes on where the attempt got to before; else begins at its start and, for the rest, at what `from` came to, health
// or the first fault alone.
void run(Attempt& attempt, const HypothesisData& data, const HypothesisFit* from, int iterations);

struct Screened {
  const Fault* fault = nullptr;
  double severity = 0, misfit = 1e300;  // with the rest as in health, or as with the first fault alone
  const Fault* beside = nullptr;        // then `severity` is of this one
  FitWork work = {};
};
void screen(Screened& screened, const HypothesisData& data, const HypothesisFit& from);

}  // namespace servodx
