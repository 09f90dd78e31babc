// Runs that only rank, in floats and by longer steps, put candidates in the order of the runs that fits take: over the
// box, and among children of an elite, where costs lie close together. That is all they are for.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/random.h"
#include "effects/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "shipped_data.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

std::vector<double> ranks(const std::vector<double>& v) {
  std::vector<std::size_t> order(v.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return v[a] < v[b]; });
  std::vector<double> rank(v.size());
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<double>(k);
  return rank;
}

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> x = ranks(a), y = ranks(b);
  const auto n = static_cast<double>(a.size());
  double square = 0;
  for (std::size_t k = 0; k < x.size(); ++k) square += (x[k] - y[k]) * (x[k] - y[k]);
  return 1.0 - 6.0 * square / (n * (n * n - 1.0));
}

// Spool, piston and pressures against the log, each by its noise.
double cost_of(const LogData& log, const Trajectory& t) {
  double sum = 0;
  for (const FitChannel& c : log.channels)
    for (std::size_t k = 0; k < c.measured.size(); ++k) {
      const double e = (c.measured[k] - t.signals[c.simulated][k]) / c.noise;
      if (e == e) sum += e * e;
    }
  return sum;
}

struct Costs {
  std::vector<double> fitted, ranked;
  int differ = 0;
};

// Candidates within `width` of the box about the table's values (1: all over the box), some with effects on.
Costs costs_of(const LogData& log, double width) {
  const Table table = shipped_table();
  std::vector<ParameterVector> v;
  for (std::uint32_t i = 0; i < 128; ++i) {
    Random random(23, i);
    ParameterVector one = candidate_of(table);
    for (int r = 0; r < n_parameters; ++r) {
      if (!table[r].estimate) continue;
      const double from =
          width < 1 ? coordinate(table[r]).to_unit(table[r].nominal) + width * random.normal() : random.uniform();
      one[r] = coordinate(table[r]).from_unit(std::clamp(from, 0.0, 1.0));
    }
    if (i % 2)
      for (const char* name : {"magnetic_hysteresis", "armature_angle", "mount_compliance", "edge_transition",
                               "orifice_length", "screen_drop"})
        for (const EffectInfo& e : effect_list())
          for (std::size_t j = 0; e.name == std::string(name) && j < e.parameters.size(); ++j)
            one[e.first + static_cast<int>(j)] = e.parameters[j].start * (1 + width * random.uniform());
    v.push_back(std::move(one));
  }
  Costs out;
  std::vector<Trajectory> t(v.size()), f(v.size());
  std::vector<Job> jobs, ranked;
  for (std::size_t i = 0; i < v.size(); ++i)
    jobs.push_back({&log.scenario, &v[i], &t[i]}), ranked.push_back({&log.scenario, &v[i], &f[i]});
  simulate(jobs);
  simulate(ranked, ranking_steps({}));
  for (std::size_t i = 0; i < v.size(); ++i) {
    EXPECT_EQ(t[i].ok, f[i].ok) << i;
    if (!t[i].ok || !f[i].ok) continue;
    out.fitted.push_back(cost_of(log, t[i]));
    out.ranked.push_back(cost_of(log, f[i]));
    out.differ += out.fitted.back() != out.ranked.back();
  }
  return out;
}

TEST(Ranking, OrdersCandidatesAsFitsDo) {
  for (const char* name : {"healthy/h05_prbs", "healthy/h10_flight", "healthy/h12_mixed"}) {
    const LogData log = slice(shipped_data(name), 0, 1500);
    for (const double width : {1.0, 0.05, 0.005}) {
      const Costs c = costs_of(log, width);
      const double correlation = rank_correlation(c.fitted, c.ranked);
      std::printf("%-20s width %.3f: %zu sets, rank correlation %.6f\n", name, width, c.fitted.size(), correlation);
      EXPECT_GT(c.fitted.size(), 120u);
      EXPECT_GT(correlation, 0.999) << name << ", width " << width;
      EXPECT_GT(c.differ, 100);
    }
  }
}

}  // namespace
}  // namespace servodx
