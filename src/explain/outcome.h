// How an explanation ends, as a whole and for each candidate. The words for these stand in report/explain_words.h.
#pragma once

namespace servodx {

enum class ExplainVerdict {
  sufficient,   // nothing is wrong that healthy logs do not show or that a cause would mend
  extended,     // causes with a name were taken
  unexplained,  // something is wrong, and no name suffices
};

// What became of a candidate.
enum class Fate {
  not_looked_at,
  score_too_small,        // its score predicts too little to fit it
  not_worth_its_numbers,  // BIC
  others_fit_better,      // fitted; not among those that are judged on held-out data
  abnormal_with_it,       // no news by itself, and with it the data stay unlike healthy ones
  retuning_does_as_well,  // on held-out data
  no_heldout_gain,        // beyond its interval
  removes_too_little,     // too small a share to be an answer, and no healthy data to compare with
  not_beyond_healthy,     // helps, and healthy logs show it too
  not_missed_later,       // taken, and left out again once others were in
  curve_does_better,      // taken, and replaced by a curve without a name
  blocks_tell_another,    // taken, and replaced by what the replay of the blocks tells
  taken,
  taken_by_blocks,  // told by the replay of the blocks
};
constexpr bool is_taken(Fate fate) { return fate == Fate::taken || fate == Fate::taken_by_blocks; }

// What shows a cause.
enum class ToldBy {
  simulation,
  blocks,    // the blocks' replay, where the free run settles nothing: gain and BIC are of that
  currents,  // command and coil current beside each other, ahead of the simulation: the same
};

// What the logs tell of a size.
enum class SizeTold {
  interval,
  at_bound,  // it stands at an end of where it may be, and curvature says nothing of how well it is known
  not_told,  // any size that may be is as likely
};

}  // namespace servodx
