#include "effects/row_effects.h"

#include "effects/registry.h"
#include "effects/seal_film.h"
#include "parameters/list.h"

namespace servodx {

const std::vector<RowEffect>& row_effects() {
  static const std::vector<RowEffect> list = {
      {"stribeck_friction",
       "piston_force",
       "breakaway friction of the piston above sliding friction",
       0.0,
       {row::piston_stribeck_friction},
       {effect_row<SealFilm>(0)},
       0,
       "stiction"},
      {"asymmetric_lap",
       "metering",
       "overlap of each metering edge of its own",
       0.0,
       {row::lap_pa, row::lap_pb, row::lap_at, row::lap_bt}},
      {"hose_compliance", "flow_a", "lines that widen under pressure", 0.0, {row::hose_compliance}},
      {"air_entrainment", "flow_a", "free air in the oil", 0.0, {row::air_fraction}},
      {"cross_piston_leakage",
       "flow_a",
       "oil that passes the piston seal",
       0.0,
       {row::cross_piston_leakage},
       {},
       2e-11},  // as far as the fault cylinder_leakage goes
      {"sensor_lag", "sensor:piston_position", "lag of the piston position sensor", 0.0, {row::position_sensor_lag}},
      {"sensor_gain_error",
       "sensor:piston_position",
       "gain error of the piston position sensor",
       1.0,
       {row::position_sensor_gain}},
      {"flow_force", "spool", "steady flow force on the spool", 0.0, {row::flow_force_coefficient}},
  };
  return list;
}

}  // namespace servodx
