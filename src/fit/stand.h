// A valve on a test stand with free ports, as the model has it: a step of the current, or sines, and what the spool
// answers. The base of what a data sheet states (fit/sheet.h) and of a valve's Bode plot (fit/bode.h).
//
// Oil at 40 degC, where a table's values hold. Limits: the current is the command (no dither); the output is the spool,
// whose flow without load follows it.
#pragma once
#include <complex>
#include <cstddef>
#include <vector>

#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {

// A test at the stand, and what it was made for: a step, or a sine of one frequency and amplitude.
struct StandTest {
  Scenario scenario;
  double frequency = 0;   // [Hz] of the sine; 0: a step
  std::size_t first = 0;  // sample of the step, or where a sine is read from
};

// `rated` [A]; `amplitude` a fraction of it; `stated` [s] the rise time that the step is laid out for.
StandTest step_test(const RigFile& rig, double rated, double amplitude, double stated);
// As many cycles to settle as to read.
StandTest sine_test(const RigFile& rig, double rated, double amplitude, double frequency, int cycles);
// Cycles after which a sine of this frequency has settled.
int settling_cycles(double frequency);

// Of each test (rows) and candidate (columns): the spool [m]; empty where it left finite numbers.
std::vector<std::vector<std::vector<double>>> spools(const std::vector<StandTest>& tests,
                                                     const std::vector<ParameterVector>& candidates);

// First harmonic of the spool over that of the current, [m/A]. Phase negative where it lags.
std::complex<double> response(const StandTest& test, const std::vector<double>& spool);

double rated_current(const RigFile& rig, const ParameterVector& candidate);  // [A]

}  // namespace servodx
