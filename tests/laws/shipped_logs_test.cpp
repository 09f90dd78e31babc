// The model on the committed logs: every row shows somewhere, the default step is short enough, no corner of the box
// breaks a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fit/problem.h"
#include "laws/bench.h"

namespace servodx {
namespace {

TEST(ShippedLogs, EveryRowChangesTheSimulationOfSomeShippedLog) {
  const Table table = shipped_table();
  std::vector<LogData> logs;
  // Small moves, large moves, a load, and no supply or return pressure measured.
  for (const char* name :
       {"healthy/h12_mixed", "healthy/h01_steps_large", "healthy/h10_flight", "healthy/h15_no_supply_signals"})
    logs.push_back(slice(shipped_data(name), 0, 1500));
  // Twice a row, at the ends of its bounds; the first candidate is nominal.
  std::vector<ParameterVector> v = {candidate_of(table)};
  for (int r = 0; r < n_parameters; ++r)
    for (double end : {table[r].lower, table[r].upper}) {
      v.push_back(v.front());
      v.back()[r] = end;
    }
  // Gain of the position sensor acts on a start away from mid-stroke or a motion; all logs move.
  std::vector<Trajectory> t(v.size() * logs.size());
  std::vector<Job> jobs;
  for (std::size_t l = 0; l < logs.size(); ++l)
    for (std::size_t i = 0; i < v.size(); ++i) jobs.push_back({&logs[l].scenario, &v[i], &t[l * v.size() + i]});
  simulate(jobs);
  for (int r = 0; r < n_parameters; ++r) {
    double most = 0;
    std::string where;
    for (std::size_t l = 0; l < logs.size(); ++l)
      for (std::size_t end : {1u + 2u * r, 2u + 2u * r})
        for (const FitChannel& c : logs[l].channels) {
          const Trajectory &a = t[l * v.size()], &b = t[l * v.size() + end];
          EXPECT_TRUE(a.ok && b.ok) << table[r].name;
          double sum = 0;
          for (std::size_t k = 0; k < c.measured.size(); ++k)
            sum += std::pow(a.signals[c.simulated][k] - b.signals[c.simulated][k], 2);
          const double change = std::sqrt(sum / static_cast<double>(c.measured.size())) / c.noise;
          if (change > most) {
            most = change;
            where = std::string(info(c.signal).name) + " of " + logs[l].path.substr(logs[l].path.rfind('/') + 1);
          }
        }
    std::printf("%2d %-26s %9.3g noises, %s\n", r + 1, table[r].name.c_str(), most, where.c_str());
    // What is smaller than the noise of one sample over a whole log no fit can see.
    EXPECT_GT(most, 1.0) << table[r].name;
  }
}

TEST(ShippedLogs, HalvingTheStepConverges) {
  for (const char* name :
       {"healthy/h01_steps_large", "healthy/h02_steps_small", "healthy/h04_multisine", "healthy/h05_prbs",
        "healthy/h08_preflight_cold", "healthy/h10_flight", "healthy/h12_mixed", "fault/f08_sticky_spool_severe"}) {
    const LogData log = slice(shipped_data(name), 0, 1200);
    const ParameterVector v = nominal_candidate();
    SimulateOptions coarse, half, fine;
    half.step = coarse.step / 2, half.impact_step = coarse.impact_step / 2;
    fine.step = fine.impact_step = 1e-5;
    const Trajectory a = simulate(log.scenario, v, coarse), b = simulate(log.scenario, v, half),
                     exact = simulate(log.scenario, v, fine);
    ASSERT_TRUE(a.ok && b.ok && exact.ok);
    std::printf("%s:", name);
    for (const FitChannel& c : log.channels) {
      const auto rms = [&](const Trajectory& t) {
        std::vector<double> e(c.measured.size());
        for (std::size_t k = 0; k < e.size(); ++k) e[k] = t.signals[c.simulated][k] - exact.signals[c.simulated][k];
        if (c.high_pass > 0) e = high_passed(log.scenario.time, e, c.high_pass);
        double sum = 0;
        for (double x : e) sum += x * x;
        return std::sqrt(sum / static_cast<double>(e.size())) / c.noise;
      };
      const double at_default = rms(a), at_half = rms(b);
      std::printf("  %s %.2f -> %.2f", std::string(info(c.signal).name).c_str(), at_default, at_half);
      // In noises of one sample. The model's own error on a healthy log is some ten of them (cf. `tune`), so an
      // integration error of this size is not what limits a fit.
      EXPECT_LT(at_default, 3.0) << name << ' ' << info(c.signal).name;
      EXPECT_LT(at_half, std::max(0.75 * at_default, 0.2)) << name << ' ' << info(c.signal).name;
    }
    std::printf(" noises\n");
  }
}

TEST(ShippedLogs, NoFailureInRandomTablesInsideTheBox) {
  const Table table = shipped_table();
  const LogData log = slice(shipped_data("healthy/h01_steps_large"), 0, 700);
  constexpr int count = 512;
  std::vector<ParameterVector> v;
  for (int i = 0; i < count; ++i) {
    Random random(31, static_cast<std::uint32_t>(i));
    v.push_back(candidate_of(table));
    for (int r = 0; r < n_parameters; ++r) v.back()[r] = from_unit(table[r], random.uniform());
    if (i % 2)
      for (const EffectInfo& e : effect_list())
        for (std::size_t j = 0; j < e.parameters.size(); ++j)
          v.back()[e.first + static_cast<int>(j)] = random.uniform(e.parameters[j].lower, e.parameters[j].upper);
  }
  std::vector<Trajectory> t(count);
  std::vector<Job> jobs;
  for (int i = 0; i < count; ++i) jobs.push_back({&log.scenario, &v[i], &t[i]});
  simulate(jobs);
  int failed = 0;
  for (int i = 0; i < count; ++i) {
    bool sane = t[i].ok;
    for (const auto& signal : t[i].signals)
      for (double x : signal) sane = sane && std::isfinite(x);
    if (sane) continue;
    ++failed;
    std::printf("candidate %d fails at %.4f s:", i, t[i].failed_at);
    for (int r = 0; r < n_parameters; ++r)
      if (const double u = to_unit(table[r], v[i][r]); u < 0.05 || u > 0.95)
        std::printf(" %s=%.3g", table[r].name.c_str(), v[i][r]);
    std::printf("\n");
  }
  std::printf("%d of %d random tables failed\n", failed, count);
  EXPECT_EQ(failed, 0);
}

}  // namespace
}  // namespace servodx
