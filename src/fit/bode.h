// Frequency response of valves beside each other: the spool against sines of the current on a test stand, by simulation
// (fit/stand.h). Shows in a customer's terms what a fault does to a valve.
//
// At two amplitudes, as makers draw it: small, where friction and backlash show, and catalogues' +-40 %, where the
// pilot stage's flow does. A describing function: harmonics are left out. Phase turns on from the lowest frequency.
#pragma once
#include <optional>
#include <vector>

#include "fit/replay.h"
#include "servodx/bode.h"
#include "servodx/rig.h"

namespace servodx {

// The first of `valves` is what the others are set beside.
std::vector<Bode> bode_of(const std::vector<Candidate>& valves, const RigFile& rig);

// Where a line falls by 3 dB from its own start, and where it lags by 90 degrees [Hz]; none where it does not.
struct Bandwidth {
  std::optional<double> gain_3_db, lag_90;
};
Bandwidth bandwidth_of(const Bode& bode, const BodeLine& line);

}  // namespace servodx
