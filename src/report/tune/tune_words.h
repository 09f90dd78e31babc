// What a tune says of its search and its effects, and whether it is good enough (tune/trust.h): in one line.
#pragma once
#include <string>
#include <vector>

#include "diagnose/judge.h"
#include "fit/tuned_state.h"
#include "report/shared/json.h"
#include "servodx/check_log.h"
#include "servodx/note.h"
#include "tune/trust.h"
#include "tune/tune.h"

namespace servodx::report {

struct GoodEnough {
  Trust trust = Trust::yes;
  std::string errors;                   // "held-out error over noise: spool position 3.0, piston position 5.1"
  std::vector<std::string> reasons;     // why not, or not quite
  std::vector<std::string> exceptions;  // single logs that are predicted worse than fitted
  std::vector<std::string> hidden;      // faults that stay hidden at typical size on every log
  std::vector<std::string> faint;       // that show then, and hide at the mildest that is called the fault
  std::vector<Visible> best;            // of each fault, on the log that shows it best
};

// "genetic search", "start 1", "weights", "everything": as results call a stage.
std::string word_of(const Stage& stage);
// "genetic search" ... as a user reads it.
std::string words_of(StageMethod method);
// All that a tune notes, in the order in which it is told.
std::vector<Note> notes_of(const TuneResult& result);
// What each method of the last fit has gained, and the genetic search: one line.
std::string gains_in_words(const TuneResult& result);

// Which effects stay free and which are off, each with what it gains on the held-out part: one line, or nothing.
std::string effects_in_words(const std::vector<EarnedEffect>& effects);

// "pressure A is left with 11 times its noise, ..."
std::string unfollowed_in_words(const std::vector<Unfollowed>& channels);
// `promises`: of the logs with the tuned table; without any nothing is said of faults.
// `likeliest`: what explain puts first, where the model does not follow; null: not asked.
GoodEnough good_enough(const TuneResult& result, const std::vector<Promise>& promises,
                       const BeyondFaults* likeliest = nullptr);
std::vector<std::string> praise_of(const GoodEnough& g);  // of a 'yes', part by part; else empty
std::string line_of(const GoodEnough& g);                 // "yes: ...", "with care: ..." or "no: ..."
Json to_json(const GoodEnough& g);

}  // namespace servodx::report
