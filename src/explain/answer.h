// What was found, as it grows from step to step: names in the free run, a curve where these fail, and what the replay
// of the blocks tells where both leave it open.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "explain/block_replay.h"
#include "explain/cause_score.h"
#include "explain/drive.h"
#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/inquiry.h"
#include "explain/learnt_curves.h"
#include "explain/subject.h"

namespace servodx {

struct Answer {
  FoundCauses found;
  std::vector<CauseScore> curve_scores;   // empty: no curve was looked at
  std::optional<LearntCurve> curve;       // it stands in `found.causes` too
  std::string better_place;               // of a curve: where a refused name does better than it; empty: nowhere
  std::unique_ptr<ReplaySubject> blocks;  // null: not asked
  bool told_by_blocks = false;            // `found.causes` were told there, and are held in the free run
  std::unique_ptr<DriveSubject> drive;    // null: the logs have not both command and coil current
  FoundCauses of_drive;                   // told between these two

  // The first cause is a row or, beside healthy logs, a part of the construction: such takes on what the list lacks.
  bool first_is_rare(const Inquiry& inquiry) const {
    return !found.causes.empty() && is_rare(inquiry.cause(found.causes.front().cause));
  }
};

// Held-out share that the first cause removes by itself.
double share_of_first(const Inquiry& inquiry, const FoundCauses& found);
// The fit with the first of several causes alone, judged on held-out data.
ExplainedFit first_alone(const Inquiry& inquiry, const FoundCauses& found);
// Whether the causes leave the logs as healthy ones are left. False without healthy logs.
bool left_like_healthy(const Inquiry& inquiry, const FoundCauses& found);
// Chance that healthy logs are left with as much as by what was found.
double chance_left(const Inquiry& inquiry, const FoundCauses& found);
// Left abnormal by names of which the first removes less than half of it: most of what is wrong has no name, and a heap
// of names is none. False without healthy logs.
bool is_nameless(const Inquiry& inquiry, const FoundCauses& found);

// Names in the free run.
Answer find_names(Inquiry& inquiry);
// A name has to leave the logs as healthy ones are left, or to do as well as a curve, which has none. A rare cause
// has to do better than a curve beyond the interval.
void try_curves(Inquiry& inquiry, Answer& answer);
// What the free run leaves open, the replay of the blocks may tell: a name that is news there, is worth its numbers on
// held-out windows, and leaves the blocks as healthy logs do. Where the free run has a name and others as good, it has
// to be about one of these.
void ask_blocks(Inquiry& inquiry, Answer& answer);
// Where the coil current is measured it drives the simulation, which then knows nothing of what the driver does. It is
// asked by itself, beside the healthy logs.
void ask_drive(Inquiry& inquiry, Answer& answer);

}  // namespace servodx
