// The search for the pieces of a test: what each would add, alone; then the whole, piece by piece.
//
//   library   every shape at every amplitude and rate is played alone; Gram matrices add up, so the best set of pieces
//             is chosen without a further simulation, one after the other and then each anew
//   whole     the chosen pieces are played as one test, in some orders
//   exchange  in each round every piece is made larger, smaller, faster, slower, put behind its neighbour or drawn
//             anew; the best change is kept, or the best of every place together
#pragma once
#include <cstdint>
#include <vector>

#include "plan/goal.h"
#include "plan/lanes.h"
#include "plan/segments.h"
#include "plan/test_bench.h"
#include "servodx/plan.h"
#include "servodx/watch.h"

namespace servodx {

struct SearchWishes {
  GoalKind kind = GoalKind::find;
  PlanLimits limits = {};  // every one that holds is set
  int rounds = 6;
  std::uint64_t seed = 1;
  int threads = 0;
  Watch watch = {};
};

struct FoundTest {
  std::vector<Segment> segments;
  TestRun run;
  double worth = 0;
  bool interrupted = false;
};

bool within(const PlannedTest::Extremes& extremes, const PlanLimits& limits);

// Throws InputError where a valve at rest passes a limit already.
FoundTest search(TestBench& bench, const LaneSet& set, const Timing& timing, const SearchWishes& wishes);
// Pieces drawn blindly, made smaller until the limits are kept.
FoundTest random_test(TestBench& bench, const LaneSet& set, const Timing& timing, const SearchWishes& wishes);

}  // namespace servodx
