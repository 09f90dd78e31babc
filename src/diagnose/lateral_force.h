// A yardstick for the friction of a spool that sticks: what leakage past a tapered land can press it against its sleeve
// with (GA paper, "Experimental analysis: Sticky spool").
//
// A land of length l and diameter d, its gap wider by t towards the low pressure, touches the sleeve on one side. The
// film there loses its pressure at once, the wide side opposite holds it and pushes the land onto the wall (Merritt
// 1967, Hydraulic Control Systems; Blackburn, Reethof & Shearer 1960, Fluid Power Control):
//   F = pi l d dp t/(4 c) [ (2 + t/c) / sqrt((t/c)^2 + 4 t/c) - 1 ]
// and no taper gives more than 0.27 l d dp, which is at t = 0.9 c. Limits: one land without grooves, which lower it by
// far; laminar film; contact without dirt.
#pragma once
#include <optional>

#include "parameters/table.h"
#include "servodx/diagnose.h"
#include "servodx/rig.h"

namespace servodx {

struct Diagnosis;

// `taper` over `clearance`, both of the radius [m]; force [N].
double lateral_force(double land_length, double diameter, double drop, double clearance, double taper);
double largest_lateral_force(double land_length, double diameter, double drop);

using FrictionBesideForce = Verdict::Friction;

// Steel on steel in oil rubs with 0.1 to 0.2 at the boundary (Bowden & Tabor 1950, ch. 10): beyond, something else
// holds the spool, such as a chip, lacquer or a bent sleeve.
inline constexpr double highest_lubricated_friction = 0.2;

// Of a named fault that moves the spool's friction, where the rig file states the land's length.
std::optional<FrictionBesideForce> friction_beside_force(const Diagnosis& diagnosis, const Table& tuned,
                                                         const RigFile& rig);

}  // namespace servodx
