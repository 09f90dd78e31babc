// What test a log is of, in four numbers: how far, how hard and how fast it drives the valve, how warm the oil is.
//
// A baseline promises its rate of false alarms for logs like its own. Tests of one programme differ from run to run by
// less than a factor of two in amplitude, of four in speed (a random sequence, a step beside a multisine) and by some
// kelvin; beyond that the model's error may be another, and the threshold is none.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "signals/log.h"

namespace servodx {

struct TestConditions {
  double drive_span = 0;              // [A] greatest less least
  double drive_band = 0;              // [Hz] of the sine that changes as fast as the drive
  std::optional<double> temperature;  // [K] mean
  double drive_rms = 0;               // [A] about its mean; 0: files of earlier versions do not say it
};

TestConditions conditions_of(const Log& log);

// How far apart two tests are: at most 1 where they are alike. A temperature that one log does not hold is no
// difference.
double distance(const TestConditions& a, const TestConditions& b);

// In what they are farther apart than tests that are alike.
struct Apart {
  bool span = false, band = false;
  double oil = 0;  // [K] 0: alike
};
Apart apart(const TestConditions& a, const TestConditions& b);

// Whether one is a repeat of the other: the same programme run again, or as good as that. Two programmes of one span
// and speed that spend their time at other openings are none. False where either does not say its rms.
bool is_repeat(const TestConditions& a, const TestConditions& b);

// Which programme each log is of, whatever its oil: numbers from 0 in the order of their first logs.
std::vector<std::size_t> programmes_of(const std::vector<TestConditions>& logs);
// Whether they are of enough programmes to show how the model's error changes from test to test.
bool show_scatter_of_tests(const std::vector<TestConditions>& logs);

}  // namespace servodx
