// Which healthy logs speak of a suspect: like with like, where there is like.
//
// How sizes and misfits scatter from test to test is seen on logs of different tests only. Repeats of one test say how
// that test scatters, and of another test they say as much as one log. A log that the model does not follow says what
// the model has wrong in tests like its own: of others it tells how sizes scatter, and not how much is wrong or can be
// removed. `diagnose` has the same rule (healthy_law.h).
#pragma once
#include <vector>

#include "evidence/conditions.h"
#include "explain/healthy.h"

namespace servodx {

// The same logs, with those marked as lost that the model does not follow and that are of no test like a suspect's.
// None, where the rest are of too few tests to show how misfits scatter.
HealthyReference with_lost_marked(const HealthyReference& all, const std::vector<TestConditions>& suspects);

struct SpeakingLogs {
  HealthyReference logs;
  bool alike = true;  // some are of the suspects' test
};

// Those of the suspects' test alone where they are enough to know their scatter; else they and one log of every other
// test. All, where the reference does not say what its tests are.
SpeakingLogs logs_that_speak(const HealthyReference& all, const std::vector<TestConditions>& suspects);

}  // namespace servodx
