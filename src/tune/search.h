// Breadth, then depth: a genetic search over the shared values, and the local stage from its best distinct points and
// from the table's own.
#pragma once
#include <cstddef>
#include <vector>

#include "fit/error_model.h"
#include "fit/problem.h"
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"
#include "simulate/scenario.h"
#include "tune/constants.h"
#include "tune/scope.h"
#include "tune/tune.h"
#include "tune/watch.h"

namespace servodx {

// Where a local search begins: at the table's values, at a point that the genetic search found, or where one ended.
enum class Start { nominal, found, ended };

// On trial: where they prove false (optimise/local.h), NLopt goes on without them.
enum class Derivatives { trusted, on_trial };

LeastSquaresResult search_locally(const FitProblem& problem, const Point& from, Stage stage, int iterations,
                                  Start start, Share share, TuneWatch& watch,
                                  Derivatives derivatives = Derivatives::trusted);

// Whether a start that ended so is in the valley whose end costs `best`: within 5 % of it, or promised to be by its own
// derivatives.
bool in_best_valley(const LeastSquaresResult& end, double best);

// Where a start ended, and how far from what is held out.
struct Ended {
  StartEnd start;
  Point point;
  double heldout = 0;  // over the noise; infinite: nothing is held out
};
// Ends of the local stage on what is seen of each log.
struct SearchEnds {
  std::vector<Ended> ends;  // from the table's values first
  std::size_t best = 0;     // by its cost
  LeastSquaresResult end;   // of the best
};
// `seen`: without the part of each log that is held out. `whole`: on whole logs, to say how well that part is met.
SearchEnds search_ends(const TuneScope& seen, const FitProblem& whole, TuneWatch& watch);

// A fit of what is seen of each log, by weights that are learnt where it began.
struct SeenFit {
  LeastSquaresResult end;
  ErrorModel error;
  std::vector<Trajectory> whole;  // of whole logs, at the end
  double heldout = 0;             // over the noise; infinite: nothing is held out
};
// Goes on from the start that ended best by its cost, and from the one that ended nearest to what is held out: a
// start's weights rest on where it began, and its cost tells valleys apart no better than they do. Another start is
// tried as well where it ended nearer to that part than these fits. Of all, the nearest is kept; then the weights are
// learnt anew where it ended, while it comes nearer still.
SeenFit refine_best(const SearchEnds& searched, FitProblem& seen, const FitProblem& whole, bool on_stand,
                    TuneWatch& watch);
// Alternates fit and error model on whole logs until the weights settle.
LeastSquaresResult refine_whole(FitProblem& problem, const Point& from, ErrorModel& error, int rounds, bool on_stand,
                                Share share, TuneWatch& watch);

}  // namespace servodx
