// How large a share of its held-out misfit a cause removes from healthy logs of other valves, on the mean.
//
// Some causes take a little of what any model has wrong, as the gain of a sensor, a line and a lap do; others take
// nothing of it, as a line of the mains' frequency. A rig's few healthy logs tell the two kinds badly, those of several
// rigs better. The figures are in usual_excess.csv, which `bench/foreign/usual_excess` makes of the rigs' baselines: a
// mean over the logs and over ten of the mean of all effects, so that what no log has shown is not nought.
#pragma once
#include <string>

namespace servodx {

// Mean of -ln(1 - share) of the effect over healthy logs of other valves [-]; of one that was not counted there, that
// of all effects.
double usual_excess(const std::string& effect);

}  // namespace servodx
