#include "diagnose/lateral_force.h"

#include <cmath>
#include <numbers>

#include "diagnose/assessment.h"
#include "diagnose/judge.h"
#include "effects/registry.h"
#include "effects/stiction.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "parameters/list.h"
#include "servodx/operating_point.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

double friction_of(const ParameterVector& candidate) {
  return candidate[row::spool_friction] + candidate[static_cast<std::size_t>(effect_row<Stiction>(0))];
}

double worth(const OperatingPoint& point, Condition condition, double of_table) {
  return point[static_cast<std::size_t>(condition)].value_or(of_table);
}

}  // namespace

double lateral_force(double land_length, double diameter, double drop, double clearance, double taper) {
  const double ratio = taper / clearance;
  return 0.25 * std::numbers::pi * land_length * diameter * drop * ratio *
         ((2 + ratio) / std::sqrt(ratio * ratio + 4 * ratio) - 1);
}

double largest_lateral_force(double land_length, double diameter, double drop) {
  constexpr double worst_taper = 0.9;  // over the clearance: where the law has its top
  return lateral_force(land_length, diameter, drop, 1, worst_taper);
}

std::optional<FrictionBesideForce> friction_beside_force(const Diagnosis& d, const Table& tuned, const RigFile& rig) {
  const auto length = rig.fact("valve.land_length");
  if (!length || !d.fault) return {};
  const ParameterVector base = candidate_of(tuned);
  ParameterVector moved = base;
  d.fault->apply(moved.data(), d.fault->worst);
  if (friction_of(moved) == friction_of(base)) return {};
  const std::vector<OperatingPoint>& points = d.assessment.points;
  const OperatingPoint point = points.empty() ? OperatingPoint{} : points.front();
  const double drop = worth(point, Condition::supply, base[row::supply_pressure]) -
                      worth(point, Condition::return_pressure, base[row::return_pressure]);
  for (const HypothesisPrediction& h : d.assessment.explanations)
    if (h.fault == d.fault && !h.candidate.empty())
      return FrictionBesideForce{friction_of(h.candidate),
                                 largest_lateral_force(*length, base[row::spool_diameter], drop)};
  return {};
}

}  // namespace servodx
