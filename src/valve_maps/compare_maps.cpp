#include "valve_maps/compare_maps.h"

#include <algorithm>
#include <cmath>

#include "servodx/valve_numbers.h"
#include "valve_maps/high_fidelity.h"

namespace servodx::valve_maps {
namespace {

constexpr double burst = 3.0;      // of P_SR: beyond, nothing is compared
constexpr double saturates = 0.9;  // of P_SR

struct Sample {
  double x_s, q_j, supply, reference;
  Region region;
};

// Travels from a tenth of x_SS to the stop, evenly in the logarithm; flows in terms of what the valve passes there.
std::vector<Sample> samples_of(const ValveNumbers& v, const HighFidelity& reference, const CompareOptions& options) {
  constexpr int travels = 24, flows = 13;
  constexpr double most = 1.2;  // of the no-load flow
  const double least = 0.1 * v.straight_travel();
  std::vector<Sample> out;
  for (double share : options.supply_shares) {
    const double supply = share * v.supply;
    for (int i = 0; i < travels; ++i) {
      const double x = least * std::pow(options.stop / least, (i + 0.5) / travels);
      const double passes = v.flow_gain * (x + 0.5 * v.straight_travel()) * std::sqrt(share);
      for (int j = 0; j < flows; ++j)
        for (double side : {-1.0, 1.0}) {
          const double x_s = side * x, q_j = most * passes * (2.0 * (j + 0.5) / flows - 1.0) * 0.999;
          if (std::fabs(q_j) < 1e-3 * passes) continue;  // the line that the numbers were read from
          const double p = reference(x_s, q_j, supply);
          if (std::fabs(p) <= burst * supply) out.push_back({x_s, q_j, supply, p, region_of(p, x_s, supply, v)});
        }
    }
  }
  return out;
}

}  // namespace

Region region_of(double p, double x_s, double supply, const ValveNumbers& v) {
  const bool near_null = std::fabs(x_s) <= v.straight_travel();
  if (std::fabs(p) > supply) return near_null ? Region::water_hammer : Region::driven;
  if (std::fabs(p) > saturates * supply) return Region::saturated;
  return near_null ? Region::linear : Region::open;
}

std::vector<MapError> compare(const ValveNumbers& numbers, const HighFidelity& reference,
                              const CompareOptions& options) {
  const std::vector<Sample> samples = samples_of(numbers, reference, options);
  std::vector<MapError> out;
  for (const MapInfo& info : map_list()) {
    MapError e{info.name, {}, options.costs ? info.cost(numbers, reference) : Cost{}};
    const Map map = info.make(numbers, reference);
    for (const Sample& s : samples) {
      RegionError& r = e.regions[static_cast<std::size_t>(s.region)];
      const double error = std::fabs(map(s.x_s, s.q_j, s.supply) - s.reference) / s.supply;
      ++r.points;
      r.rms += error * error;
      r.largest = std::max(r.largest, error);
    }
    for (RegionError& r : e.regions) r.rms = r.points ? std::sqrt(r.rms / static_cast<double>(r.points)) : 0.0;
    out.push_back(std::move(e));
  }
  return out;
}

double default_travel(const ValveNumbers& v) { return 5.0 * v.straight_travel(); }
double default_flow(const ValveNumbers& v) { return 2.0 * v.flow_gain * v.straight_travel(); }
std::vector<double> falling_supplies(double supply, const ValveNumbers& v) {
  return {supply, 0.5 * supply, 0.1 * supply, v.vapour_pressure};
}

std::vector<MapPoint> grid(const Map& map, double travel, int travels, double flow, int flows, double supply) {
  std::vector<MapPoint> out;
  const auto at = [](double largest, int k, int n) { return largest * (2.0 * k / (n - 1) - 1.0); };
  for (int i = 0; i < travels; ++i)
    for (int j = 0; j < flows; ++j) {
      const double x_s = at(travel, i, travels), q_j = at(flow, j, flows);
      out.push_back({x_s, q_j, map(x_s, q_j, supply)});
    }
  return out;
}

}  // namespace servodx::valve_maps
