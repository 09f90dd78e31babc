#include "explain/learnt_curves.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/present.h"
#include "effects/registry.h"
#include "effects/unexplained.h"
#include "explain/blocks.h"
#include "explain/closed_form.h"
#include "explain/constants.h"
#include "explain/subject.h"
#include "fit/chart.h"
#include "fit/log_data.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "servodx/log.h"

namespace servodx {
namespace {

using U = Unexplained;

// Place, variable and factor that make sense together.
constexpr int likely[][3] = {
    {U::drive, U::coil_current, U::one},
    {U::spool, U::spool_position, U::one},
    {U::spool, U::spool_velocity, U::one},
    {U::metering, U::spool_position, U::one},
    {U::metering, U::load_pressure, U::one},
    {U::at_a, U::load_pressure, U::one},
    {U::at_b, U::load_pressure, U::one},
    {U::at_a, U::piston_position, U::by_load_pressure},
    {U::piston, U::piston_position, U::one},
    {U::piston, U::piston_velocity, U::one},
    {U::piston, U::piston_position, U::by_direction},
    {U::piston, U::load_pressure, U::by_direction},
    {U::piston, U::piston_position, U::by_velocity},
};

// Where a knot stands. [scale]
double reach(int knot) { return curve::node[knot] / std::sqrt(1 - curve::node[knot] * curve::node[knot]); }

double scale_of(const ValveSubject& subject, int variable) {
  double largest = 0;
  for (const LogData& log : subject.logs()) {
    const auto channel = [&](Signal s) -> const std::vector<double>* {
      for (const FitChannel& c : log.channels)
        if (c.signal == s) return &c.measured;
      return nullptr;
    };
    const auto rate = [&](const std::vector<double>& x) {  // over 10 samples: above the noise
      std::vector<double> v;
      for (std::size_t k = 10; k < x.size(); ++k)
        v.push_back((x[k] - x[k - 10]) / (log.scenario.time[k] - log.scenario.time[k - 10]));
      return v;
    };
    const auto *piston = channel(Signal::piston_position), *spool = channel(Signal::spool_position),
               *a = channel(Signal::pressure_a), *b = channel(Signal::pressure_b);
    double now = 0;
    if (variable == U::piston_position && piston) now = rms_of_present(*piston);
    if (variable == U::piston_velocity && piston) now = rms_of_present(rate(*piston));
    if (variable == U::spool_position && spool) now = rms_of_present(*spool);
    if (variable == U::spool_velocity && spool) now = rms_of_present(rate(*spool));
    if (variable == U::coil_current) now = rms_of_present(log.scenario.command);
    if (variable == U::load_pressure && a && b) {
      std::vector<double> d;
      for (std::size_t k = 0; k < a->size(); ++k) d.push_back((*a)[k] - (*b)[k]);
      now = rms_of_present(d);
    }
    largest = std::max(largest, now);
  }
  return std::max(largest, U::variables[variable].scale);
}

}  // namespace

std::vector<Curve> add_curves(ValveSubject& subject) {
  std::vector<Curve> out;
  for (const auto& [place, variable, factor] : likely) {
    Curve curve{place, variable, factor, scale_of(subject, variable), -1};
    const U::PlaceInfo& at = U::places[place];
    Cause cause;
    cause.effect = U::name;
    cause.where = at.where;
    cause.family =
        fmt::format("{}{}{}", U::variables[variable].name, factor == U::one ? "" : " by ", U::factors[factor]);
    cause.curve = true;
    // What the piston's balance misses is read from the pressures.
    cause.simulated = place == U::piston && (variable == U::load_pressure || factor == U::by_load_pressure);
    // A friction may be less than the model's and never drives the piston, or a fit runs away where the logs do not
    // reach.
    const auto own = [&](int row) { return subject.table()[row].nominal; };
    const double largest = factor == U::by_velocity    ? own(row::piston_viscous_friction) * U::factor_speed
                           : factor == U::by_direction ? own(row::piston_coulomb_friction)
                                                       : at.largest;
    const double typical = largest < at.typical ? -at.typical : at.typical;
    std::vector<FreeValue> values;
    std::vector<std::vector<double>> together;
    for (int k = 0; k < U::knots; ++k) {
      FreeValue f;
      f.name = U::parameters[4 + k].name;
      f.at = effect_row<U>(4 + k);
      f.lower = -at.largest, f.upper = largest, f.start = 0;
      f.apply = [curve, at = f.at](double* v, double value) {
        // All curves share the rows: one that is off, but for rounding, leaves them to the one that is on.
        if (std::abs(value) < 1e-12 * U::places[curve.place].largest) return;
        v[effect_row<U>(0)] = curve.place, v[effect_row<U>(1)] = curve.variable, v[effect_row<U>(2)] = curve.factor;
        v[effect_row<U>(3)] = curve.scale;
        v[at] = value;
      };
      values.push_back(f);
      cause.numbers.push_back({{f.name, at.unit, f.lower, f.upper}});
      together.emplace_back(static_cast<std::size_t>(U::knots), 0.0);
      together.back()[static_cast<std::size_t>(k)] = typical;
    }
    cause.probes = {together};
    // Where the logs do not reach, the curve goes on in a straight line: a knot lies between its neighbours, give or
    // take a typical size.
    for (int k = 1; k + 1 < U::knots; ++k) {
      std::vector<double>& row = cause.ties.emplace_back(static_cast<std::size_t>(U::knots), 0.0);
      const auto j = static_cast<std::size_t>(k);
      row[j] = 1 / at.typical;
      row[j - 1] = -(reach(k + 1) - reach(k)) / (reach(k + 1) - reach(k - 1)) / at.typical;
      row[j + 1] = -(reach(k) - reach(k - 1)) / (reach(k + 1) - reach(k - 1)) / at.typical;
    }
    curve.cause = subject.add(std::move(cause), std::move(values));
    out.push_back(curve);
  }
  return out;
}

void guess_curves(ValveSubject& subject, const std::vector<Curve>& curves, const Point& point) {
  const std::vector<ReplayedBlock> blocks = replay_parts(subject, point);
  for (const Curve& curve : curves) {
    const U::PlaceInfo& place = U::places[curve.place];
    // The block whose missing quantity is what the curve adds.
    const auto block = std::find_if(blocks.begin(), blocks.end(),
                                    [&](const ReplayedBlock& b) { return b.curve_place == curve.place; });
    if (block == blocks.end()) continue;
    // Least squares on the knots; a knot that the logs do not reach stays at rest.
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(U::knots, U::knots);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(U::knots);
    bool shown = true;
    for (const ReplayedPart& part : block->parts) {
      const auto variable = [&](const char* name) -> const std::vector<double>* {
        for (const auto& [its, values] : part.variables)
          if (its == name) return &values;
        return nullptr;
      };
      const auto* x = variable(U::variables[curve.variable].name);
      const auto* by = curve.factor == U::one ? nullptr : variable(U::factors[curve.factor]);
      shown = shown && x && (by || curve.factor == U::one);
      for (std::size_t k = 0; shown && k < part.missing.size(); ++k) {
        const double s = (*x)[k] / std::hypot((*x)[k], curve.scale);
        const double factor = !by                                   ? 1
                              : curve.factor == U::by_load_pressure ? (*by)[k] / U::factor_pressure
                              : curve.factor == U::by_velocity      ? (*by)[k] / U::factor_speed
                                                                    : (*by)[k];
        Eigen::VectorXd row = Eigen::VectorXd::Zero(U::knots);
        double power = factor;
        for (int j = 0; j < U::knots; ++j, power *= s)
          for (int i = 0; i < U::knots; ++i) row[i] += curve::powers[j][i] * power;
        if (!row.allFinite() || !std::isfinite(part.missing[k])) continue;
        gram += row * row.transpose();
        right += row * part.missing[k];
      }
    }
    if (!shown || !(gram.trace() > 0)) continue;
    gram.diagonal().array() += explain_constants::knot_at_rest * gram.trace();
    const Eigen::VectorXd knots = gram.ldlt().solve(right).cwiseMax(-place.largest).cwiseMin(place.largest);
    subject.try_at(curve.cause, {knots.data(), knots.data() + U::knots});
  }
}

LearntCurve learnt(const Curve& curve, const std::vector<double>& knots, const std::vector<double>& std_error) {
  const U::VariableInfo& variable = U::variables[curve.variable];
  LearntCurve out{U::places[curve.place].where,
                  variable.name,
                  variable.unit,
                  U::factors[curve.factor],
                  U::places[curve.place].unit,
                  {},
                  ""};
  std::vector<Knot> known;
  for (int k = 0; k < U::knots; ++k) {
    const auto i = static_cast<std::size_t>(k);
    out.points.push_back({curve.scale * reach(k), knots[i], std_error[i]});
    if (std::isfinite(std_error[i]) && std_error[i] > 0)
      known.push_back({out.points.back().x, knots[i], 1 / std_error[i]});
  }
  out.closed_form = closed_form(known, out.unit, out.variable_unit);
  if (!out.closed_form.empty() && !out.factor.empty())
    out.closed_form += curve.factor == U::by_load_pressure ? ", times the load pressure over 100 bar"
                       : curve.factor == U::by_velocity    ? ", times the piston's velocity over 0.1 m/s"
                                                           : ", times the direction of the piston";
  return out;
}

}  // namespace servodx
