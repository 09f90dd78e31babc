// Which of the two chamber columns obeys the flow of oil as which chamber.
//
// The spool opens one chamber to the supply and the other to the return, and the piston makes room for what comes in,
// less what compresses the oil that is there. Over a window, for each chamber:
//
//   piston's move = g * integral of opening * sqrt(pressure drop) - c * change of the chamber's pressure,   g, c >= 0
//
// A chamber that the spool opens to the supply has its drop below the supply, else above the return. g stands for edge,
// oil and area of one chamber, so areas may differ. Both equations are fitted twice, with the columns as they stand and
// exchanged, and what they leave of the piston's moves is compared. Load, mass and friction do not enter. Where the log
// lacks the spool, the current stands for it, as over a window a valve follows it.
//
// Limits: chambers at like pressures, a piston that hardly moves and a spool near null tell nothing; then both readings
// leave alike.
#pragma once
#include <optional>

#include "servodx/rig.h"
#include "signals/log.h"

namespace servodx {

// Parts of the squared moves, both chambers' mean.
struct LeftOfMoves {
  double as_they_stand = 1, exchanged = 1;
};

// None where the log lacks piston or a chamber, where neither log nor rig file has the supply, or where too few
// samples are there. `rate`: samples a second.
std::optional<LeftOfMoves> left_by_flow(const Log& log, const RigFile& rig, double rate);

// What it says of the two columns.
enum class Chambers { not_told, as_they_stand, exchanged };
Chambers chambers_by_flow(const Log& log, const RigFile& rig, double rate);

}  // namespace servodx
