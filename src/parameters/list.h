// The one list that owns each parameter's id, name, group, place, unit and meaning. The model's struct, the table file,
// the printed list and the reports are generated from it.
//
// Rows 1, 2, 6, 9 and 41 are fixed by the source paper (GA fault diagnosis, 41-parameter table in four groups); the
// actuator group has its 7 model rows (23-29) and 6 state rows (30-35).
#pragma once
#include <array>
#include <string_view>

namespace servodx {

// clang-format off
// X(id, name, group, place, unit, meaning)
#define SERVODX_PARAMETERS(X) \
  X(1,  filter_blockage_positive,  first_stage,  "first_stage",            "-",       "blocked fraction of the pilot filter area at positive spool speed; 0 clean") \
  X(2,  filter_blockage_negative,  first_stage,  "first_stage",            "-",       "blocked fraction of the pilot filter area at negative spool speed; 0 clean") \
  X(3,  torque_motor_gain,         first_stage,  "first_stage",            "N/A",     "force of the torque motor at the nozzle axis per coil current") \
  X(4,  flapper_stiffness,         first_stage,  "first_stage",            "N/m",     "net stiffness of the armature (flexure less magnetic spring) at the nozzle axis") \
  X(5,  torque_motor_frequency,    first_stage,  "first_stage",            "Hz",      "natural frequency of the armature and flapper") \
  X(6,  hydraulic_amplifier_gain,  first_stage,  "first_stage",            "m",       "nozzle curtain area uncovered per flapper travel; pi times the nozzle diameter") \
  X(7,  nozzle_gap,                first_stage,  "first_stage",            "m",       "distance between the centred flapper and each nozzle, where the flapper stops") \
  X(8,  fixed_orifice_diameter,    first_stage,  "first_stage",            "m",       "diameter of each fixed orifice between filter and spool end") \
  X(9,  valve_glitch,              first_stage,  "first_stage",            "m",       "backlash between feedback wire and spool, full width") \
  X(10, feedback_wire_stiffness,   first_stage,  "first_stage",            "N/m",     "force at the nozzle axis per spool travel") \
  X(11, driver_bandwidth,          first_stage,  "drive",                  "Hz",      "-3 dB frequency of current amplifier and coil") \
  X(12, current_limit,             first_stage,  "drive",                  "A",       "largest current that the amplifier drives") \
  X(13, spool_diameter,            second_stage, "spool",                  "m",       "diameter of the spool lands") \
  X(14, spool_friction,            second_stage, "spool",                  "N",       "Coulomb friction between spool and sleeve") \
  X(15, spool_stop,                second_stage, "spool",                  "m",       "spool travel to each end stop") \
  X(16, flow_force_coefficient,    second_stage, "spool",                  "-",       "steady flow force over its ideal value 2 Cd cos(69 deg) area dp") \
  X(17, port_width,                second_stage, "metering",               "m",       "area gradient of each metering edge, all ports of the edge together") \
  X(18, lap_pa,                    second_stage, "metering",               "m",       "overlap of the edge from supply to A; negative is underlap") \
  X(19, lap_pb,                    second_stage, "metering",               "m",       "overlap of the edge from supply to B; negative is underlap") \
  X(20, lap_at,                    second_stage, "metering",               "m",       "overlap of the edge from A to return; negative is underlap") \
  X(21, lap_bt,                    second_stage, "metering",               "m",       "overlap of the edge from B to return; negative is underlap") \
  X(22, radial_clearance,          second_stage, "metering",               "m",       "radial clearance between spool and sleeve") \
  X(23, piston_area_a,             actuator,     "piston_force",           "m2",      "piston area on side A, the chamber that grows as the piston extends") \
  X(24, piston_area_b,             actuator,     "piston_force",           "m2",      "piston area on side B") \
  X(25, piston_stroke,             actuator,     "flow_a",                 "m",       "full travel between the end stops") \
  X(26, moving_mass,               actuator,     "piston_force",           "kg",      "piston, rod and all that moves with them") \
  X(27, dead_volume_a,             actuator,     "flow_a",                 "m3",      "volume of side A with the piston at its stop, passages included") \
  X(28, dead_volume_b,             actuator,     "flow_b",                 "m3",      "volume of side B with the piston at its stop, passages included") \
  X(29, position_sensor_lag,       actuator,     "sensor:piston_position", "s",       "time constant of the piston position sensor") \
  X(30, cross_piston_leakage,      actuator,     "flow_a",                 "m3/s/Pa", "laminar leakage conductance from A to B at 40 degC") \
  X(31, piston_viscous_friction,   actuator,     "piston_force",           "N s/m",   "viscous friction of the piston at 40 degC") \
  X(32, piston_coulomb_friction,   actuator,     "piston_force",           "N",       "Coulomb friction of the piston") \
  X(33, piston_stribeck_friction,  actuator,     "piston_force",           "N",       "breakaway friction above Coulomb friction") \
  X(34, position_sensor_gain,      actuator,     "sensor:piston_position", "-",       "indicated over true piston travel") \
  X(35, air_fraction,              actuator,     "flow_a",                 "-",       "free air in the oil by volume at atmospheric pressure") \
  X(36, supply_pressure,           adjunct,      "supply",                 "Pa",      "supply pressure (gauge) where the log has none") \
  X(37, return_pressure,           adjunct,      "supply",                 "Pa",      "return pressure (gauge) where the log has none") \
  X(38, bulk_modulus,              adjunct,      "flow_a",                 "Pa",      "bulk modulus of the oil without air") \
  X(39, hose_resistance,           adjunct,      "metering",               "Pa s2/m6","pressure drop of each line between valve and actuator, per flow squared") \
  X(40, hose_compliance,           adjunct,      "flow_a",                 "m3/Pa",   "volume that each line gains per pressure, walls and oil") \
  X(41, servovalve_null,           adjunct,      "drive",                  "-",       "current that the valve adds to its command, fraction of rated")
// clang-format on

enum class Group { first_stage, second_stage, actuator, adjunct };
constexpr std::string_view name_of(Group g) {
  constexpr std::string_view names[] = {"first_stage", "second_stage", "actuator", "adjunct"};
  return names[static_cast<int>(g)];
}

struct ParameterInfo {
  int id;  // 1..41
  std::string_view name;
  Group group;
  std::string_view place;  // where in the model it acts; of a row that is an effect, as the effect says
  std::string_view unit;
  std::string_view meaning;
};

inline constexpr int n_parameters = 41;
inline constexpr std::array<ParameterInfo, n_parameters> parameter_list = {{
#define X(id, name, group, place, unit, meaning) {id, #name, Group::group, place, unit, meaning},
    SERVODX_PARAMETERS(X)
#undef X
}};

// Zero-based position of a row in parameter vectors: row::valve_glitch == 8.
namespace row {
#define X(id, name, group, place, unit, meaning) inline constexpr int name = id - 1;
SERVODX_PARAMETERS(X)
#undef X
}  // namespace row

// Position of a name in parameter_list, or -1.
constexpr int find_parameter(std::string_view name) {
  for (int i = 0; i < n_parameters; ++i)
    if (parameter_list[i].name == name) return i;
  return -1;
}

}  // namespace servodx
