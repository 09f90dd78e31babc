#include "valve_maps/registry.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <type_traits>

#include "valve_maps/bridge.h"
#include "valve_maps/linear.h"
#include "valve_maps/model_a.h"
#include "valve_maps/model_c1.h"
#include "valve_maps/model_c2.h"
#include "valve_maps/model_c3.h"
#include "valve_maps/model_c5.h"

namespace servodx::valve_maps {
namespace {

template <class Model>
Model make_model(const ValveNumbers& numbers, const HighFidelity& reference) {
  if constexpr (std::is_same_v<Model, HighFidelity>)
    return reference;
  else
    return Model(numbers);
}

// Least of many passes over arrays that stay in the first cache: what it costs where nothing disturbs.
template <class Model>
Cost cost_of(const ValveNumbers& numbers, const HighFidelity& reference) {
  using Clock = std::chrono::steady_clock;
  const Model model = make_model<Model>(numbers, reference);
  constexpr bool slow = std::is_same_v<Model, HighFidelity>;
  constexpr std::size_t points = slow ? 32 : 1024;
  constexpr int passes = slow ? 5 : 400;
  std::vector<double> x(points), q(points), p(points);
  double turn = 0.0;  // golden-section sequence: no pattern for a branch predictor
  for (std::size_t k = 0; k < points; ++k) {
    turn += 0.6180339887498949;
    turn -= static_cast<double>(static_cast<long>(turn));
    x[k] = (2.0 * turn - 1.0) * 5.0 * numbers.straight_travel();
    q[k] = (2.0 * turn * turn - 0.8) * numbers.flow_gain * numbers.straight_travel();
  }
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count() / static_cast<double>(points);
  };
  constexpr double none = 1e-30;  // [m3/s/Pa] a feedback too small to matter and too large to leave out
  constexpr double endless = std::numeric_limits<double>::infinity();
  Cost best{endless, endless};
  volatile double keep = 0.0;
  for (int pass = 0; pass < passes; ++pass) {
    auto start = Clock::now();
    double last = 0.0;
    for (std::size_t k = 0; k < points; ++k) last = model(x[k], q[k] + none * last, numbers.supply);
    best.in_step = std::min(best.in_step, seconds_since(start));
    start = Clock::now();
    for (std::size_t k = 0; k < points; ++k) p[k] = model(x[k], q[k], numbers.supply);
    best.in_batch = std::min(best.in_batch, seconds_since(start));
    keep = keep + last + p[static_cast<std::size_t>(pass) % points];
  }
  return best;
}

template <class Model>
MapInfo entry(const char* name, const char* meaning) {
  return {name, meaning,
          [](const ValveNumbers& numbers, const HighFidelity& reference) -> Map {
            return make_model<Model>(numbers, reference);
          },
          &cost_of<Model>};
}

}  // namespace

const std::vector<MapInfo>& map_list() {
  static const std::vector<MapInfo> list = {
      entry<Linear>("linear", "pressure gain and flow gain alone"),
      entry<ModelA>("A", "the gain follows the supply; leakage; no saturation"),
      entry<ModelC1>("C1", "A, saturated ahead of the leakage"),
      entry<ModelC2>("C2", "A, saturated behind the leakage"),
      entry<ModelC3>("C3", "A, saturated ahead of a leakage that fades as the spool opens"),
      entry<ModelC5>("C5", "equivalent spool position; tends to the supply"),
      entry<Bridge>("bridge", "ours: the bridge of four edges solved in closed form; shows the water hammer"),
      entry<HighFidelity>("HF", "four passages with leakage, solved for the control pressures: the reference"),
  };
  return list;
}

const MapInfo* find_map(const std::string& name) {
  for (const MapInfo& map : map_list())
    if (map.name == name) return &map;
  return nullptr;
}

}  // namespace servodx::valve_maps
