#include "effects/row_effects.h"

#include "effects/registry.h"
#include "effects/seal_film.h"
#include "model/open_valve.h"
#include "parameters/list.h"

namespace servodx {

const std::vector<RowEffect>& row_effects() {
  static const std::vector<RowEffect> list = {
      {"stribeck_friction",
       "piston_force",
       "breakaway friction of the piston above sliding friction",
       "slow ramps through standstill, both ways",
       0.0,
       {row::piston_stribeck_friction},
       {effect_row<SealFilm>(0)},
       nullptr,
       "stiction"},
      {"asymmetric_lap",
       "metering",
       "overlap of each metering edge of its own",
       "slow triangle about null with ports loaded",
       0.0,
       {row::lap_pa, row::lap_pb, row::lap_at, row::lap_bt}},
      {"hose_compliance",
       "flow_a",
       "lines that widen under pressure",
       "steps against a blocked piston",
       0.0,
       {row::hose_compliance}},
      {"air_entrainment",
       "flow_a",
       "free air in the oil",
       "steps at low and at high mean pressure: air is stiff under pressure, a hose is not",
       0.0,
       {row::air_fraction}},
      {"cross_piston_leakage",
       "flow_a",
       "oil that passes the piston seal",
       "hold a load: the piston creeps in proportion to the load pressure",
       0.0,
       {row::cross_piston_leakage},
       {},
       worst_leak},
      {"sensor_lag",
       "sensor:piston_position",
       "lag of the piston position sensor",
       "a fast sine: the sensor lags in proportion to frequency",
       0.0,
       {row::position_sensor_lag},
       {},
       nullptr,
       nullptr,
       "piston_position"},
      {"sensor_gain_error",
       "sensor:piston_position",
       "gain error of the piston position sensor",
       "full strokes against a second reference",
       1.0,
       {row::position_sensor_gain},
       {},
       nullptr,
       nullptr,
       "piston_position"},
      {"flow_force",
       "spool",
       "steady flow force on the spool",
       "full opening at several pressure drops",
       0.0,
       {row::flow_force_coefficient}},
  };
  return list;
}

}  // namespace servodx
