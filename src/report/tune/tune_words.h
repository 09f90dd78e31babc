// Is a tune good enough to diagnose with? Said in one line, from what the tune and its logs know.
//
// Five questions. Does the model follow the logs: where a channel is left far beyond its noise (tune/summary.h) the
// answer is no, and where it is left yet further the data sheet is another rig's. Does it predict what
// it was not fitted to: of the median log the error on the held-out part against the fitted error, at most twice, as a
// diagnosis lets a hypothesis leave twice the usual error and no more (judge); single logs that are predicted worse are
// named, for they have no like among the others. Does it keep to the data sheet: a stated size at the end of its range
// does duty for something else. Did the search arrive: its end, and a second start in the same valley.
// And would a fault be seen: each at its typical size on the log of these that shows it best, against the errors that
// the table now says its model makes (check-log's deviates; below 3 it stays hidden).
#pragma once
#include <string>
#include <vector>

#include "diagnose/judge.h"
#include "fit/tuned_state.h"
#include "report/shared/json.h"
#include "servodx/check_log.h"
#include "tune/tune.h"

namespace servodx::report {

enum class Trust { yes, with_care, no };
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
// What each method of the last fit has gained, and the genetic search: one line.
std::string gains_in_words(const TuneResult& result);

// Which effects stay free and which are off, each with what it gains on the held-out part: one line, or nothing.
std::string effects_in_words(const std::vector<EarnedEffect>& effects);

// `promises`: of the logs with the tuned table; without any nothing is said of faults.
// "pressure A is left with 11 times its noise, ..."
std::string unfollowed_in_words(const std::vector<Unfollowed>& channels);
// `likeliest`: what explain puts first, where the model does not follow; null: not asked.
GoodEnough good_enough(const TuneResult& result, const std::vector<Promise>& promises,
                       const BeyondFaults* likeliest = nullptr);
std::vector<std::string> praise_of(const GoodEnough& g);  // of a 'yes', part by part; else empty
std::string line_of(const GoodEnough& g);                 // "yes: ...", "with care: ..." or "no: ..."
Json to_json(const GoodEnough& g);

}  // namespace servodx::report
