// What is absent changes nothing, to the bit; a lane of a batch is the run alone, to the bit; and instruction sets,
// whose roots and products round differently, agree far below anything that a log can show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/random.h"
#include "effects/line_inertia.h"
#include "effects/registry.h"
#include "effects/row_effects.h"
#include "effects/unexplained.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "laws/bench.h"
#include "laws/kernel_scalar.h"
#include "model/hooks.h"
#include "model/state.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/instruction_set.h"
#include "shipped_data.h"
#include "simulate/choose_kernel.h"
#include "simulate/kernels.h"
#include "simulate/pack_run.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"
#include "simulate/together.h"

namespace servodx {
namespace {

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}
bool same_bits(const Trajectory& a, const Trajectory& b) {
  if (a.ok != b.ok || a.failed_at != b.failed_at) return false;
  for (int c = 0; c < n_simulated; ++c)
    if (!same_bits(a.signals[c], b.signals[c])) return false;
  return true;
}

// A lively piece of each sort of log, with measured supply and without.
std::vector<LogData> pieces() {
  std::vector<LogData> out;
  for (const char* name : {"healthy/h12_mixed", "healthy/h15_no_supply_signals", "healthy/h10_flight"})
    out.push_back(slice(shipped_data(name), 200, 700));
  return out;
}

Trajectory run(RunPack kernel, const Scenario& s, const ParameterVector& v) {
  Trajectory t;
  const ParameterVector* candidates[] = {&v};
  Trajectory* results[] = {&t};
  kernel(s, candidates, results, 1, all_signals());
  return t;
}

TEST(OffValues, EveryEffectAtItsOffValueChangesNoBit) {
  ParameterVector off = nominal_candidate();
  for (const RowEffect& e : row_effects())  // what shapes a row shows where the row is not at its off value
    if (!e.shapes.empty())
      for (const int at : e.rows) off[at] = 100.0;
  for (const LogData& log : pieces()) {
    const Trajectory base = simulate(log.scenario, off, all_signals());
    ASSERT_TRUE(base.ok);
    for (const EffectInfo& e : effect_list()) {
      // What only shapes an effect may take any value while the effect is off.
      ParameterVector shaped = off, on = off;
      for (std::size_t j = 0; j < e.parameters.size(); ++j) {
        on[e.first + static_cast<int>(j)] = e.parameters[j].start;
        if (!e.parameters[j].switches) shaped[e.first + static_cast<int>(j)] = e.parameters[j].upper;
      }
      EXPECT_TRUE(same_bits(base, simulate(log.scenario, shaped, all_signals()))) << e.name;
      EXPECT_FALSE(same_bits(base, simulate(log.scenario, on, all_signals()))) << e.name << " does nothing";
    }
  }
}

TEST(OffValues, EveryEffectAtItsOffValueChangesNoBitOfTheRightHandSide) {
  const ParameterVector off = nominal_candidate();
  const Bench<NoEffects> base(off);
  const Bench<AllEffects> extended(off);
  for (unsigned trial = 0; trial < 500; ++trial) {
    Random random(37, trial);
    const auto y = base.state(random);
    const auto u = base.inputs(random);
    Bench<AllEffects>::Y z{};  // the effects' own states rest at zero
    std::copy(y.begin(), y.end(), z.begin());
    const auto f = base.rate(y, u);
    const auto g = extended.rate(z, u);
    EXPECT_EQ(std::memcmp(f.data(), g.data(), sizeof f), 0) << trial;
    for (int k = n_base_states; k < Bench<AllEffects>::n; ++k) EXPECT_EQ(g[k], 0.0) << trial;
  }
}

// The kernel that carries the effect, with the effect at its off value; not the dispatch to the base kernel.
template <class E>
void runs_as_the_base_model() {
  const ParameterVector nominal = nominal_candidate();
  ParameterVector off = nominal;  // laid out for a list of this effect alone
  for (int j = 0; j < E::n_parameters; ++j) off[n_parameters + j] = E::parameters[j].off;
  for (const LogData& log : pieces()) {
    const Trajectory base = run(kernels_scalar()[Need::base].run, log.scenario, nominal);
    const Trajectory with = run(&run_pack<double, EffectList<E>>, log.scenario, off);
    if (E::n_states == 0) {
      EXPECT_TRUE(same_bits(base, with)) << E::name;
      continue;
    }
    // A state more changes the order of elimination in the stepper, and with it the last bits, though the equations
    // are the same to the bit.
    ASSERT_TRUE(with.ok);
    for (int c = 0; c < n_simulated; ++c) {
      double largest = 0, worst = 0;
      for (std::size_t k = 0; k < base.signals[c].size(); ++k) {
        largest = std::max(largest, std::abs(base.signals[c][k]));
        worst = std::max(worst, std::abs(base.signals[c][k] - with.signals[c][k]));
      }
      EXPECT_LE(worst, 1e-9 * largest) << E::name << ' ' << info(simulated_signals[c]).name;
    }
  }
}
template <class... E>
void each_runs_as_the_base_model(EffectList<E...>) {
  (runs_as_the_base_model<E>(), ...);
}

TEST(OffValues, KernelOfAnEffectAtItsOffValueRunsAsTheBaseModel) {
  each_runs_as_the_base_model(Append<AllEffects, LineInertia>{});
}

TEST(OffValues, EveryFaultAtItsHealthySeverityChangesNoBit) {
  const ParameterVector healthy = nominal_candidate();
  const std::vector<LogData> logs = pieces();
  for (const Fault* fault : fault_list()) {
    ParameterVector absent = healthy, worst = healthy;
    fault->apply(absent.data(), fault->healthy);
    fault->apply(worst.data(), fault->worst);
    EXPECT_TRUE(same_bits(healthy, absent)) << fault->name;
    bool shows = false;
    for (const LogData& log : logs) {
      const Trajectory base = simulate(log.scenario, healthy, all_signals());
      EXPECT_TRUE(same_bits(base, simulate(log.scenario, absent, all_signals()))) << fault->name;
      shows = shows || !same_bits(base, simulate(log.scenario, worst, all_signals()));
    }
    EXPECT_TRUE(shows) << fault->name << " at its worst does nothing";
  }
}

// Candidates that differ, some with effects on and learnt curves of two kinds, so that packs of several kernels and
// part-filled packs occur.
std::vector<ParameterVector> candidates(int count) {
  const Table table = shipped_table();
  std::vector<ParameterVector> out;
  for (int i = 0; i < count; ++i) {
    Random random(19, static_cast<std::uint32_t>(i));
    ParameterVector v = candidate_of(table);
    for (int r = 0; r < n_parameters; ++r) {
      const double u = coordinate(table[r]).to_unit(table[r].nominal) + random.uniform(-0.1, 0.1);
      v[r] = coordinate(table[r]).from_unit(std::clamp(u, 0.0, 1.0));
    }
    v[nuisance::command_slope] = random.uniform();
    v[nuisance::spool_offset] = random.uniform(-2e-6, 2e-6);
    if (i % 7 > 4)
      for (const EffectInfo& e : effect_list())
        for (std::size_t j = 0; j < e.parameters.size(); ++j)
          v[e.first + static_cast<int>(j)] =
              e.parameters[j].start * (e.name == Unexplained::name && j < 3 ? 1.0 : random.uniform(0.5, 1.5));  // codes
    if (i % 7 == 6) v[effect_row<Unexplained>(1)] = Unexplained::spool_position;
    out.push_back(std::move(v));
  }
  return out;
}

TEST(Batch, LaneEqualsTheRunAloneBitForBitAtAnyThreadCount) {
  const std::vector<ParameterVector> v = candidates(29);
  const std::vector<LogData> logs = pieces();
  SimulateOptions o;
  const auto batch = [&](int threads) {
    std::vector<Trajectory> t(v.size() * logs.size());
    std::vector<Job> jobs;
    for (std::size_t l = 0; l < logs.size(); ++l)
      for (std::size_t i = 0; i < v.size(); ++i) jobs.push_back({&logs[l].scenario, &v[i], &t[l * v.size() + i]});
    o.threads = threads;
    simulate(jobs, o);
    return t;
  };
  std::printf("kernel in use: %s, %d lanes\n", instruction_set().c_str(), pack_width());
  EXPECT_GT(pack_width(), 1);
  for (const bool ranking : {false, true}) {
    o = ranking ? ranking_steps(all_signals()) : all_signals();
    const std::vector<Trajectory> one = batch(1), two = batch(2);
    for (std::size_t l = 0; l < logs.size(); ++l)
      for (std::size_t i = 0; i < v.size(); ++i) {
        const Trajectory alone = simulate(logs[l].scenario, v[i], o);
        EXPECT_TRUE(alone.ok) << i;
        EXPECT_TRUE(same_bits(alone, one[l * v.size() + i])) << "log " << l << ", candidate " << i;
        EXPECT_TRUE(same_bits(alone, two[l * v.size() + i])) << "log " << l << ", candidate " << i << ", two threads";
      }
  }
}

TEST(Batch, TasksTogetherComeOutAsAloneBitForBitInFewerPacks) {
  const std::vector<ParameterVector> v = candidates(29);
  const std::vector<LogData> logs = pieces();
  // Task k runs one candidate after the other, k % 3 + 1 at a time, over its log, some by other steps.
  const auto task = [&](int k, std::vector<Trajectory>& out) {
    SimulateOptions o = all_signals();
    o.threads = 1;
    if (k % 4 == 3) o.step /= 2;
    const LogData& log = logs[k % 2 ? 1 : 0];
    out.resize(v.size());
    const auto stride = static_cast<std::size_t>(k % 3 + 1);
    for (std::size_t i = static_cast<std::size_t>(k); i < v.size(); i += stride) {
      std::vector<Job> jobs;
      for (std::size_t j = i; j < std::min(v.size(), i + stride); ++j) jobs.push_back({&log.scenario, &v[j], &out[j]});
      simulate(jobs, o);
    }
  };
  constexpr int tasks = 12;
  std::vector<std::vector<Trajectory>> alone(tasks);
  const long begun = packs_run();
  for (int k = 0; k < tasks; ++k) task(k, alone[static_cast<std::size_t>(k)]);
  const long packs_alone = packs_run() - begun;
  for (const int threads : {1, 2}) {
    std::vector<std::vector<Trajectory>> joined(tasks);
    const long before = packs_run();
    together(tasks, threads, [&](int k) { task(k, joined[static_cast<std::size_t>(k)]); });
    std::printf("%ld packs together, %ld alone\n", packs_run() - before, packs_alone);
    EXPECT_LT(packs_run() - before, packs_alone);
    for (int k = 0; k < tasks; ++k)
      for (std::size_t i = 0; i < v.size(); ++i)
        EXPECT_TRUE(same_bits(alone[static_cast<std::size_t>(k)][i], joined[static_cast<std::size_t>(k)][i]))
            << "task " << k << ", candidate " << i;
  }
}

// The worst sample, of its signal's range.
double apart(const Trajectory& a, const Trajectory& b) {
  double worst = 0;
  for (int c = 0; c < n_simulated; ++c) {
    const auto [low, high] = std::minmax_element(b.signals[c].begin(), b.signals[c].end());
    for (std::size_t s = 0; s < b.signals[c].size(); ++s)
      worst = std::max(worst, std::abs(a.signals[c][s] - b.signals[c][s]) / (*high - *low));
  }
  return worst;
}

TEST(Batch, TasksThatAreCalledOffEndWhereTheyAre) {
  const std::vector<ParameterVector> v = candidates(4);
  const LogData log = pieces().front();
  const auto rounds_of = [](int k) { return 2 + k; };
  std::vector<int> run(4, 0), ended(4, 0);
  int asked = 0;
  together(
      4, 2,
      [&](int k) {
        const auto at = static_cast<std::size_t>(k);
        for (; run[at] < rounds_of(k); ++run[at]) simulate(log.scenario, v[at], all_signals());
        ended[at] = 1;
      },
      [&] { return ++asked <= 3; });
  EXPECT_EQ(run, (std::vector<int>{2, 3, 3, 3}));
  EXPECT_EQ(ended, (std::vector<int>{1, 1, 0, 0}));
}

TEST(Batch, EveryInstructionSetComputesWhatPlainDoublesDo) {
  constexpr double doubles = 1e-7, floats = 1e-3;  // of a signal's range
  std::vector<std::pair<Kernels, double>> kernels = {{kernels_generic(), doubles}};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    kernels.push_back({kernels_avx2(), doubles});
    kernels.push_back({kernels_avx2_floats(), floats});
  }
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
    kernels.push_back({kernels_avx512(), doubles});
    kernels.push_back({kernels_avx512_floats(), floats});
  }
#endif
  std::vector<ParameterVector> v = candidates(16);
  for (ParameterVector& one : v) one[effect_row<Unexplained>(1)] = Unexplained::piston_velocity;  // a pack, a curve
  const LogData log = pieces().front();
  for (const auto& [k, limit] : kernels)
    for (const Need need : {Need::common, Need::extended, Need::lined, Need::corrected}) {
      if (!k[need].run) continue;  // floats run no curve
      std::vector<Trajectory> t(static_cast<std::size_t>(k.width));
      std::vector<const ParameterVector*> in;
      std::vector<Trajectory*> out;
      for (int i = 0; i < k.width; ++i) in.push_back(&v[i]), out.push_back(&t[i]);
      k[need].run(log.scenario, in.data(), out.data(), k.width, all_signals());
      double worst = 0;
      for (int i = 0; i < k.width; ++i) {
        const Trajectory plain = run(kernels_scalar()[need].run, log.scenario, v[i]);
        ASSERT_TRUE(plain.ok && t[i].ok) << k.name << ' ' << i;
        worst = std::max(worst, apart(t[i], plain));
      }
      EXPECT_LT(worst, limit) << k.name;
      std::printf("%s: %d lanes compared, worst %.1e of a signal's range\n", k.name, k.width, worst);
    }
}

// What the common kernel leaves out is told by the choice of the kernel, and changes nothing where it is off.
TEST(Batch, AKernelWithoutTheRareEffectsRunsAsTheOneThatHasThemOff) {
  const LogData log = pieces().front();
  ParameterVector v = nominal_candidate();
  const auto set = [](ParameterVector& of, const EffectInfo& e, double EffectParameter::*value) {
    for (std::size_t j = 0; j < e.parameters.size(); ++j) of[e.first + static_cast<int>(j)] = e.parameters[j].*value;
  };
  for (const EffectInfo& e : effect_list()) set(v, e, e.rare ? &EffectParameter::off : &EffectParameter::start);
  EXPECT_EQ(need_of(v), Need::common);
  const Trajectory common = run(kernels_scalar()[Need::common].run, log.scenario, v);
  const Trajectory all = run(kernels_scalar()[Need::extended].run, log.scenario, v);
  ASSERT_TRUE(common.ok && all.ok);
  EXPECT_LT(apart(common, all), 1e-7);
  int rare = 0;
  for (const EffectInfo& e : effect_list()) {
    if (!e.rare || e.first >= effect_row<LineInertia>(0)) continue;  // those have kernels of their own
    ParameterVector on = v;
    set(on, e, &EffectParameter::start);
    EXPECT_EQ(need_of(on), Need::extended) << e.name;
    ++rare;
  }
  EXPECT_GE(rare, 1);
}

TEST(Batch, FailingNeighbourLeavesALaneAlone) {
  const LogData log = pieces().front();
  const ParameterVector good = nominal_candidate();
  ParameterVector bad = good;
  bad[row::bulk_modulus] = std::nan("");
  std::vector<Trajectory> t(4);
  const std::vector<Job> jobs = {{&log.scenario, &good, &t[0]},
                                 {&log.scenario, &bad, &t[1]},
                                 {&log.scenario, &good, &t[2]},
                                 {&log.scenario, &bad, &t[3]}};
  simulate(jobs, all_signals());
  EXPECT_FALSE(t[1].ok);
  EXPECT_FALSE(t[3].ok);
  const Trajectory alone = simulate(log.scenario, good, all_signals());
  EXPECT_TRUE(alone.ok);
  EXPECT_TRUE(same_bits(t[0], alone));
  EXPECT_TRUE(same_bits(t[2], alone));
}

}  // namespace
}  // namespace servodx
