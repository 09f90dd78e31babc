// What the engine of `explain` needs of a model and its data. It knows no hydraulics: a valve, a motor-driven slide or
// anything else with named places and parameters serves.
//
// A subject states what is free in every fit (its base), the causes that might be missing, each at a named place with a
// few numbers that are off where it is absent, and the misfit as least squares over the unit cube of base and causes.
#pragma once
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/stages.h"
#include "fit/fit_work.h"
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"
#include "parameters/coordinate.h"

namespace servodx {

// A free number, as it enters a fit.
struct Number : Coordinate {
  double off = 0;    // [unit] where the model is the base model
  bool size = true;  // false: shapes a cause that another number switches
};

// A physical cause, or a fault of a sensor or a clock.
struct Cause {
  std::string effect;  // the name that is reported
  std::string where;   // its place in the model
  std::string test;    // the input that shows it best
  double prior = 1.0;  // how common beside the others, before any data
  std::vector<Number> numbers;
  // Sizes at which the score test looks: alternatives, each of one or more points that are tried together (the cosine
  // and the sine of one frequency). A point holds a value for each number. [unit]
  std::vector<std::vector<std::vector<double>>> probes;
  std::string family = "";  // tells apart causes of one name and place: the variable of a learnt curve
  bool curve = false;       // its numbers are a curve's knots: judged by what they gain together
  bool simulated = false;   // of what a block's own balance ties to it: with measured signals it would explain itself
  // What is likely of its numbers before any data: each row, a weight a number [1/unit] times how far it is from off,
  // sums to zero give or take one.
  std::vector<std::vector<double>> ties = {};
  // Name of the base's numbers that it goes on where they end, a factor on them: its size is then what they are in all.
  std::string atop = "";
  // A sensor's cause: the channel that it shows in, and no other. Empty: a cause of the valve.
  std::string of_channel = "";
  // Of a cause that shows in several places, that of each number: the surest one's is reported. Empty: all at `where`.
  std::vector<std::string> places = {};
};

// Rarer than a named effect before any data: a row that was held for a reason, or a part of the construction.
inline bool is_rare(double prior) { return prior < 1; }
inline bool is_rare(const Cause& cause) { return is_rare(cause.prior); }

inline bool is_of_sensor(const Cause& cause) { return !cause.of_channel.empty(); }

// Rows of the residual that belong to one channel of one log, in order of time.
struct Series {
  std::string signal, unit;
  int log = 0;
  long first = 0, count = 0;
  const std::vector<double>* time = nullptr;   // [s]
  const std::vector<double>* sigma = nullptr;  // [unit] size of the residual that a row counts as one
  double noise = 0;                            // [unit] rms of the sensor
  double effective = 1.0;                      // fraction of the samples that count as independent
  double usual = 1.0;  // mean square of its rows, per independent sample, where nothing new is wrong
};

// One fit: the base's free numbers first, then those of the causes asked for.
struct SubjectFit {
  std::vector<Number> numbers;
  Point start;  // causes at their off value
  LeastSquaresProblem problem;
  std::shared_ptr<FitWork> work = std::make_shared<FitWork>();  // that the problem has cost; none where nothing is run
};

// How much one part of a replay misses: a block of the model (explain/blocks.h), or a channel against its usual error.
struct Miss {
  std::string part;
  double size = 0;
};

class Subject {
 public:
  virtual ~Subject() = default;
  virtual const std::vector<Cause>& causes() const = 0;
  virtual const std::vector<Series>& series() const = 0;
  // `wide`: the base's numbers let go much further than what is known of them: re-tuning. The base's numbers begin
  // alike.
  virtual SubjectFit fit(const std::vector<int>& causes, bool wide) const = 0;
  virtual bool retunes() const { return false; }  // `wide` makes a difference
  // Healthy data say that the base holds: re-tuning is reported beside a cause, and no reason to refuse it.
  virtual bool holds() const { return false; }
  // Sets the weights from the residual of re-tuning alone, channel by channel: its size and its memory. False: the
  // subject keeps its weights.
  virtual bool rescale(const Eigen::VectorXd& residual) {
    (void)residual;
    return false;
  }
  // ln of the oil's viscosity over the reference, mean of the logs: sizes on healthy logs may follow it. NaN: not
  // known.
  virtual double thickness() const { return std::nan(""); }
  // What a cause's size at its k-th alternative may be off by, beyond what the fit's curvature says. [of the probe]
  virtual double error_beside(int cause, std::size_t k) const {
    (void)cause, (void)k;
    return 0;
  }
  // The residual behind the rows of a fit, in its own units.
  virtual Eigen::VectorXd physical(const Eigen::VectorXd& rows) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(rows.size());
    for (const Series& s : series())
      for (long k = 0; k < s.count; ++k) out[s.first + k] = rows[s.first + k] * (*s.sigma)[static_cast<std::size_t>(k)];
    return out;
  }
  virtual long simulations() const { return 0; }
  virtual long failed_simulations() const { return 0; }
  // Fits that share nothing go side by side over so many (0: all), in the same packs. No fit may be made or run beside
  // what changes the subject.
  virtual int threads() const { return 1; }

  Stages stages;  // that a checkpoint keeps, of this subject; none unless set
};

}  // namespace servodx
