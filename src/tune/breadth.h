// The genetic search of a tune: over the shared values, the nuisances held, on the first seconds of each log.
#pragma once
#include <vector>

#include "optimise/unit_cube.h"
#include "tune/scope.h"
#include "tune/watch.h"

namespace servodx {

// The best distinct points, best first, of the scope's whole problem. `start` is one of them.
std::vector<Point> search_broadly(const TuneScope& scope, const Point& start, TuneWatch& watch);

}  // namespace servodx
