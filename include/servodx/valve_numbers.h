// The numbers that describe a valve as a black box: what every simplified map is made of, each measurable on a stand.
//
// Source: "A review of simplified servovalve models for digital twins of electrohydraulic actuators" (its symbols in
// brackets); Merritt 1967, chapter 5, for what they mean. Spool travel counts from the hydraulic null, the position at
// which blocked ports hold equal pressures. A map gives the load pressure P12 = p_1 - p_2 [Pa] from spool position xS
// [m], load flow QJ [m3/s], which leaves port 1 and returns through port 2, and the supply less return P_SR [Pa].
#pragma once
#include <algorithm>

namespace servodx::valve_maps {

struct ValveNumbers {
  double supply = 0;             // [Pa] (P_SR) supply less return at which the rest was measured
  double flow_gain = 0;          // [m2/s] (G_Q) no-load flow per spool travel
  double null_slope = 0;         // [Pa/m] blocked-port load pressure per travel, secant within +-40 % of P_SR
  double pressure_gain = 0;      // [Pa/m] (G_P) the same without leakage, see meet_slope
  double saturation_travel = 0;  // [m] (x_SS) = P_SR / G_P: where that line reaches the supply
  double lap = 0;                // [m] overlap: where the straight part of the no-load flow curve meets the axis
  double null_leakage = 0;       // [m3/s] through the spool at null, ports blocked, at P_SR
  double quarter_leakage = 0;    // [m3/s] the same at a quarter of P_SR: tells laminar from turbulent
  double leakage = 0;            // [m3/s/Pa] (C_LK) = null_leakage / P_SR (Merritt sec. 5-3: the flow-pressure
                                 // coefficient of the centred valve), less where the slope asks for it
  double vapour_pressure = 1e3;  // [Pa] (P_vap) absolute; an upper bound for aircraft oils in use
  double return_pressure = 0;    // [Pa] absolute, at the return port

  // Takes G_P and x_SS so that the formulas, which divide by 1 + G_PQ C_LK, have at null the slope that was read:
  //   G_P / (1 + G_PQ C_LK) = null_slope,  so  G_P = null_slope / (1 - null_slope C_LK / G_Q)
  // Needs supply, flow_gain, null_slope and leakage. By Merritt (sec. 5-3) leakage alone bounds the slope at null to
  // G_Q / C_LK, and G_P has no bound; C_LK is cut where the slope read is nearer to that than the formulas can be.
  void meet_slope() {
    constexpr double nearest = 0.95;  // of G_Q / C_LK
    leakage = std::min(leakage, nearest * flow_gain / null_slope);
    pressure_gain = null_slope / (1.0 - null_slope * leakage / flow_gain);
    saturation_travel = supply / pressure_gain;
  }
  double straight_travel() const { return supply / null_slope; }        // [m] where the line at null reaches P_SR
  double gain_ratio() const { return pressure_gain / flow_gain; }       // [Pa s/m3] G_PQ
  double leak_share() const { return gain_ratio() * leakage; }          // [-] G_PQ C_LK
  double suction() const { return return_pressure - vapour_pressure; }  // [Pa] how far a port can fall below return
};

}  // namespace servodx::valve_maps
