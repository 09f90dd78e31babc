// Speed of a simulation, alone and in packs, against CVODE at the same error; Jacobian; failures inside the box.
#include <fmt/format.h>

#include "base/random.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "ratios/cvode.h"
#include "ratios/measure.h"
#include "ratios/rows.h"
#include "ratios/trace.h"
#include "servodx/instruction_set.h"
#include "servodx/log.h"
#include "signals/filters.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx::bench {
namespace {

constexpr double seconds = 4.0;  // simulated
constexpr int batch = 64;        // candidates
constexpr double fine = 2e-6;    // [s] step of the reference

// The cheapest setting of CVODE that errs no more than `error`.
std::optional<CvodeSetting> fair_setting(const Scenario& s, const ParameterVector& v, const Trajectory& truth,
                                         double error, Report& report) {
  std::optional<CvodeSetting> best;
  double least = 0;
  for (const bool knots : {false, true})
    for (const double tolerance : {3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7}) {
      const double from = thread_seconds();
      const auto t = run_cvode(s, v, {tolerance, knots}, truth);
      const double took = thread_seconds() - from;
      if (!t) continue;
      const double e = pressure_error(*t, truth);
      report.json["cvode2"]["tried"].push_back({{"tolerance", tolerance},
                                                {"stop_at_knots", knots},
                                                {"error", e},
                                                {"ms_per_simulated_second", 1e3 * took / seconds}});
      if (e <= error && (!best || took < least)) best = {tolerance, knots}, least = took;
    }
  return best;
}

// The cheapest of our steps that errs no more than `error`: whole substeps to a sample of 1 ms.
SimulateOptions fair_step(const Scenario& s, const ParameterVector& v, const Trajectory& truth, double error,
                          Report& report) {
  for (int substeps = 1;; ++substeps) {
    SimulateOptions o = one_thread();
    o.step = 1e-3 / substeps;
    const double e = pressure_error(simulate(s, v, o), truth);
    report.json["steps_tried"].push_back({{"step", o.step}, {"error", e}});
    if (e <= error || o.step <= fine) return o;
  }
}

// Random sets over the rows, of 10,000: how many fail.
long failures(bool all_rows) {
  Scenario s = trace(1.0);
  long failed = 0;
  for (int from = 0; from < 10000; from += 1000) {
    std::vector<ParameterVector> v(1000, candidate_of(table()));
    std::vector<Trajectory> t(v.size());
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < v.size(); ++i) {
      Random random(71, static_cast<std::uint32_t>(from) + static_cast<std::uint32_t>(i));
      for (int r = 0; r < n_parameters; ++r)
        if (all_rows || table()[r].estimate) v[i][r] = coordinate(table()[r]).from_unit(random.uniform());
      jobs.push_back({&s, &v[i], &t[i]});
    }
    simulate(jobs, {});
    for (const Trajectory& one : t) failed += !one.ok;
  }
  return failed;
}

}  // namespace

void kernel_rows(Report& report, const Choice& choice) {
  const ParameterVector v = candidate_of(table());
  const Scenario s = trace(seconds);
  SimulateOptions reference = one_thread();
  reference.wanted.fill(true);
  reference.step = reference.impact_step = fine;
  const Trajectory truth = simulate(s, v, reference);
  const double error = pressure_error(simulate(s, v, one_thread()), truth);
  report.json["error"] = error;
  report.json["instruction_set"] = instruction_set();

  constexpr double allowed = 1e-3;
  const SimulateOptions equal = fair_step(s, v, truth, allowed, report);
  std::optional<CvodeSetting> setting;
  if (!cvode_missing()) setting = fair_setting(s, v, truth, allowed, report);

  std::vector<Trajectory> t(batch);
  std::vector<Job> jobs;
  for (Trajectory& one : t) jobs.push_back({&s, &v, &one});
  // All rows free, on four channels: what a fit asks for.
  LogData log;
  log.scenario = s;
  for (Signal signal : {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b})
    log.channels.push_back({signal, simulated_index(signal), truth.signals[simulated_index(signal)], 1e-3, Filter{}});
  std::vector<FreeValue> free;
  for (int r = 0; r < n_parameters; ++r) free.emplace_back(coordinate(table()[r]), r);
  FitProblem problem({&log}, v, free, one_thread());
  const Point x = problem.start();
  const Eigen::VectorXd residual = problem.evaluate(std::span(&x, 1)).front().residual;
  Eigen::MatrixXd jacobian;

  std::vector<std::function<void()>> tasks = {
      [&] { simulate(s, v, one_thread()); }, [&] { simulate(jobs, one_thread()); },
      [&] { problem.jacobian(x, residual, jacobian); }, [&] { simulate(s, v, equal); }, [&] { simulate(jobs, equal); }};
  if (setting) tasks.push_back([&] { run_cvode(s, v, *setting, truth); });
  const std::vector<Timing> took = take_turns(tasks, choice.turns);
  const double per_second = 1e3 / seconds;
  const auto spread = [&](const Timing& a, double by) {
    return fmt::format("{:.3g} to {:.3g} ms/s", a.low * by, a.high * by);
  };
  report.notes.push_back(
      fmt::format("error of ours on the chamber pressures by the step of fits {:.3f} % of range, by "
                  "steps of {:.2f} ms {:.3f} % (reference: step {:g} s)",
                  100 * error, 1e3 * equal.step, 100 * pressure_error(simulate(s, v, equal), truth), fine));
  report.json["ms_per_simulated_second_alone"] = took[0].median * per_second;
  report.json["ms_per_simulated_second_in_a_batch"] = took[1].median * per_second / batch;

  if (setting) {
    const Timing& c = took.back();
    const double scalar = c.median / took[3].median, packed = c.median / (took[4].median / batch);
    const double scalar_of_fits = c.median / took[0].median, packed_of_fits = c.median / (took[1].median / batch);
    report.add({"one simulation against CVODE of order 2, each at its cheapest within 0.1 %", "15x", "35x",
                fmt::format("{:.1f}x", scalar), spread(took[3], per_second)});
    report.add({"batch against the same, per core", "120x", "250x", fmt::format("{:.0f}x", packed),
                spread(took[4], per_second / batch)});
    report.add({"the same two by the step of fits", "", "",
                fmt::format("{:.1f}x, {:.0f}x", scalar_of_fits, packed_of_fits),
                fmt::format("error {:.3f} % for CVODE's 0.1 %", 100 * error)});
    report.json["scalar_vs_cvode2"] = scalar;
    report.json["batch_vs_cvode2"] = packed;
    report.json["scalar_vs_cvode2_by_the_step_of_fits"] = scalar_of_fits;
    report.json["batch_vs_cvode2_by_the_step_of_fits"] = packed_of_fits;
    report.json["cvode2"]["tolerance"] = setting->tolerance;
    report.json["cvode2"]["stop_at_knots"] = setting->stop_at_knots;
    report.json["cvode2"]["ms_per_simulated_second"] = c.median * per_second;
    report.notes.push_back(fmt::format("CVODE of order 2: {:.1f} ms per simulated second at tolerance {:g}{}",
                                       c.median * per_second, setting->tolerance,
                                       setting->stop_at_knots ? ", stopping at every sample" : ""));
  } else {
    const std::string why = cvode_missing() ? cvode_missing() : "no tolerance of CVODE reaches this error";
    for (const char* key : {"scalar_vs_cvode2", "batch_vs_cvode2"}) report.json[key] = nullptr;
    report.excuse("cvode2", why);
    report.add({"one simulation and a batch against CVODE of order 2", "15x, 120x", "35x, 250x", "-", why});
  }
  const auto factor = [](const Timing& a) { return batch * seconds / a.median; };
  const auto factors = [](const Timing& a) {
    return fmt::format("{:.0f} to {:.0f}", batch * seconds / a.high, batch * seconds / a.low);
  };
  report.add({"simulated over wall seconds, per core, within 0.1 %", "4500", "8000",
              fmt::format("{:.0f}", factor(took[4])), factors(took[4])});
  report.add(
      {"the same by the step of fits", "4500", "8000", fmt::format("{:.0f}", factor(took[1])), factors(took[1])});
  report.json["realtime_factor_per_core"] = factor(took[4]);
  report.json["realtime_factor_per_core_by_the_step_of_fits"] = factor(took[1]);
  const double sims = took[2].median / took[0].median;
  report.add({"Jacobian of 41 parameters, in simulations", "7", "3.6", fmt::format("{:.1f}", sims),
              fmt::format("{:.1f} to {:.1f}", took[2].low / took[0].median, took[2].high / took[0].median)});
  report.json["jacobian_in_simulations"] = sims;

  const long failed = failures(false), failed_all = failures(true);
  report.add({"failed of 10,000 random sets of the fitted rows", "0", "0", fmt::format("{}", failed),
              fmt::format("all 41 rows: {}", failed_all)});
  report.json["failed_of_10000"] = failed;
  report.json["failed_of_10000_all_41_rows"] = failed_all;
}

}  // namespace servodx::bench
