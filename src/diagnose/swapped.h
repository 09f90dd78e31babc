// Channels that do what another should: their columns may be exchanged.
//
// A chamber lies between return and supply but for moments, so a supply below a chamber, or a return above one, for
// more than half of the log is none. Chambers A and B, whatever the load, by either of two laws:
//
//   stiffness  Oil that the spool lets in raises the load pressure, and a piston that runs lowers it. Both have the
//              other sign where A and B are exchanged: the partial correlations of the load pressure's change over
//              8 ms with spool position and piston speed, load pressure held, were above -0.10 and below 0.19 in 194
//              logs of two rigs, half of them with faults.
//   flow       The piston moves by the oil that the pressure drops drive through the spool's edges
//              (flow_into_chambers.h). This tells where pressures are far apart and slow, that where they are quick.
//
// Leaves out: A and B where the piston is not measured, or the log is too calm to tell. Exchanged chambers are the same
// as spool and piston both turned about; that the drive tells (survey.cpp).
#pragma once
#include <vector>

#include "servodx/check_log.h"
#include "servodx/rig.h"
#include "signals/log.h"

namespace servodx {

// `rate`: samples a second.
std::vector<Finding> swapped_channels(const Log& log, const RigFile& rig, double rate);

}  // namespace servodx
