// The frequency of a drive is that of a sine, where the drive is one, whatever its rate and length.
#include "evidence/conditions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"
#include "base/two_pi.h"
#include "servodx/log.h"

namespace servodx {
namespace {

// A command that is a sine about an offset. [Hz] [s] [1/s] [rad]
Log sine(double frequency, double seconds, double rate, double phase = 0) {
  Log log;
  for (int k = 0; k < static_cast<int>(seconds * rate); ++k) {
    log.time.push_back(k / rate);
    log.channels[index(Signal::command)].value.push_back(0.001 +
                                                         0.004 * std::sin(two_pi * frequency * k / rate + phase));
  }
  return log;
}

TEST(DriveBand, OfASineIsItsFrequencyAtAnyRateAndLength) {
  int seen = 0;
  for (const double rate : {200.0, 1000.0, 5000.0})
    for (const double frequency : {0.5, 1.0, 3.0, 7.0, 20.0, 60.0, 90.0, 300.0})
      for (const double periods : {4.1, 10.0, 23.7}) {
        const double samples = periods * rate / frequency;
        if (frequency > 0.4 * rate || samples < 50 || samples > 2e5) continue;
        for (const double phase : {0.0, 0.7, 1.6, 2.5}) {
          const double read = conditions_of(sine(frequency, periods / frequency, rate, phase)).drive_band;
          EXPECT_NEAR(read / frequency, 1, 0.03) << frequency << " Hz, " << periods << " periods, " << rate << " 1/s";
          ++seen;
        }
      }
  EXPECT_GT(seen, 200);
}

// A part of a period that is left over weighs in the variance: two periods and a bit are told to a tenth.
TEST(DriveBand, OfFewPeriodsIsToldToATenth) {
  for (const double periods : {2.0, 2.3, 2.7})
    for (const double phase : {0.0, 0.7, 1.6, 2.5})
      EXPECT_NEAR(conditions_of(sine(1, periods, 500, phase)).drive_band, 1, 0.1) << periods << " periods";
}

TEST(DriveBand, SamplesThatAreMissingChangeNothing) {
  Log log = sine(7, 3, 1000);
  Random random(3);
  for (double& v : log.channels[index(Signal::command)].value)
    if (random.uniform() < 0.2) v = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(conditions_of(log).drive_band, 7, 0.2);
}

TEST(DriveBand, ADriveThatStandsStillHasNone) {
  Log log = sine(0, 3, 1000);
  EXPECT_EQ(conditions_of(log).drive_band, 0);
  EXPECT_EQ(conditions_of(sine(7, 0.005, 1000)).drive_band, 0) << "too few samples";
}

}  // namespace
}  // namespace servodx
