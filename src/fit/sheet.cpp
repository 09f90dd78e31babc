#include "fit/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <map>

#include "base/two_pi.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/constants.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/stand.h"
#include "optimise/box_least_squares.h"
#include "optimise/local.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

using namespace fit_constants;

constexpr std::array fitted_rows = {row::flapper_stiffness, row::torque_motor_frequency, row::hydraulic_amplifier_gain,
                                    row::fixed_orifice_diameter, row::driver_bandwidth};

// [s] from the step until the spool has made its way; of one that is still on it at the end, as if it went on in a
// line, so that a search sees which way is faster.
double rise_time(const StandTest& test, const std::vector<double>& spool) {
  const double start = spool[test.first], way = spool.back() - start;
  const auto& t = test.scenario.time;
  for (std::size_t k = test.first + 1; k < spool.size(); ++k) {
    const double before = (spool[k - 1] - start) / way, part = (spool[k] - start) / way;
    if (part >= risen) return t[k - 1] + (t[k] - t[k - 1]) * (risen - before) / (part - before) - t[test.first];
  }
  return t.back() - t[test.first];
}

double decibel(double ratio) { return 20 * std::log10(ratio); }

// All tests that the figures need; figures of one sine share it.
class Stand {
 public:
  Stand(const std::vector<SheetFigure>& figures, const RigFile& rig, double rated) : figures_(figures) {
    double lowest = low_frequency / low_part;
    for (const SheetFigure& f : figures)
      if (f.kind != SheetKind::step_rise_time) lowest = std::min(lowest, f.frequency);
    low_ = low_part * lowest;
    for (const SheetFigure& f : figures) {
      if (f.kind == SheetKind::step_rise_time) {
        tests_.push_back(step_test(rig, rated, f.amplitude, f.stated));
        at_[{0, f.amplitude}] = tests_.size() - 1;
        continue;
      }
      add(rig, rated, f.amplitude, f.frequency, settling_cycles(f.frequency));
      if (f.kind == SheetKind::gain) add(rig, rated, f.amplitude, low_, 1);
    }
  }

  std::vector<std::vector<double>> figures(const std::vector<ParameterVector>& candidates) const {
    const auto runs = spools(tests_, candidates);
    std::vector<std::vector<double>> out(candidates.size());
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const auto spool = [&](std::size_t test) -> const std::vector<double>& { return runs[test][k]; };
      bool ok = true;
      for (std::size_t test = 0; test < tests_.size(); ++test) ok = ok && !spool(test).empty();
      for (std::size_t f = 0; ok && f < figures_.size(); ++f) out[k].push_back(read(figures_[f], spool));
    }
    return out;
  }

 private:
  void add(const RigFile& rig, double rated, double amplitude, double frequency, int cycles) {
    if (!at_.emplace(std::pair{frequency, amplitude}, tests_.size()).second) return;
    tests_.push_back(sine_test(rig, rated, amplitude, frequency, cycles));
  }

  template <class Spool>
  double read(const SheetFigure& f, const Spool& spool) const {
    const auto at = [&](double frequency) { return at_.at({frequency, f.amplitude}); };
    if (f.kind == SheetKind::step_rise_time) return rise_time(tests_[at(0)], spool(at(0)));
    const auto g = response(tests_[at(f.frequency)], spool(at(f.frequency)));
    if (f.kind == SheetKind::gain) return decibel(std::abs(g) / std::abs(response(tests_[at(low_)], spool(at(low_)))));
    // The turn that is nearest to what is stated.
    const double lag = -std::arg(g);
    return lag + two_pi * std::round((f.stated - lag) / two_pi);
  }

  const std::vector<SheetFigure>& figures_;
  std::vector<StandTest> tests_;
  std::map<std::pair<double, double>, std::size_t> at_;  // by frequency and amplitude
  double low_ = 0;                                       // [Hz]
};

std::vector<FreeValue> free_rows(Table table, const RigFile& rig) {
  for (std::size_t k = 0; k < table.rows.size(); ++k)
    if (std::find(fitted_rows.begin(), fitted_rows.end(), static_cast<int>(k)) == fitted_rows.end())
      table.rows[k].estimate = false;
  std::vector<FreeValue> free = shared_values(table);
  hold_to_sheet(free, table, rig, {});
  return free;
}

Eigen::VectorXd deviates(const std::vector<SheetFigure>& figures, const std::vector<double>& simulated) {
  Eigen::VectorXd r(static_cast<long>(figures.size()));
  for (std::size_t k = 0; k < figures.size(); ++k)
    r[static_cast<long>(k)] = (figures[k].stated - simulated[k]) / figures[k].tolerance;
  return r;
}

LeastSquaresProblem problem_of(const Stand& stand, const Chart& chart, const std::vector<SheetFigure>& figures) {
  LeastSquaresProblem problem;
  problem.n = chart.n();
  problem.evaluate = [&](std::span<const Point> points) {
    std::vector<ParameterVector> candidates;
    for (const Point& x : points) candidates.push_back(chart.candidate(x, 0));
    std::vector<Evaluation> out(points.size());
    const auto simulated = stand.figures(candidates);
    const Point start = chart.start();
    for (std::size_t k = 0; k < points.size(); ++k) {
      out[k].ok = !simulated[k].empty();
      if (!out[k].ok) continue;
      const Eigen::VectorXd of_figures = deviates(figures, simulated[k]);
      out[k].residual.resize(of_figures.size() + chart.n());
      out[k].residual.head(of_figures.size()) = of_figures;
      for (int j = 0; j < chart.n(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        out[k].residual[of_figures.size() + j] = (points[k][at] - start[at]) / chart.free()[at].prior_sd;
      }
    }
    return out;
  };
  return problem;
}

// By how much a tenth more of each row moves the figures.
void rank_rows(SheetFit& fit, const Stand& stand, const ParameterVector& there) {
  std::vector<ParameterVector> moved;
  for (const SheetRow& r : fit.rows) {
    moved.push_back(there);
    moved.back()[static_cast<std::size_t>(r.position)] *= nudge;
  }
  const auto simulated = stand.figures(moved);
  for (std::size_t k = 0; k < fit.rows.size(); ++k)
    if (!simulated[k].empty())
      fit.rows[k].tells = (deviates(fit.figures, simulated[k]) - deviates(fit.figures, fit.after)).norm();
  std::stable_sort(fit.rows.begin(), fit.rows.end(),
                   [](const SheetRow& a, const SheetRow& b) { return a.tells > b.tells; });
}

}  // namespace

bool states_dynamics(const RigFile& rig) { return rig.fact("valve.step_rise_time") || !rig.response.empty(); }

std::vector<SheetFigure> sheet_figures(const RigFile& rig) {
  std::vector<SheetFigure> out;
  if (const auto rise = rig.fact("valve.step_rise_time"))
    out.push_back({SheetKind::step_rise_time, 0, rig.fact("valve.step_amplitude").value_or(1), *rise,
                   rise_time_tolerance * *rise});
  for (const ResponseFact& f : rig.response) {
    if (f.gain) out.push_back({SheetKind::gain, f.frequency, f.amplitude, *f.gain, gain_tolerance});
    if (f.phase_lag) out.push_back({SheetKind::phase_lag, f.frequency, f.amplitude, *f.phase_lag, lag_tolerance});
  }
  if (const auto f = rig.fact("valve.phase_lag_90_frequency"))
    out.push_back({SheetKind::phase_lag, *f, ResponseFact{}.amplitude, two_pi / 4, lag_tolerance});
  return out;
}

double farthest(const std::vector<SheetFigure>& figures, const std::vector<double>& simulated) {
  if (simulated.size() != figures.size()) return std::numeric_limits<double>::infinity();
  return figures.empty() ? 0 : deviates(figures, simulated).cwiseAbs().maxCoeff();
}

SheetFit beside_sheet(const Table& table, const RigFile& rig, bool fit) {
  SheetFit out;
  out.figures = sheet_figures(rig);
  out.rows_are = table.has_std_error ? SheetRows::tuned : fit ? SheetRows::fitted : SheetRows::formulas;
  const ParameterVector base = candidate_of(table);
  const Stand stand(out.figures, rig, rated_current(rig, base));
  const Chart chart(base, free_rows(table, rig));
  out.before = out.after = stand.figures({base}).front();
  ParameterVector there = base;
  if (fit && chart.n() > 0 && !out.before.empty()) {
    LeastSquaresOptions how;
    how.difference_step = step_through_contacts;
    how.difference = Difference::forward;
    how.cost_tolerance = sheet_cost_tolerance;
    there = chart.candidate(minimise_locally(problem_of(stand, chart, out.figures), chart.start(), how).end.point, 0);
    out.after = stand.figures({there}).front();
  }
  for (const FreeValue& f : chart.free())
    out.rows.push_back({f.at, base[static_cast<std::size_t>(f.at)], there[static_cast<std::size_t>(f.at)]});
  if (!out.after.empty()) rank_rows(out, stand, there);
  return out;
}

}  // namespace servodx
