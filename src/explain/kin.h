// Which healthy logs speak of a suspect: like with like, where there is like.
//
// How sizes and misfits scatter from test to test is seen on logs of different tests only. Repeats of one test say how
// that test scatters, and of another test they say as much as one log. Where the model follows tests like the
// suspects', a log that it does not follow says how much a cause removes of its own kind, and of theirs nothing. So
// does one whose fit takes all the air that it may, where theirs finds theirs: something else makes it soft.
#pragma once
#include <vector>

#include "evidence/conditions.h"
#include "explain/healthy.h"

namespace servodx {

bool takes_all_air(const HealthyLog& log);

// The same logs, with those marked that set no share beside these suspects. Where a suspect's test is one that no
// healthy log shows to be followed, the suspect may not be followed either: then not being followed marks none.
// `all_air`: a suspect's own fit takes all the air that it may; then that marks none.
HealthyReference shares_marked(const HealthyReference& all, const std::vector<TestConditions>& suspects, bool all_air);

struct SpeakingLogs {
  HealthyReference logs;
  bool alike = true;  // some are of the suspects' test
};

// Those of the suspects' test alone where they are enough to know their scatter; else they and one log of every other
// test. All, where the reference does not say what its tests are.
SpeakingLogs logs_that_speak(const HealthyReference& all, const std::vector<TestConditions>& suspects);

}  // namespace servodx
