// Candidates near a run that follow its steps: the derivative of the discrete run itself, along every parameter.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/random.h"
#include "effects/registry.h"
#include "effects/transport_delay.h"
#include "effects/unexplained.h"
#include "laws/bench.h"
#include "model/asperities.h"
#include "model/constants.h"
#include "model/derived.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/instruction_set.h"
#include "servodx/rig.h"
#include "simulate/gradient.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"
#include "simulate/system.h"
#include "simulate/together.h"

namespace servodx {
namespace {

ParameterVector with_named_effects(ParameterVector v) {
  const ParameterVector off = v;
  v = with_effects(v);
  for (int k = effect_row<Unexplained>(0); k < n_values; ++k) v[k] = off[k];  // a learnt curve has no followers
  v[effect_row<TransportDelay>(0)] = 1.7e-3;                                  // whole samples are a corner
  return v;
}

// Every entry of the gradient, and that there is no other, by numbers that carry all derivatives.
template <class Effects>
void gradient_equals_jet(const ParameterVector& v) {
  using V = Variables<Effects>;
  using G = Gradient<double, Effects>;
  using Jet = ceres::Jet<double, V::size>;
  constexpr int n = V::n;
  const Bench<Effects> bench(v);
  std::vector<char> met(G::entries, 0);
  for (unsigned trial = 0; trial < 40; ++trial) {
    Random random(37, trial);
    const auto y = bench.state(random);
    Inputs<double> u = bench.inputs(random);
    FrictionMemory<double>& m = u.friction;
    m.spool_anchor = y[s_x_spool] + random.uniform(-1.5, 1.5) * constants::spool_presliding;
    m.spool_speed = random.uniform(-0.02, 0.02);
    for (int i = 0; i < V::n_seals; ++i)
      m.seal_anchor[i] = y[s_x_piston] + random.uniform(-1.5, 1.5) * constants::seal_presliding[i];
    m.seal_breakaway = random.uniform(0, 1), m.seal_per_reach = random.uniform(0.3, 1);
    std::array<double, G::entries> g;
    G::at(y, u, v.data(), bench.derived(), g);

    std::array<Jet, n> states;
    for (int i = 0; i < n; ++i) states[i] = Jet(y[i], i);
    std::array<Jet, n_parameters + Effects::n_parameters> rows;
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = Jet(v[k], V::rows + static_cast<int>(k));
    Derived<Jet> d;
#define X(name, unit, meaning) d.name = Jet(bench.derived().name, V::derived + number_##name);
    SERVODX_DERIVED(X)
#undef X
    Inputs<Jet> in{Jet(u.current, V::current), Jet(u.supply_pressure, V::supply_pressure),
                   Jet(u.return_pressure, V::return_pressure), Jet(u.load_force)};
    in.friction.spool_anchor = Jet(m.spool_anchor, V::spool_anchor);
    in.friction.spool_speed = Jet(m.spool_speed, V::spool_speed);
    for (int i = 0; i < V::n_seals; ++i) in.friction.seal_anchor[i] = Jet(m.seal_anchor[i], V::seal_anchor + i);
    in.friction.seal_breakaway = Jet(m.seal_breakaway, V::seal_breakaway);
    in.friction.seal_per_reach = Jet(m.seal_per_reach, V::seal_per_reach);
    const auto rates = derivative<Effects, Jet>(PlainStates<n, Jet>{states}, in, rows.data(), d);
    unroll<n>([&](auto i) {
      const Jet& stated = std::get<i>(rates);
      // What cancels in a sum of large terms is rounding in both.
      for (int k = 0, e = G::layout.first[i]; k < V::size; ++k) {
        const bool held = holds(G::masks[i], k);
        const double value = held ? g[e] : 0.0;
        EXPECT_NEAR(value, stated.v[k], 1e-8 * std::abs(stated.v[k])) << "f" << i << " by " << k << ", " << trial;
        if (held) met[e] |= value != 0.0, ++e;
      }
    });
  }
  for (int e = 0; e < G::entries; ++e) EXPECT_TRUE(met[e]) << "entry by " << G::variable_of[e] << " is never met";
}
TEST(StepDerivative, GradientEqualsJet) { gradient_equals_jet<NoEffects>(lively()); }
TEST(StepDerivative, GradientWithEveryEffectEqualsJet) { gradient_equals_jet<AllEffects>(with_effects(lively())); }

Scenario lively_log() {
  return made(
      1.2, 1e-3,
      [](double t) {
        return 0.006 * std::sin(2 * M_PI * 1.3 * t) + 0.004 * std::sin(2 * M_PI * 17 * t) + (t > 0.6 ? 0.004 : 0.0);
      },
      [](double t) { return 1500 * std::sin(2 * M_PI * 1.1 * t); });
}

struct Moved {
  std::string name;
  int at;
  double by;
};
// Each number of a candidate by a small part of its size.
std::vector<Moved> every_number(const ParameterVector& v, bool effects) {
  std::vector<Moved> out;
  const auto add = [&](std::string name, int at, double size) { out.push_back({std::move(name), at, 1e-5 * size}); };
  for (int k = 0; k < n_parameters; ++k)
    add(std::string(parameter_list[k].name), k,
        v[k] != 0                              ? std::abs(v[k])
        : k >= row::lap_pa && k <= row::lap_bt ? 1e-5
                                               : 1e-2);
  if (effects)
    for (const EffectInfo& e : effect_list())
      if (e.name != Unexplained::name)
        for (std::size_t j = 0; j < e.parameters.size(); ++j) {
          const double start = std::abs(e.parameters[j].start);
          add(e.parameters[j].name, e.first + static_cast<int>(j), start > 0 ? start : e.parameters[j].upper);
        }
  const double nuisances[] = {1, 1e-6, 1e4, 1e4, 1e4, 1e4, 1e-6, 1e4, 1e4, 1e-2};
  for (int k = 0; k < n_candidate - n_values; ++k) add("nuisance " + std::to_string(k), n_values + k, nuisances[k]);
  return out;
}

std::vector<Trajectory> run_each(const Scenario& s, const ParameterVector& v, const std::vector<Moved>& moved,
                                 double times, bool near, int threads = 1) {
  std::vector<ParameterVector> c(moved.size(), v);
  std::vector<Trajectory> t(moved.size());
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    c[i][moved[i].at] += times * moved[i].by;
    jobs.push_back({&s, &c[i], &t[i]});
  }
  SimulateOptions o;
  o.threads = threads;
  Trajectory of_base;
  const NearJobs of_log{&v, jobs, &of_base};
  if (near)
    simulate_near(std::span(&of_log, 1), o);
  else
    simulate(jobs, o);
  return t;
}

void followers_equal_central_differences(const ParameterVector& v, bool effects) {
  if (instruction_set() == "generic") GTEST_SKIP() << "no packs of floats here: followers are runs of their own";
  Scenario s = lively_log();
  s.spool_start = 2e-6, s.pressure_a_start = 1.02e7, s.pressure_b_start = 1.05e7;
  s.oil = oil_at(860, 14e-6, 298.15);  // at 40 degC the slope of its viscosity moves nothing
  const std::vector<Moved> moved = every_number(v, effects);
  const auto near = run_each(s, v, moved, 1, true), above = run_each(s, v, moved, 1, false),
             below = run_each(s, v, moved, -1, false);
  const Trajectory base = simulate(s, v);
  std::vector<double> errors;
  std::set<std::string> silent;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    ASSERT_TRUE(near[i].ok && above[i].ok && below[i].ok) << moved[i].name;
    bool acts = false;
    for (int c : {0, 1, 2, 3}) {
      double off = 0, size = 0, forward = 0;
      for (std::size_t k = 0; k < s.time.size(); ++k) {
        const double one = near[i].signals[c][k] - base.signals[c][k];
        const double central = (above[i].signals[c][k] - below[i].signals[c][k]) / 2;
        const double f = above[i].signals[c][k] - base.signals[c][k];
        off += (one - central) * (one - central), size += central * central, forward += (f - central) * (f - central);
      }
      const double unit = c < 2 ? 1e-12 : 1e-1;  // [m], [Pa] a difference below is rounding
      if (size <= unit * unit * static_cast<double>(s.time.size())) {
        EXPECT_LE(off, 4 * unit * unit * static_cast<double>(s.time.size())) << moved[i].name << " on " << c;
        continue;
      }
      acts = true;
      errors.push_back(std::sqrt(off / size));
      // What is around the steps is moved, not derived: there a forward difference says how far that carries.
      EXPECT_LT(errors.back(), std::max(5e-4, 2 * std::sqrt(forward / size))) << moved[i].name << " on " << c;
    }
    if (!acts) silent.insert(moved[i].name);
  }
  std::sort(errors.begin(), errors.end());
  std::printf(
      "[ %zu numbers, %zu responses: median %.1e, 9 in 10 below %.1e, largest %.1e of the central difference ]\n",
      moved.size(), errors.size(), errors[errors.size() / 2], errors[errors.size() * 9 / 10], errors.back());
  EXPECT_LT(errors[errors.size() / 2], 1e-5);
  EXPECT_LT(errors[errors.size() * 9 / 10], 1e-4);
  // What no channel shows here: an amplifier below its limit, and what belongs to signals that are not asked for.
  std::set<std::string> unseen = {"current_limit", "nuisance 4", "nuisance 5"};
  if (effects) unseen.merge(std::set<std::string>{"control_flow_lag", "leakage_flow_lag"});
  EXPECT_EQ(silent, unseen);
}
TEST(StepDerivative, FollowersEqualCentralDifferencesOfTheRun) { followers_equal_central_differences(lively(), false); }
TEST(StepDerivative, FollowersEqualCentralDifferencesWithEveryEffect) {
  followers_equal_central_differences(with_named_effects(lively()), true);
}

void expect_same_bits(const Trajectory& a, const Trajectory& b, const std::string& what) {
  ASSERT_EQ(a.ok, b.ok) << what;
  for (int c = 0; c < n_simulated; ++c) EXPECT_EQ(a.signals[c], b.signals[c]) << what << ", signal " << c;
}

TEST(StepDerivative, FollowersAreTheSameBitsInAnyCompanyOnAnyThreads) {
  const Scenario s = lively_log();
  const ParameterVector v = lively();
  const std::vector<Moved> all = every_number(v, false);
  const auto one = run_each(s, v, all, 1, true, 1), two = run_each(s, v, all, 1, true, 2);
  std::vector<Moved> fewer(all.rbegin(), all.rend() - 20);
  const auto reversed = run_each(s, v, fewer, 1, true, 3);
  for (std::size_t i = 0; i < all.size(); ++i) expect_same_bits(one[i], two[i], all[i].name);
  for (std::size_t i = 0; i < fewer.size(); ++i) expect_same_bits(one[all.size() - 1 - i], reversed[i], fewer[i].name);
}

TEST(StepDerivative, WhatIsNotOffTheRunStaysOnIt) {
  const Scenario s = lively_log();
  const ParameterVector v = with_named_effects(lively());
  const std::vector<Moved> nothing(30, {"nothing", 0, 0.0});
  const Trajectory base = simulate(s, v);
  for (const Trajectory& t : run_each(s, v, nothing, 1, true))
    for (int c : {0, 1, 2, 3})
      for (std::size_t k = 0; k < s.time.size(); ++k)
        ASSERT_NEAR(t.signals[c][k], base.signals[c][k], 1e-13 * (c < 2 ? 1e-1 : 1e7)) << c << ' ' << k;
}

TEST(StepDerivative, AFewOnAStandWithACurveAndInCompanyRunByThemselves) {
  const ParameterVector v = lively();
  const std::vector<Moved> all = every_number(v, false), few(all.begin(), all.begin() + 20);
  const auto compare = [](const Scenario& s, const ParameterVector& at, const std::vector<Moved>& moved) {
    const auto own = run_each(s, at, moved, 1, false), near = run_each(s, at, moved, 1, true);
    for (std::size_t i = 0; i < moved.size(); ++i) expect_same_bits(own[i], near[i], moved[i].name);
  };
  Scenario s = lively_log();
  compare(s, v, few);
  ParameterVector curved = v;
  curved[effect_row<Unexplained>(4)] = 5;
  compare(s, curved, all);
  together(2, 2, [&](int) { compare(s, v, all); });
  s.ports = Ports::blocked;
  s.time.resize(100), s.command.resize(100), s.load_force.resize(100);
  compare(s, v, all);
}

TEST(StepDerivative, ARunThatFailsTakesItsFollowersWithIt) {
  if (instruction_set() == "generic") GTEST_SKIP() << "no packs of floats here: followers are runs of their own";
  const Scenario s = lively_log();
  const ParameterVector sane = lively();
  ParameterVector broken = sane;
  broken[row::moving_mass] = -1;  // runs away
  const Trajectory alone = simulate(s, broken);
  ASSERT_FALSE(alone.ok);
  ASSERT_GT(alone.failed_at, s.time[0]);
  // Candidates that would run by themselves follow a run that fails.
  std::vector<ParameterVector> c(30, sane);
  std::vector<Trajectory> t(c.size());
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < c.size(); ++i) jobs.push_back({&s, &c[i], &t[i]});
  Trajectory of_base;
  const NearJobs of_log{&broken, jobs, &of_base};
  simulate_near(std::span(&of_log, 1), {});
  for (const Trajectory& one : t) {
    EXPECT_FALSE(one.ok);
    EXPECT_LE(one.failed_at, alone.failed_at);
  }
}

TEST(StepDerivative, AFollowerThatFailsLeavesTheOthersTheirBits) {
  if (instruction_set() == "generic") GTEST_SKIP() << "no packs of floats here: followers are runs of their own";
  const Scenario s = lively_log();
  const ParameterVector v = lively();
  std::vector<Moved> all = every_number(v, false);
  const auto before = run_each(s, v, all, 1, true);
  all[3].by *= 1e12;
  const auto after = run_each(s, v, all, 1, true);
  EXPECT_FALSE(after[3].ok);
  EXPECT_GE(after[3].failed_at, s.time[0]);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i != 3) expect_same_bits(before[i], after[i], all[i].name);
}

TEST(StepDerivative, LogsOfAnyLengthSideBySideAreTheSameBits) {
  const ParameterVector v = lively();
  const std::vector<Moved> all = every_number(v, false);
  std::vector<Scenario> logs(4, lively_log());
  logs[1].supply_pressure.assign(logs[1].time.size(), 2.05e7);
  for (const auto& [log, samples] : {std::pair{2, 2}, std::pair{3, 301}})
    logs[log].time.resize(samples), logs[log].command.resize(samples), logs[log].load_force.resize(samples);
  std::vector<ParameterVector> c(all.size(), v);
  for (std::size_t i = 0; i < all.size(); ++i) c[i][all[i].at] += all[i].by;
  std::vector<std::vector<Trajectory>> t(logs.size(), std::vector<Trajectory>(all.size()));
  std::vector<std::vector<Job>> jobs(logs.size());
  std::vector<Trajectory> of_base(logs.size());
  std::vector<NearJobs> near;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    for (std::size_t i = 0; i < all.size(); ++i) jobs[l].push_back({&logs[l], &c[i], &t[l][i]});
    near.push_back({&v, jobs[l], &of_base[l]});
  }
  simulate_near(near, {});
  for (std::size_t l = 0; l < logs.size(); ++l) {
    const auto alone = run_each(logs[l], v, all, 1, true);
    for (std::size_t i = 0; i < all.size(); ++i) expect_same_bits(alone[i], t[l][i], all[i].name);
  }
}

}  // namespace
}  // namespace servodx
