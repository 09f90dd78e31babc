#include "valve_maps/bridge.h"

#include <algorithm>

namespace servodx::valve_maps {

// From the black box's numbers, each step exact for the bridge itself (docs/valve_maps.md).
Bridge::Bridge(const ValveNumbers& v) : lap(std::max(0.0, v.lap)), suction(v.suction()) {
  // Null leakage passes two equal edges in series on each of two sides: half of P_SR drops at R q + K q^2.
  const double q_full = 0.5 * v.null_leakage, q_quarter = 0.5 * v.quarter_leakage;
  const double at_full = 0.5 * v.supply / q_full, at_quarter = 0.125 * v.supply / q_quarter;
  // A leakage in proportion to pressure has no turbulent part, one with its root no laminar part.
  constexpr double least = 1e-3;
  turbulent = std::clamp((at_full - at_quarter) / (q_full - q_quarter), least * at_full / q_full, at_full / q_full);
  laminar = at_full - turbulent * q_full;
  // Open edges without load: half of P_SR drops at K lambda^2 q^2 / (x - L)^2 with q = G_Q (x - L).
  const double height2 = 0.5 * v.supply / (v.flow_gain * v.flow_gain) / turbulent;
  null_height = std::sqrt(height2);
  // Blocked ports at 40 % of P_SR: 0.3 of it drops at the edge that opens, 0.7 at the other; one flow passes both.
  const double x = 0.4 * v.supply / v.null_slope, uncovered = std::min(x, lap), open = x - uncovered;
  const double narrows = 1.0 + open * open / height2, share = uncovered / x;
  const double k = turbulent * (1.0 + share), r = laminar * (1.0 + share);
  const double dp = v.supply * (0.7 * share + 0.3 * narrows);
  const double q = 2.0 * dp / (r + std::sqrt(r * r + 4.0 * k * dp));
  laminar_cover = (0.7 * v.supply / q - turbulent * q - laminar) / x;
  // The lap's cover is part of the resistance at null, and cannot be more than all of it.
  constexpr double most = 0.95;
  laminar_cover = std::max(0.0, laminar_cover);
  if (lap > 0) laminar_cover = std::min(laminar_cover, most * laminar / lap);
  laminar -= laminar_cover * lap;

  per_height = 1.0 / null_height;
  root_turbulent = std::sqrt(turbulent);
  lap_1 = lap * per_height;
  half_laminar = 0.5 * laminar / root_turbulent;
  half_cover = 0.5 * laminar_cover * null_height / root_turbulent;
}

}  // namespace servodx::valve_maps
