// Fixed numbers of the identification model: coefficients that no log can tell from a row of the table, and the width
// of every smoothing. Merritt = H. E. Merritt, Hydraulic Control Systems, Wiley 1967.
//
// No half and no double of any was run.
#pragma once

namespace servodx::constants {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double atmospheric_pressure = 101325.0;  // [Pa]
inline constexpr double steel_density = 7800.0;           // [kg/m3]

// Coefficients.
inline constexpr double cd_metering = 0.61;  // sharp edge, turbulent (Merritt eq. 3-34)
inline constexpr double cd_orifice =
    0.65;  // short-tube fixed orifice with rounded inlet (Merritt sec. 3-4: 0.6 to 0.88)
inline constexpr double cd_nozzle = 0.64;        // flapper-nozzle curtain (Merritt sec. 5-6)
inline constexpr double nozzle_bore_loss = 1.0;  // velocity heads of the bore: entrance 0.5, turn into the curtain 0.5.
                                                 // A wide gap passes no more than the bore
inline constexpr double jet_angle_factor =
    0.43;  // 2 Cd Cv cos(69 deg): flow force per area and pressure drop (Merritt eq. 5-96)
inline constexpr double flapper_damping_ratio =
    0.3;  // eddy currents and squeeze film; at 1 kHz not separable from driver_bandwidth
inline constexpr double spool_length_in_diameters =
    6.0;  // spool mass = steel cylinder of this length; its mode (kHz) is above any log
inline constexpr double spool_presliding =
    2e-6;  // [m] steel on steel yields 2 to 5 um before it slips (Armstrong, Dupont & Canudas 1994, sec. 2.2)
// [m] A seal slips bit by bit, from its asperities to the bending of its lip; each family bears an equal share
// (Maxwell's slip model: Iwan 1966, Al-Bender, Lampaert & Swevers 2005). One family alone rings at each reversal.
inline constexpr double seal_presliding[] = {1e-5, 3e-5, 1e-4};
inline constexpr double seal_renewal = 5e-5;   // [m] mean of these: a seal's contacts are new after sliding as far
inline constexpr double least_friction = 1.0;  // [N] keeps a ratio of frictions defined where there are none
inline constexpr double piston_stribeck_velocity = 2e-2;  // [m/s] elastomer seals slide fully from some cm/s
inline constexpr double clean_filter_area_ratio =
    5.0;  // clean filter area over both fixed orifices' areas: 4 % of the pilot pressure is lost
// Creeping-flow length of an open edge, in openings: C_d = delta sqrt(Re) with delta = 0.157 of a slot (Merritt 1967,
// sec. 3-4) is 1/(48 delta^2) of them.
inline constexpr double slot_resistance = 0.845;
inline constexpr double filter_node_volume = 2e-7;    // [m3] between filter and orifices; a pole near 0.1 ms
inline constexpr double pilot_volume_in_stops = 4.0;  // spool end volume = end area times this many stop travels
inline constexpr double spool_stop_stiffness = 2e7;   // [N/m] full pilot force penetrates some 20 um
inline constexpr double spool_stop_damping = 1000.0;  // [N s/m] oil squeezed out between spool end and cap: no rebound
inline constexpr double piston_stop_stiffness = 2e8;  // [N/m] full actuator force penetrates 0.1 mm
inline constexpr double piston_stop_damping = 5e4;    // [N s/m] an impact does not rebound

// Smoothing widths, each with what it must stay small against.
inline constexpr double backlash_rounding = 5e-7;  // [m] ball contact; a tenth of mild backlash
inline constexpr double stop_rounding = 1e-6;  // [m] flapper at a nozzle: seat roughness; a wider one bends the slew
inline constexpr double edge_rounding = 1e-6;  // [m] corner radius of a new metering edge
inline constexpr double spool_stop_rounding = 1e-5;   // [m] roughness and tilt of the end faces
inline constexpr double spool_film = 3e-5;            // [m] where the squeezed oil slows the spool: its way in a step
inline constexpr double piston_stop_rounding = 1e-5;  // [m]
inline constexpr double filter_direction_rounding = 2e-3;  // [m/s] spool speed over which rows 1 and 2 hand over
inline constexpr double orifice_transition = 1e4;          // [Pa] linear below 0.1 bar
inline constexpr double pressure_floor = 5e4;              // [Pa] absolute pressure at which the air law is rounded off
inline constexpr double current_rounding = 1e-5;           // [A] amplifier limit

}  // namespace servodx::constants
