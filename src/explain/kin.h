// Which healthy logs speak of a suspect: like with like, where there is like.
//
// How sizes and misfits scatter from test to test is seen on logs of different tests only. Repeats of one test say how
// that test scatters, and of another test they say as much as one log.
#pragma once
#include <vector>

#include "evidence/conditions.h"
#include "explain/healthy.h"

namespace servodx {

struct SpeakingLogs {
  HealthyReference logs;
  bool alike = true;  // some are of the suspects' test
};

// Those of the suspects' test alone where they are enough to know their scatter; else they and one log of every other
// test. All, where the reference does not say what its tests are.
SpeakingLogs logs_that_speak(const HealthyReference& all, const std::vector<TestConditions>& suspects);

}  // namespace servodx
