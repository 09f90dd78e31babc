// A fault: a name, the rows that it moves, and one number, its severity, that is at `healthy` when it is absent.
#pragma once
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "effects/registry.h"
#include "faults/gross_finding.h"
#include "faults/record.h"
#include "servodx/maintenance.h"

namespace servodx {

// A finding that names the fault without a fit. The severity then lies between `worst` and `mildest`, or the fit's own
// bound where that is milder.
struct SeenOutright {
  GrossFinding finding = GrossFinding::none;
  double mildest = 0;  // severity
};

// How a fault of one size may look: a further number. It is free wherever the severity is, within its tolerance too:
// what a healthy valve may look like is no evidence of a fault.
struct FaultShape {
  std::string_view name;  // what the number is
  double lower, upper;
  double start;      // where a search begins, and what is likely
  double in_health;  // the same within the fault's tolerance
  // Moves the rows of a candidate that has the severity, and the shapes stated before this one.
  void (*apply)(double* candidate, double shape);
};

// What wears along with a fault that grows: a further number, from nought, that is free where the wear is tracked. It
// acts on nothing in health, so that the first checks of a valve tell as much as without it.
struct WornAlong {
  std::string_view name;  // what the number is
  double likely, most;    // about which it is sought, and up to where
  // Moves the rows of a candidate that has the severity; `healthy`: the candidate without it.
  void (*apply)(double* candidate, const double* healthy, double share);
};

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
  std::string_view action;     // begins with its class (servodx/actions.h): "critical: stop the machine"
  // Moves the rows of a candidate (SI) to the severity.
  void (*apply)(double* candidate, double severity);
  // Where a valve that wears so has failed, unless its user says another level. A fault with one grows with use:
  // `check` tracks it, `trend` predicts it.
  std::optional<double> failed = {};
  bool part_lost = false;  // the severity is a part lost, and what is left of it acts
  // Its worst is the whole of it, and common: a part that broke, a passage that is shut. A size that stands at another
  // end of a search stands there because something else pulls.
  bool ends_whole = false;
  std::optional<SeenOutright> seen_outright = {};
  // A row that health lets wander up to a limit of the rig file. The fault is that row beyond the limit: it begins
  // there, not at `least`, and has no tolerance of its own.
  std::optional<int> beyond_limit_of = {};
  // Maintenance that renews the part, beside what renews the whole valve.
  std::optional<EventKind> renewed_by = {};
  // Told by a record without the model. An input's fault (supply, driver) is fitted only where its record is missing,
  // since the record drives the simulation.
  std::optional<Record> told_by = {};
  std::vector<FaultShape> shapes = {};
  std::optional<WornAlong> along = {};
  // The row that a size is counted in, where drawings state it too: a size is as sure as the healthy row is.
  std::optional<int> counted_in = {};
  // Stated at 40 degC: the log shows it at its own oil, and the law between the two is assumed.
  bool stated_at_40_degrees = false;
  // Where sizes grow with the valve: how many times those stated here they are on the valve of a candidate. sizes.h
  double (*times)(const double* candidate) = nullptr;
  // What looks alike: the two are named together, but where the other has a record of its own and the log holds it.
  const Fault* twin = nullptr;
};

// A part of the way from one severity to another, on the fault's own scale.
inline double severity_between(const Fault& fault, double from, double to, double part) {
  return fault.log_scale ? from * std::pow(to / from, part) : from + part * (to - from);
}

// How far a severity is from health, on the fault's own scale. NaN: the scale does not hold it.
inline double way_from_health(const Fault& fault, double severity) {
  return std::abs(fault.log_scale ? std::log(severity / fault.healthy) : severity - fault.healthy);
}

inline bool are_twins(const Fault& a, const Fault& b) { return a.twin == &b || b.twin == &a; }

}  // namespace servodx
