// The end of a tune: what each row is known to, and what the table says of it.
#pragma once
#include <optional>
#include <vector>

#include "fit/problem.h"
#include "fit/recorder.h"
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"
#include "parameters/table.h"
#include "servodx/note.h"
#include "servodx/tune.h"
#include "tune/scope.h"
#include "tune/screen.h"
#include "tune/tune.h"
#include "tune/watch.h"

namespace servodx {

struct Settled {
  Point point;  // of the same or a lower cost than the end of the search
  Table table;  // with estimates and their errors
  std::vector<ParameterResult> parameters;
  std::vector<Note> notes;                    // of profiles that were asked for
  std::optional<CommandSlope> command_slope;  // of the recorder
};
// `end`: of the last fit, its residual weighed by the error model that was learnt there.
Settled settle(const TuneScope& scope, const std::vector<ScreenedRow>& screened, const FitProblem& problem,
               const LeastSquaresResult& end, const TuneWatch& watch);

}  // namespace servodx
