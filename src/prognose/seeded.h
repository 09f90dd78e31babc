// What a seeded-fault test taught: how valves of a type read wear of known size, in oil of known temperature.
//
// A model's form leaves some of what it reads to the oil and to how much has worn: laps close the null as a clearance
// opens it, and a clearance of three times the healthy one reads half of itself in thick oil. Nothing in a valve's own
// history tells that from a wear that began late. Valves with parts of measured wear do: what a check reads is taken to
// the wear at which they read the same, in oil of the same viscosity.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "prognose/check_name.h"

namespace servodx {

// ln of an oil's viscosity over that at 40 degC, of 14 mm2/s there: as a regressor what matters is its course.
double log_viscosity(double kelvin);

struct SeededReading {
  CheckName check;
  std::string valve;
  double truth = 0, reading = 0;  // [unit of the check]
  double log_viscosity = 0;       // over that at 40 degC
};

struct SeededTest {
  std::vector<SeededReading> readings;
};

// Of one check, in the coordinate of its growth. Between sizes and viscosities that were tried it is linear; beyond the
// sizes it goes on as at the nearest, beyond the viscosities it stays.
class ReadingCurve {
 public:
  ReadingCurve() = default;
  // Throws std::invalid_argument where the readings do not rise with the wear, or have fewer than two sizes.
  // `origin`: what the oil acts on begins there; of a drop all of it, else what has grown.
  ReadingCurve(const std::vector<SeededReading>& readings, std::optional<double> origin);
  bool empty() const { return sizes_.empty(); }
  struct Worn {
    double truth = 0, per_reading = 1;
    double error = 0;  // of one reading: what no base, size and tilt of a valve explain there
  };
  Worn at(double reading, double log_viscosity) const;
  // How far another valve's wear lies from what it reads as, one standard deviation: what valves of the test differ by
  // at this size, over their oils, with Student's factor for so few at 90 % and the error of their own mean.
  double spread(double truth) const;
  // What valves of the test differ by in how they read a growth: in its size, and in what the oil changes of it per
  // unit of log viscosity and of its square; parts of it, one standard deviation. None where fewer than three valves or
  // oils were tried.
  struct Differing {
    double size = 0, tilt = 0;
  };
  const std::optional<Differing>& differing() const { return differing_; }

 private:
  // A reading of the test: how far it is off, and where.
  struct Off {
    std::string valve;
    std::size_t oil, size;  // positions among viscosities and sizes
    double truth, log_viscosity, by;
  };
  void learn_readings(const std::vector<SeededReading>& readings);
  std::vector<Off> offs_of(const std::vector<SeededReading>& readings) const;
  void learn_spreads(const std::vector<Off>& offs);
  void learn_errors(const std::vector<Off>& offs, double origin);
  std::vector<double> sizes_, viscosities_;    // rising
  std::vector<std::vector<double>> readings_;  // of each viscosity, by sizes
  std::vector<std::vector<double>> errors_;    // of each reading, see Worn
  std::vector<double> spreads_;                // of each size
  std::optional<Differing> differing_;
};

}  // namespace servodx
