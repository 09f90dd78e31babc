// What every effect states about itself and about a parameter of its own.
#pragma once

namespace servodx {

// When `tune` frees an effect unless told: where healthy logs can tell it.
enum class Freed {
  never,
  everywhere,
  on_stands,            // of a valve on a test stand
  on_actuators,         // on all other rigs, and so the rest of these
  without_supply,       // where a log lacks the supply pressure: a measured one holds its droop
  without_return,       // the same of the return pressure
  across_temperatures,  // where logs of known temperatures differ
  with_long_lines,      // of hoses and pipes that ring within the band of logs
};

// How `explain` seeks an effect.
enum class SoughtAs {
  whole,             // one cause of all its numbers
  line_by_line,      // of each line with pick-up
  sensor_by_sensor,  // gain and lag of each
  meter_by_meter,    // lag of each flow meter
  nothing,           // a part of another effect, or nothing that the logs could tell
};

// A row of the table that an effect takes along where it is sought. `grows`: the row is a size of it, and no mere part
// of its shape.
struct RowAlong {
  int row;
  bool grows;
};

struct EffectParameter {
  const char* name;
  const char* unit;
  double off;           // [unit] with every parameter that `switches` at this value the model is exactly the base model
  double lower, upper;  // [unit]
  double start;         // [unit] a typical size: where a search begins
  const char* meaning;
  bool switches = true;  // false: shapes an effect that another parameter switches
  bool told = true;      // false: healthy logs cannot tell it from a row of the table; `tune` leaves it off
  double likely = 0.0;   // [unit] how far from `start` rigs that have it are; 0: as far as `start` is from `off`
};

}  // namespace servodx
