// `selftest`: does the fit recover a known truth on the user's own input, and are its errors honest?
//
// A twin experiment: true parameters are drawn about the table's, the model is driven by the log's input, noise and
// steps of each channel's size are laid on, and the fit starts from the table without knowing the truth. Repeated, it
// gives the bias of every parameter and the share of 95 % intervals that hold the truth. The model that makes the data
// is the one that is fitted: this tests input, identifiability and estimator, not whether the model is true of a rig.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/watch.h"

namespace servodx {

struct SelftestOptions {
  int repeats = 20;
  double spread = 0.05;  // [of a row's interval] standard deviation of the truth about the table's value
  std::uint64_t seed = 1;
  int threads = 0;   // 0: all cores; the result does not depend on it
  Watch watch = {};  // stopped: of the repeats done so far

  // Throws InputError that names the option, as the program calls it.
  void validate() const;
};

struct SelftestRow {
  std::string name = {}, unit = {};
  double nominal = 0;      // [unit]
  double bias = 0;         // [unit] mean of estimate less truth
  double rms = 0;          // [unit] of estimate less truth
  double std_error = 0;    // [unit] root mean square of what the fit says of itself
  double bias_sigmas = 0;  // bias over its own standard error: beyond 3 it is real
  int covered = 0,
      counted = 0;  // 95 % intervals that hold the truth; repeats in which the row stood at a bound say none
};

struct SelftestResult {
  std::string log;
  std::vector<SelftestRow> rows;
  std::vector<std::string> held;  // rows that this log cannot tell: at the table's value in truth and fit alike
  int repeats = 0, failed = 0;
  long covered = 0, counted = 0;                  // all rows together
  double coverage_lower = 0, coverage_upper = 0;  // 95 % interval of the share, repeats taken as independent
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;
};

// Throws InputError where the log cannot be fitted, or an option is out of range.
SelftestResult selftest(const Log& log, const Table& table, const Rig& rig, const SelftestOptions& options = {});

}  // namespace servodx
