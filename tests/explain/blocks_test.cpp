// Block by block: what is missing shows in its own block, in size and kind, and in no other.
#include <gtest/gtest.h>

#include <cmath>

#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/support.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "simulate/balance.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

Balance replayed(const LogData& written, const ParameterVector& table) {
  Measured m;
  for (const FitChannel& c : written.channels) {
    if (c.signal == Signal::spool_position) m.spool = &c.measured;
    if (c.signal == Signal::piston_position) m.piston = &c.measured;
    if (c.signal == Signal::pressure_a) m.pressure_a = &c.measured;
    if (c.signal == Signal::pressure_b) m.pressure_b = &c.measured;
  }
  return balance(written.scenario, m, table, 20e-3);
}

// A log's inputs, run at `truth`; replayed with the shipped table's values.
struct Rehearsal {
  LogData log;
  ParameterVector table, truth;
  Rehearsal() : log(shipped_data("healthy/h10_flight")), table(candidate_of(shipped_table())), truth(table) {}
  Balance replay() { return replayed(written_by_model(log, truth, 5), table); }
};
double rms(const std::vector<double>& x) {
  double sum = 0;
  for (double v : x) sum += v * v;
  return std::sqrt(sum / static_cast<double>(x.size()));
}
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double xx = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) xx += x[k] * x[k], xy += x[k] * y[k];
  return xy / xx;
}

TEST(Blocks, NothingIsMissingInWhatTheModelWrote) {
  Rehearsal r;
  const Balance b = r.replay();
  ASSERT_GT(b.time.size(), 50u);
  const double area = r.table[row::piston_area_a];
  EXPECT_LT(rms(b.flow_a), 0.05 * area * rms(b.velocity));
  EXPECT_LT(rms(b.flow_b), 0.05 * area * rms(b.velocity));
  EXPECT_LT(rms(b.force), 0.02 * area * r.table[row::supply_pressure]);
}

TEST(Blocks, SamplesThatTheLogLacksAreMissingInNoBlock) {
  Rehearsal r;
  const Balance whole = r.replay();
  // One sample in twenty is gone, some with their neighbours.
  const auto drop = [](std::size_t k) { return k > 0 && (k % 40 == 7 || (k % 200 > 100 && k % 200 < 108)); };
  const auto thin = [&](std::vector<double>& x) {
    std::vector<double> out;
    for (std::size_t k = 0; k < x.size(); ++k)
      if (!drop(k)) out.push_back(x[k]);
    if (!x.empty()) x = out;
  };
  LogData written = written_by_model(r.log, r.truth, 5);
  for (FitChannel& c : written.channels) thin(c.measured);
  Scenario& s = written.scenario;
  for (std::vector<double>* x : {&s.command, &s.supply_pressure, &s.return_pressure, &s.load_force, &s.time}) thin(*x);
  for (FitChannel& c : written.channels)  // and some are not numbers
    for (std::size_t k = 500; k < c.measured.size(); k += 300)
      for (std::size_t j = k; j < std::min(k + 10, c.measured.size()); ++j) c.measured[j] = std::nan("");
  const Balance b = replayed(written, r.table);
  ASSERT_GT(b.time.size(), 30u);
  EXPECT_LT(rms(b.force), 1.3 * rms(whole.force));
  EXPECT_LT(rms(b.flow_a), 1.3 * rms(whole.flow_a));
  EXPECT_LT(rms(b.flow_b), 1.3 * rms(whole.flow_b));
}

TEST(Blocks, LeakageOfTheSealIsMissingInBothFlowsAndInNoForce) {
  Rehearsal r;
  const Balance healthy = r.replay();
  constexpr double leak = 4e-12;  // [m3/s/Pa]
  r.truth[row::cross_piston_leakage] += leak * r.log.scenario.oil.viscosity_ratio;
  const Balance b = r.replay();
  EXPECT_NEAR(slope(b.load_pressure, b.flow_a), -leak, 0.1 * leak);
  EXPECT_NEAR(slope(b.load_pressure, b.flow_b), leak, 0.1 * leak);
  EXPECT_LT(rms(b.force), 1.3 * rms(healthy.force));
}

TEST(Blocks, FrictionOfTheSealIsMissingInTheForceAlone) {
  Rehearsal r;
  const Balance healthy = r.replay();
  constexpr double more = 800;  // [N]
  r.truth[row::piston_coulomb_friction] += more;
  const Balance b = r.replay();
  double against = 0, moving = 0;
  for (std::size_t k = 0; k < b.time.size(); ++k)
    if (std::abs(b.velocity[k]) > 0.02) against -= b.force[k] * (b.velocity[k] > 0 ? 1 : -1), ++moving;
  ASSERT_GT(moving, 10);
  EXPECT_NEAR(against / moving, more, 0.15 * more);
  EXPECT_LT(rms(b.flow_a), 1.3 * rms(healthy.flow_a));
}

TEST(Blocks, SpoolThatTheLogLacksHidesTheFlowsOnly) {
  Rehearsal r;
  const LogData written = written_by_model(r.log, r.truth, 5);
  Measured m;
  for (const FitChannel& c : written.channels) {
    if (c.signal == Signal::piston_position) m.piston = &c.measured;
    if (c.signal == Signal::pressure_a) m.pressure_a = &c.measured;
    if (c.signal == Signal::pressure_b) m.pressure_b = &c.measured;
  }
  const Balance b = balance(written.scenario, m, r.table, 20e-3);
  EXPECT_TRUE(b.flow_a.empty());
  EXPECT_FALSE(b.force.empty());
}

}  // namespace
}  // namespace servodx
