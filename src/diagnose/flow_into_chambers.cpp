#include "diagnose/flow_into_chambers.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "diagnose/constants.h"
#include "servodx/log.h"
#include "signals/drive_of.h"
#include "signals/signal.h"

namespace servodx {
namespace {

using namespace diagnose_constants::exchanged;

struct Recorded {
  const std::vector<double>&opening, &piston;
  std::vector<double> supply, return_line;
  long half = 1;  // samples of half a window
};

std::vector<double> recorded_or(const Log& log, Signal signal, double fact) {
  return log.has(signal) ? log[signal] : std::vector<double>(log.samples(), fact);
}

// Sums of opening * sqrt(drop) over the samples ahead of each. `side`: 1 where a positive one leads to the supply.
std::vector<double> flow_until(const Recorded& r, const std::vector<double>& chamber, double side) {
  std::vector<double> sum(chamber.size() + 1, 0.0);
  for (std::size_t k = 0; k < chamber.size(); ++k) {
    const double opening = side * r.opening[k];
    const double drop = opening > 0 ? r.supply[k] - chamber[k] : chamber[k] - r.return_line[k];
    const double flow = opening * std::sqrt(std::max(0.0, drop));
    sum[k + 1] = sum[k] + (std::isfinite(flow) ? flow : 0.0);
  }
  return sum;
}

// Covariance of the move into the chamber, the flow and the pressure's fall, over windows about each sample.
std::optional<Eigen::Matrix3d> covariance(const Recorded& r, const std::vector<double>& chamber, double side) {
  const std::vector<double> flow = flow_until(r, chamber, side);
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double n = 0;
  for (long k = r.half; k + r.half < static_cast<long>(chamber.size()); ++k) {
    const auto from = static_cast<std::size_t>(k - r.half), to = static_cast<std::size_t>(k + r.half);
    const Eigen::Vector3d row(side * (r.piston[to] - r.piston[from]), flow[to] - flow[from],
                              chamber[from] - chamber[to]);
    if (!row.allFinite()) continue;
    square += row * row.transpose(), sum += row, ++n;
  }
  if (n < fewest) return {};
  Eigen::Matrix3d c = square / n - sum / n * (sum / n).transpose();
  const Eigen::Vector3d scale = c.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0)) return {};
  return Eigen::Matrix3d(scale.cwiseInverse().asDiagonal() * c * scale.cwiseInverse().asDiagonal());
}

// Of the moves' square, by least squares with neither coefficient below zero.
double left_of(const Eigen::Matrix3d& correlation) {
  const double flow = correlation(0, 1), fall = correlation(0, 2), both = correlation(1, 2);
  const double determinant = 1 - both * both;
  const double g = (flow - fall * both) / determinant, c = (fall - flow * both) / determinant;
  if (determinant > least_determinant && g >= 0 && c >= 0) return std::max(0.0, 1 - g * flow - c * fall);
  const double one = std::max({0.0, flow, fall});
  return 1 - one * one;
}

std::optional<double> left_by(const Recorded& r, const std::vector<double>& a, const std::vector<double>& b) {
  const auto of_a = covariance(r, a, 1), of_b = covariance(r, b, -1);
  if (!of_a || !of_b) return {};
  return 0.5 * (left_of(*of_a) + left_of(*of_b));
}

}  // namespace

std::optional<LeftOfMoves> left_by_flow(const Log& log, const RigFile& rig, double rate) {
  for (const Signal s : {Signal::pressure_a, Signal::pressure_b, Signal::piston_position})
    if (!log.has(s)) return {};
  const Signal opening = log.has(Signal::spool_position) ? Signal::spool_position : drive_of(log);
  const std::optional<double> stated = rig.fact("supply.pressure");
  if (!log.has(Signal::supply_pressure) && !stated) return {};
  const Recorded r{log[opening], log[Signal::piston_position],
                   recorded_or(log, Signal::supply_pressure, stated.value_or(0)),
                   recorded_or(log, Signal::return_pressure, rig.fact("supply.return_pressure").value_or(0)),
                   std::max(1L, std::lround(half_window_of_flow * rate))};
  const std::vector<double>&a = log[Signal::pressure_a], &b = log[Signal::pressure_b];
  const auto stand = left_by(r, a, b), exchanged = left_by(r, b, a);
  if (!stand || !exchanged) return {};
  return LeftOfMoves{*stand, *exchanged};
}

Chambers chambers_by_flow(const Log& log, const RigFile& rig, double rate) {
  const std::optional<LeftOfMoves> left = left_by_flow(log, rig, rate);
  const auto tells = [](double one, double other) { return one < moves_explained && one < exchanged_leaves * other; };
  if (left && tells(left->exchanged, left->as_they_stand)) return Chambers::exchanged;
  if (left && tells(left->as_they_stand, left->exchanged)) return Chambers::as_they_stand;
  return Chambers::not_told;
}

}  // namespace servodx
