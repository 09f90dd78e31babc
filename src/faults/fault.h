// A fault: a name, the rows that it moves, and one number, its severity, that is at `healthy` when it is absent.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "effects/registry.h"

namespace servodx {

struct Fault {
  std::string_view name;  // label of the verdict
  std::string_view meaning;
  std::string_view unit;  // of the severity
  double healthy;         // severity at which nothing moves
  double worst;           // end of the range that is searched
  bool log_scale;         // severity searched in log
  double prior = 1.0;     // how common it is beside the others, before any data
  double least;           // the mildest severity that is called a fault; nearer to healthy is wear in tolerance
  double spread;          // what the model's form leaves open of a size, one standard deviation: of ln(severity) where
                          // the scale is log, else of the severity; enters every interval
  std::vector<double> starts;  // failure mode identifiers: severities from which a search begins
  std::string_view test;       // input that shows this fault best, for "what would separate these"
  std::string_view action;     // critical: stop the machine; abnormal: call service; abuse: change mode (GA paper)
  // Moves the rows of a candidate (SI) to the severity.
  void (*apply)(double* candidate, double severity);
  // Where a valve that wears so has failed, unless its user says another level. A fault with one grows with use:
  // `check` tracks it, `trend` predicts it.
  std::optional<double> failed = {};
  bool part_lost = false;  // the severity is a part lost, and what is left of it acts
};

}  // namespace servodx
