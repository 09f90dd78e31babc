// The misfit of the model to logs as a function of numbers in the unit cube: for optimisers of your own.
//
// residual = (measured - simulated) / sigma, channel by channel and log by log, filtered as a tune filters it, then the
// priors. 0.5 |residual|^2 is what a tune lowers. Free are the table's rows with `estimate` and each log's own numbers
// (null, air, offsets of sensors, where it starts).
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/watch.h"

namespace servodx {

struct ObjectiveOptions {
  // Effects freed beside the table's rows; empty: what a tune frees unless told. A tuned table has its own.
  std::optional<std::vector<std::string>> effects = {};
  int threads = 0;  // 0: all cores; the result does not depend on it

  // Throws InputError that names the option.
  void validate() const;
};

// One thread at a time; copies are the same objective.
class Objective {
 public:
  // A number that is free: value = lower + u (upper - lower), or lower (upper / lower)^u where it is logarithmic.
  struct Number {
    std::string name, unit;
    double lower = 0, upper = 1;  // [unit]
    bool log_scale = false;
    double start = 0;                                           // [unit]
    double prior_sd = std::numeric_limits<double>::infinity();  // [of the unit interval] about the start
    int log = -1;                                               // whose own it is; -1: shared by all logs
  };
  // Entries of the residual that belong to a channel of a log; what follows the last of them are the priors.
  struct Part {
    std::string log;
    Signal signal = Signal::time;
    std::size_t first = 0, count = 0;
  };
  struct Jacobian {
    std::vector<double> values;  // [residual, number] row by row; empty: no run at the point
    int missing = 0;             // columns that could not be had, zero
  };
  enum class Method { least_squares, ceres, nlopt, whole };
  struct End {
    std::vector<double> point;  // of the unit cube
    double cost = 0;            // 0.5 |residual|^2
    long simulations = 0;       // that it took
    std::string stopped;        // why, in words
  };
  struct Budget {
    int iterations = 12;   // Jacobians of each local search
    int population = 50;   // of the genetic search, whole only
    int generations = 30;  // the same
    std::uint64_t seed = 1;
    Watch watch = {};

    // Throws InputError that names the option.
    void validate() const;
  };

  // Weights: of a tuned table its own error model, at its own values; else as a tune begins, by what the table's values
  // leave of each channel. They stay as they are. Throws InputError where logs or table cannot be used.
  Objective(const std::vector<Log>& logs, const Table& table, const Rig& rig, const ObjectiveOptions& options = {});

  const std::vector<Number>& numbers() const;
  const std::vector<Part>& parts() const;
  std::size_t size() const;  // entries of a residual
  std::vector<double> start() const;
  // Point whose shared numbers are another table's values, by the rig's facts, and whose others are the start's.
  std::vector<double> point_of(const Table& table) const;
  // The unit of each number in place of the unit interval, and back.
  std::vector<double> values_at(std::span<const double> point) const;
  std::vector<double> point_at(std::span<const double> values) const;

  // Of many points, one behind the other; NaN where a run leaves the finite numbers. One batch: lanes are nearly free.
  std::vector<double> residuals(std::span<const double> points) const;
  std::vector<double> costs(std::span<const double> points) const;
  // All columns in one batch: by forward differences over 1e-4 of the unit interval; from 25 columns of a log on by
  // followers of its run, to the same within the differences' own error.
  Jacobian jacobian(std::span<const double> point) const;
  // Ours on the same numbers: our bounded search and then Ceres; Ceres alone; BOBYQA; the genetic search and the first
  // of these from its best points and from the start.
  End minimise(Method method, std::span<const double> start, const Budget& budget) const;

  long simulations() const;  // so far, of all calls; a column of a Jacobian is one a log
  long failed_simulations() const;

 private:
  struct Inside;
  std::shared_ptr<const Inside> inside_;
};

}  // namespace servodx
