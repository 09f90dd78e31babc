// The one list of what the model shows of itself: the signals that a run can report, by their names in a log, in the
// order in which a run keeps them. Sensor effects act on these places, simulate/scenario.h makes its signals of them,
// simulate/sensor_readings.h fills them. Meanings and units: signals/signal.h.
#pragma once

namespace servodx {

#define SERVODX_SHOWN(X) \
  X(spool_position)      \
  X(piston_position)     \
  X(pressure_a)          \
  X(pressure_b)          \
  X(pilot_pressure_1)    \
  X(pilot_pressure_2)    \
  X(flow_a)              \
  X(flow_b)              \
  X(load_pressure)       \
  X(valve_pressure_drop) \
  X(control_flow)        \
  X(leakage_flow)

// Place of a signal among what is shown: shown::pressure_a == 2.
namespace shown {
enum class Place : int {
#define X(name) name,
  SERVODX_SHOWN(X)
#undef X
};
#define X(name) inline constexpr int name = static_cast<int>(Place::name);
SERVODX_SHOWN(X)
#undef X
}  // namespace shown

}  // namespace servodx
