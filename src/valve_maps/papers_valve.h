// The paper's own numbers (section 4 and Fig. 3 of "A review of simplified servovalve models for digital twins of
// electrohydraulic actuators"): 20 MPa, and G_PQ C_LK = 0.2, by which C5 gives 0.83 P_SR at x_SS.
#pragma once
#include "valve_maps/high_fidelity.h"

namespace servodx::valve_maps {

inline constexpr double papers_supply = 20e6;     // [Pa] P_SR
inline constexpr double papers_leak_share = 0.2;  // [-] G_PQ C_LK

// The valve whose four edges have the one overlap at which HF reads `leak_share`, at this supply less return [Pa]; to
// 1e-6 of it. The paper does not give the geometry of its HF, so the rest is kept. Limit: overlaps up to 20 clearances;
// a share beyond what these reach ends at the nearest of them.
ValveGeometry overlapped_to(ValveGeometry geometry, double leak_share, double supply);

}  // namespace servodx::valve_maps
