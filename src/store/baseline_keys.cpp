#include "store/baseline_keys.h"

#include <array>
#include <cstddef>

#include "diagnose/record_figures.h"

namespace servodx::store {

std::string key_of(Condition condition) {
  constexpr std::array<const char*, n_conditions> keys = {"supply_pressure", "return_pressure", "oil_temperature",
                                                          "load_force", "drive"};
  return keys[static_cast<std::size_t>(condition)];
}

std::string key_of(FigureKind kind) {
  constexpr std::array<const char*, n_figure_kinds> keys = {
      "supply_level", "supply_step", "supply_left", "driver_gain", "driver_offset", "driver_left", "sensor_noise"};
  return keys[static_cast<std::size_t>(kind)];
}

}  // namespace servodx::store
