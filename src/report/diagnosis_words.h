// What text and page of a diagnosis say in the same words.
#pragma once
#include <string>
#include <vector>

#include "diagnose/diagnose.h"

namespace servodx::report {

// "p = 0.03", or, where no log of the baseline is as far off, "p = 0.1, the least that 9 logs can show".
std::string chance_words(const Diagnosis& d);

// "18.6 times the tuned friction (10.3 to 33.4, 95 %)". At the mildest that is called the fault the fit has found none
// of it: as a hypothesis beside others "none of it seen"; named all the same, "at its least, 15 % ...".
std::string size_words(const HypothesisResult& hypothesis);
std::string size_words(const Diagnosis& d);  // of the fault named; "" without a size

// "drive spans 43.1 mA at about 5.6 Hz, oil 41 degC"
std::string test_words(const TestConditions& test);
// Empty where a log of the baseline is of such a test.
std::string unlike_words(const Diagnosis& d);

// The rows that the fault moved; those of health's own, each farthest first.
struct MovedParts {
  std::vector<MovedRow> fault, health;
};
MovedParts moved_parts(const Diagnosis& d);

}  // namespace servodx::report
