// What a log could have shown: the rule from made-up gains, and what is promised beside what fits find.
#include "diagnose/visible.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "diagnose/constants.h"
#include "diagnose/diagnose.h"
#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_fit.h"
#include "diagnose/severity.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "faults/sizes.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/fit_work.h"
#include "fit/log_data.h"
#include "parameters/list.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "shipped_data.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

VisibleFault filter_with(std::vector<SeverityGain> gains) { return {find_fault("clogged_filter"), std::move(gains)}; }

TEST(Visible, LeastFoundIsWhereTheGainsRootPassesTheNeed) {
  const VisibleFault v = filter_with({{0.2, 0}, {0.4, 4}, {0.6, 16}, {0.8, 64}});
  EXPECT_NEAR(*least_found(v, 9), 0.5, 1e-12);
  EXPECT_NEAR(*least_found(v, 16), 0.6, 1e-12);
  EXPECT_NEAR(*least_found(v, 36), 0.7, 1e-12);
  EXPECT_EQ(*least_found(filter_with({{0.2, 20}, {0.4, 30}}), 9), 0.2) << "nothing is promised below what was tried";
}

TEST(Visible, NothingIsPromisedWhereAWorseFaultWouldHide) {
  EXPECT_FALSE(least_found(filter_with({{0.2, 0}, {0.8, 8.9}}), 9));
  EXPECT_FALSE(least_found(filter_with({{0.2, 0}, {0.4, 20}, {0.8, 5}}), 9)) << "the worst is not seen";
  EXPECT_NEAR(*least_found(filter_with({{0.2, 20}, {0.4, 4}, {0.8, 16}}), 9), 0.6, 1e-12);
  EXPECT_FALSE(least_found(filter_with({}), 9));
}

TEST(Visible, OfTwoSidesTheOneSeenLaterCounts) {
  const Fault* null = find_fault("null_shift");
  const std::vector<VisibleFault> sides = {{null, {{0.05, 1}, {0.15, 9}}}, {null, {{-0.05, 1}, {-0.25, 9}}}};
  EXPECT_NEAR(*least_found_either_side(sides, 9), 0.25, 1e-12);
  const std::vector<VisibleFault> blind = {sides[0], {null, {{-0.25, 8}}}};
  EXPECT_FALSE(least_found_either_side(blind, 9));
}

TEST(Visible, HealthTakesWhatItCanInsideItsBoundsAndAtItsPriorsCost) {
  // One number that moves the first sample by 10 from end to end, with a prior of a quarter of its range; it is at 0.9.
  Eigen::MatrixXd jacobian(3, 1);
  jacobian << 10, 0, 4;  // two samples, then the prior
  const HealthyAnswer health(jacobian, {0.9}, 2);
  EXPECT_NEAR(health.left_of(Eigen::Vector2d(0, 3)), 9, 1e-9) << "it cannot move the second sample";
  // Least of (5 + 10 s)^2 + (4 s)^2 over s, at s = -50/116.
  EXPECT_NEAR(health.left_of(Eigen::Vector2d(5, 0)), 25 - 2500.0 / 116, 1e-9);
  // It has a tenth of its range to its wall.
  EXPECT_NEAR(health.left_of(Eigen::Vector2d(-5, 0)), 16 + 0.16, 1e-9);
}

// A log as the model itself would give it with a fault, and noise.
LogData played(const LogData& like, const ParameterVector& base, const Fault* fault, double severity) {
  ParameterVector v = base;
  if (fault) fault->apply(v.data(), severity);
  LogData out = like;
  const Trajectory t = simulate(like.scenario, v, {});
  Random random(7);
  for (FitChannel& c : out.channels)
    for (std::size_t i = 0; i < c.measured.size(); ++i)
      c.measured[i] = t.signals[static_cast<std::size_t>(c.simulated)][i] + c.noise * random.normal();
  return out;
}

// A stretch of a shipped log, with a model that errs by twenty times the noise.
struct Stretch {
  LogData log = slice(prepare(shipped_log("healthy/h01_steps_large"), shipped_rig()), 400, 1300);
  ParameterVector base = candidate_of(read_table(shipped("params/borello2009.csv")));
  ErrorModel error = of_channels();

 private:
  ErrorModel of_channels() const {
    ErrorModel out;
    for (const FitChannel& c : log.channels) out.channels.push_back({c.signal, 20 * c.noise, 0.0, 50.0});
    return out;
  }
};

// The promise is made on the healthy log; the fits are to logs that hold the fault. Noise alone moves a gain's root by
// one deviate.
TEST(Visible, PromisedGainsAreWhatFitsFind) {
  const auto [like, base, error] = Stretch{};
  struct Case {
    const char* name;
    double severity;
  };
  for (const Case& c :
       {Case{"radial_clearance_wear", 4.0}, Case{"torque_motor_loss", 0.8}, Case{"corner_wear", 3e-5}}) {
    const Fault* fault = find_fault(c.name);
    HypothesisSettings settings;
    settings.pairs = false;
    settings.among = {fault};
    const LogData healthy = played(like, base, nullptr, 0), faulty = played(like, base, fault, c.severity);
    const HypothesisFits asked = fit_hypotheses({&healthy}, base, error, settings);
    const HypothesisFits found = fit_hypotheses({&faulty}, base, error, settings);
    ASSERT_EQ(asked.visible.size(), 1u);
    const double gain = found.fits[0].misfit - found.fits[1].misfit;
    const std::optional<double> least = least_found(asked.visible.front(), gain);
    std::printf("%s %.3g: gains %.1f, promised from %.3g on\n", c.name, c.severity, gain, least.value_or(-1));
    ASSERT_TRUE(least) << c.name;
    const auto size = [&](double s) { return std::abs(fault->log_scale ? std::log(s) : s - fault->healthy); };
    EXPECT_NEAR(size(*least) / size(c.severity), 1, 0.25) << c.name;
  }
}

// A fault of a size that health's derivatives still speak of: the fit by them ends where that by its own does, for a
// fraction of the runs. Of the starts the nearest is the one that leaves least once health has moved.
TEST(HypothesisFit, WhatHealthLentFindsAMildFaultForAFractionOfTheRuns) {
  const auto [like, base, error] = Stretch{};
  const Fault* fault = find_fault("torque_motor_loss");
  const LogData faulty = played(like, base, fault, 0.8);
  HypothesisSettings settings;
  const HypothesisData data = hypothesis_data({&faulty}, base, error, settings);
  Attempt health;
  run(health, data, nullptr, settings.iterations);
  FitWork work;
  const std::optional<FitEnd> end = end_of(health.fit, data, work);
  ASSERT_TRUE(end);
  Attempt lent{fault, 0.75}, own{fault, 0.75};
  approach(lent, data, &health.fit, *end, 10);
  run(own, data, &health.fit, settings.iterations);
  ASSERT_TRUE(lent.fit.ok && own.fit.ok);
  const double gain = health.fit.misfit - own.fit.misfit;
  ASSERT_GT(gain, 100);
  EXPECT_NEAR(lent.fit.misfit, own.fit.misfit, 0.05 * gain);
  EXPECT_NEAR(lent.fit.severity, 0.8, 0.02);
  EXPECT_LT(2 * lent.work.simulations, own.work.simulations);
  Screened near{fault, 0.8}, far{fault, 0.5};
  screen(near, data, health.fit, &*end), screen(far, data, health.fit, &*end);
  EXPECT_LT(near.left, near.misfit);
  EXPECT_LT(near.left, far.left);
}

TEST(HypothesisFit, AnIntervalHoldsTheSizeByEitherCount) {
  FaultSize size;
  size.fault = find_fault("radial_clearance_wear");
  size.severity = 8, size.severity_lower = 6, size.severity_upper = 10;
  FreeValue searched;
  searched.lower = size.fault->least, searched.upper = size.fault->worst;
  const auto by = [&](double times) { return counted_in_either(size, times, searched); };
  EXPECT_EQ(by(1.0).severity_lower, 6);
  EXPECT_EQ(by(1.0).severity_upper, 10);
  EXPECT_EQ(by(0.5).severity, 8);
  EXPECT_EQ(by(0.5).severity_lower, 3) << "of the drawing's clearance";
  EXPECT_EQ(by(0.5).severity_upper, 10);
  EXPECT_EQ(by(1.2).severity_lower, 6);
  EXPECT_EQ(by(1.2).severity_upper, 12);
  EXPECT_EQ(by(0.1).severity_lower, searched.lower);
  EXPECT_EQ(by(9.0).severity_upper, searched.upper);
}

TEST(HypothesisFit, AnIntervalIsWidenedByAFactorThatIsOpen) {
  FaultSize size;
  size.severity = 4, size.severity_lower = 2, size.severity_upper = 8;
  FreeValue searched;
  searched.lower = 0.5, searched.upper = 20;
  EXPECT_EQ(widened(size, 0, searched).severity_lower, 2);
  const FaultSize wider = widened(size, 0.5, searched);
  const double half = std::hypot(std::log(2.0), 1.96 * 0.5);
  EXPECT_NEAR(wider.severity_lower, 4 * std::exp(-half), 1e-3);
  EXPECT_NEAR(wider.severity_upper, 4 * std::exp(half), 1e-2);
  EXPECT_EQ(widened(size, 3, searched).severity_lower, 0.5);
  EXPECT_EQ(widened(size, 3, searched).severity_upper, 20);
  size.severity_lower = 0;  // of a scale that begins at nought
  EXPECT_EQ(widened(size, 0.5, searched).severity_lower, 0);
}

// Its leak goes by the oil's viscosity, and the tune took the mean of its logs for 40 degC.
TEST(HypothesisFit, ALeakIsWideWhereNobodyMeasuredTheOil) {
  Stretch of;
  for (ChannelError& c : of.error.channels) c.floor = 0;
  const Fault* fault = find_fault("cylinder_leakage");
  const HypothesisSettings settings;
  const auto upper = [&](bool oil_known) {
    LogData log = played(of.log, of.base, fault, 2e-12);
    log.scenario.oil_known = oil_known;
    Attempt leak{.fault = fault, .start = 2e-12};
    run(leak, hypothesis_data({&log}, of.base, of.error, settings), nullptr, settings.iterations);
    return leak.fit.severity_upper / leak.fit.severity;
  };
  EXPECT_LT(upper(true), 2);
  EXPECT_GT(upper(false), 3);
}

// A seal that is scored need not leak by the oil's viscosity, as a sound one does.
TEST(HypothesisFit, ALeakIsSizedAtTheOilOfTheTestToo) {
  Stretch of;
  for (ChannelError& c : of.error.channels) c.floor = 0;
  const Fault* fault = find_fault("cylinder_leakage");
  constexpr double true_size = 2e-12;
  const HypothesisSettings settings;
  const auto holds = [&](double viscosity_ratio, double size) {
    of.log.scenario.oil.viscosity_ratio = viscosity_ratio;
    const LogData log = played(of.log, of.base, fault, true_size);
    Attempt leak{.fault = fault, .start = true_size};
    run(leak, hypothesis_data({&log}, of.base, of.error, settings), nullptr, settings.iterations);
    return leak.fit.severity_lower <= size && size <= leak.fit.severity_upper;
  };
  EXPECT_TRUE(holds(1, true_size));
  EXPECT_FALSE(holds(1, 0.5 * true_size));
  EXPECT_FALSE(holds(1, 2 * true_size));
  EXPECT_TRUE(holds(2, 0.5 * true_size));
  EXPECT_TRUE(holds(0.5, 2 * true_size));
}

// A leak that a valve of 4 l/min shows is within the tolerance of one of 200 l/min.
TEST(Severity, SizesOfALeakGoWithTheValvesFlow) {
  const Fault& leak = *find_fault("cylinder_leakage");
  ParameterVector small = candidate_of(shipped_table()), large = small;
  large[row::port_width] *= 10;
  const FaultSizes of_small = sizes_of(leak, small.data()), of_large = sizes_of(leak, large.data());
  EXPECT_NEAR(of_large.least, 10 * of_small.least, 1e-9 * of_large.least);
  EXPECT_NEAR(of_large.worst, 10 * of_small.worst, 1e-9 * of_large.worst);
  const Stretch stretch{};
  const auto searched = [&](const ParameterVector& base) {
    return hypothesis_values({&stretch.log}, base, {{&leak, of_small.starts.front()}}, 0.05).front();
  };
  EXPECT_EQ(searched(small).lower, of_small.least);
  EXPECT_EQ(searched(large).lower, of_large.least);
  EXPECT_EQ(searched(large).upper, of_large.worst);
  const auto fixed = sizes_of(*find_fault("null_shift"), large.data());
  EXPECT_EQ(fixed.least, find_fault("null_shift")->least);
}

TEST(HypothesisFit, HealthBegunElsewhereEndsNoHigherByTheDerivativesOfTheFirst) {
  const auto [log, base, error] = Stretch{};
  const HypothesisSettings settings;
  const HypothesisData data = hypothesis_data({&log}, base, error, settings);
  Attempt usual;
  run(usual, data, nullptr, settings.iterations);
  FitWork work;
  const std::optional<FitEnd> end = end_of(usual.fit, data, work);
  ASSERT_TRUE(end);
  for (const int which : {1, 2, 3}) {
    Attempt lent{.scattered = which}, own{.scattered = which};
    approach(lent, data, nullptr, *end, diagnose_constants::approach_iterations);
    run(own, data, nullptr, settings.iterations);
    EXPECT_LT(lent.fit.misfit, own.fit.misfit + diagnose_constants::worth_another_start) << which;
    EXPECT_LT(2 * lent.work.simulations, own.work.simulations) << which;
  }
}

}  // namespace
}  // namespace servodx
