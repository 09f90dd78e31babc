#include "diagnose/swapped.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/constants.h"
#include "diagnose/flow_into_chambers.h"
#include "diagnose/part_below.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/signal.h"

namespace servodx {
namespace {

using namespace diagnose_constants::exchanged;

double margin_of(double pressure) { return std::max(least_apart, part_apart * std::abs(pressure)); }

// What a chamber does beside such a supply is no second finding.
bool find_return_above_supply(const Log& log, std::vector<Finding>& found) {
  if (!log.has(Signal::supply_pressure) || !log.has(Signal::return_pressure)) return false;
  const double part = part_below(log[Signal::supply_pressure], log[Signal::return_pressure], &margin_of);
  if (part < most_of_the_time) return false;
  found.push_back(
      {FindingKind::swapped,
       fmt::format("'return_pressure' is above 'supply_pressure' in {:.0f} % of the samples: oil would flow "
                   "backwards, and no valve works so; the two columns are exchanged, or a unit or an offset "
                   "of one is wrong",
                   100 * part),
       {Signal::supply_pressure, Signal::return_pressure},
       true});
  return true;
}

void find_order(const Log& log, std::vector<Finding>& found) {
  if (find_return_above_supply(log, found)) return;
  struct Pair {
    Signal upper = Signal::supply_pressure, lower = Signal::pressure_a;
    double part = 0;
  };
  // Of two chambers beyond the supply or the return, the one that is so the longer stands in its column.
  for (const auto& pairs : {std::array{Pair{Signal::supply_pressure, Signal::pressure_a},
                                       Pair{Signal::supply_pressure, Signal::pressure_b}},
                            std::array{Pair{Signal::pressure_a, Signal::return_pressure},
                                       Pair{Signal::pressure_b, Signal::return_pressure}}}) {
    Pair worst;
    for (Pair pair : pairs) {
      if (!log.has(pair.upper) || !log.has(pair.lower)) continue;
      pair.part = part_below(log[pair.upper], log[pair.lower], &margin_of);
      if (pair.part > worst.part) worst = pair;
    }
    if (worst.part < most_of_the_time) continue;
    found.push_back({FindingKind::swapped,
                     fmt::format("'{}' is below '{}' in {:.0f} % of the samples: are the two columns exchanged?",
                                 info(worst.upper).name, info(worst.lower).name, 100 * worst.part),
                     {worst.upper, worst.lower}});
  }
}

// Partial correlations of the load pressure's change with the spool's position and with the piston's.
bool pressures_answer_otherwise(const Log& log, double rate) {
  for (const Signal s : {Signal::pressure_a, Signal::pressure_b, Signal::spool_position, Signal::piston_position})
    if (!log.has(s)) return false;
  const auto half = std::max(1L, std::lround(half_window * rate));
  const auto samples = static_cast<long>(log.samples());
  const std::vector<double>&a = log[Signal::pressure_a], &b = log[Signal::pressure_b];
  const std::vector<double>&spool = log[Signal::spool_position], &piston = log[Signal::piston_position];
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
  double n = 0, spool_sum = 0;
  const auto at = [](const std::vector<double>& x, long k) { return x[static_cast<std::size_t>(k)]; };
  for (long k = 0; k < std::min(2 * half, samples); ++k) spool_sum += std::isfinite(at(spool, k)) ? at(spool, k) : 0;
  for (long k = half; k + half < samples; ++k) {
    const Eigen::Vector4d row(spool_sum / static_cast<double>(2 * half), at(piston, k + half) - at(piston, k - half),
                              at(a, k) - at(b, k),
                              at(a, k + half) - at(b, k + half) - at(a, k - half) + at(b, k - half));
    const double comes = at(spool, k + half), goes = at(spool, k - half);
    spool_sum += (std::isfinite(comes) ? comes : 0) - (std::isfinite(goes) ? goes : 0);
    if (!row.allFinite()) continue;
    sum += row, square += row * row.transpose(), ++n;
  }
  if (n < fewest) return false;
  Eigen::Matrix4d covariance = square / n - sum / n * (sum / n).transpose();
  const Eigen::Vector4d scale = covariance.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0)) return false;
  covariance = scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal();
  covariance.diagonal().array() += 1e-9;  // where two of them are one
  const Eigen::Matrix4d inverse = covariance.inverse();
  const auto partial = [&](int k) { return -inverse(k, 3) / std::sqrt(inverse(k, k) * inverse(3, 3)); };
  return partial(0) < -against && partial(1) > against;
}

// What the flow says stands above what the stiffness says: a leak across the piston upsets the second alone.
const char* why_exchanged(const Log& log, const RigFile& rig, double rate) {
  switch (chambers_by_flow(log, rig, rate)) {
    case Chambers::exchanged:
      return "the oil that the spool lets in moves the piston as it does only with 'pressure_a' and 'pressure_b' "
             "exchanged";
    case Chambers::as_they_stand:
      return nullptr;
    case Chambers::not_told:
      break;
  }
  return pressures_answer_otherwise(log, rate)
             ? "'pressure_a' - 'pressure_b' falls where the spool lets oil into A, and rises with the piston's speed"
             : nullptr;
}

void find_chambers(const Log& log, const RigFile& rig, double rate, std::vector<Finding>& found) {
  const char* const why = why_exchanged(log, rig, rate);
  if (!why) return;
  found.push_back({FindingKind::swapped,
                   fmt::format("{}: are the two columns exchanged? Mend [columns] of the rig file, or the plugs", why),
                   {Signal::pressure_a, Signal::pressure_b}});
}

}  // namespace

std::vector<Finding> swapped_channels(const Log& log, const RigFile& rig, double rate) {
  std::vector<Finding> found;
  find_order(log, found);
  if (found.empty()) find_chambers(log, rig, rate, found);
  return found;
}

}  // namespace servodx
