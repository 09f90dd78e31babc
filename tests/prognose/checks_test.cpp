// The three checks of Borello 2009, sec. 6, against closed forms.
#include "prognose/checks.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "fit/log_data.h"
#include "prognose/preflight.h"
#include "support.h"

namespace servodx {
namespace {

constexpr double pi = std::numbers::pi;

std::vector<double> grid(double end, double h = 1e-3) {
  std::vector<double> t;
  for (int k = 0; k * h <= end + 1e-12; ++k) t.push_back(k * h);
  return t;
}
template <class F>
std::vector<double> of(const std::vector<double>& t, const F& f) {
  std::vector<double> y;
  for (double x : t) y.push_back(f(x));
  return y;
}

TEST(Preflight, FindsRestStepAndEverySine) {
  const Preflight found = find_preflight(preflight_log({2.0, 5.0, 10.0}, 0.013));
  EXPECT_EQ(found.rest, 100u);
  EXPECT_NEAR(found.rest_current, 0.013 * 0.02, 1e-12);
  ASSERT_TRUE(found.step);
  EXPECT_EQ(found.step->from, 100u);
  EXPECT_EQ(found.step->back, 250u);
  EXPECT_NEAR(found.step->size, 0.002, 1e-12);
  ASSERT_EQ(found.sines.size(), 3u);
  const double expected[] = {2.0, 5.0, 10.0};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(found.sines[k].frequency, expected[k], 0.01 * expected[k]);
    EXPECT_NEAR(found.sines[k].amplitude, 0.0008, 0.00002);
    EXPECT_GE(found.sines[k].cycles, 3);
  }
}

// The half period between two tones may pass for one of the first.
TEST(Preflight, NearTonesAreToldApart) {
  for (const double ratio : {1.2, 1.3, 1.4, 1.5, 1.7}) {
    const Preflight found = find_preflight(preflight_log({2.0, 2.0 * ratio}));
    ASSERT_EQ(found.sines.size(), 2u) << ratio;
    EXPECT_NEAR(found.sines[0].frequency, 2.0, 0.02) << ratio;
    EXPECT_NEAR(found.sines[1].frequency, 2.0 * ratio, 0.02 * ratio) << ratio;
  }
}

TEST(Preflight, ARandomCommandHoldsNoTest) {
  LogData log;
  Random random(7);
  for (int k = 0; k < 3000; ++k) {
    log.scenario.time.push_back(k * 1e-3);
    log.scenario.command.push_back(k % 20 ? log.scenario.command.back() : 0.004 * random.normal());
  }
  const Preflight found = find_preflight(log);
  EXPECT_FALSE(found.step);
  EXPECT_TRUE(found.sines.empty());
}

TEST(Checks, MeanErrorOfAConstantDifferenceIsItAndSettlesAtOnce) {
  const auto t = grid(10);
  const auto x = of(t, [](double s) { return std::sin(s); }), y = of(t, [](double s) { return std::sin(s) - 3e-6; });
  const MeanError e = mean_error(t, x, y);
  EXPECT_NEAR(e.figure.value, 3e-6, 1e-15);
  EXPECT_NEAR(e.figure.std_error, 0.0, 1e-12);
  EXPECT_TRUE(e.settled);
}

TEST(Checks, MeanErrorOfALateFaultIsNotSettled) {
  const auto t = grid(10);
  const auto zero = of(t, [](double) { return 0.0; }), late = of(t, [](double s) { return s > 8 ? 1e-5 : 1e-7; });
  EXPECT_FALSE(mean_error(t, late, zero).settled);
}

// Figs. 8 and 9: a gain loss to g gives 1/g, whatever T is.
TEST(Checks, FidelityOfAGainLossIsItsInverse) {
  const auto t = grid(0.3, 1e-4);
  const auto model = of(t, [](double s) { return s < 0.1 ? 0 : 5e-5 * -std::expm1(-(s - 0.1) / 2e-3); });
  for (double g : {1.0, 0.8, 0.55, 0.2}) {
    std::vector<double> x = model;
    for (double& v : x) v *= g;
    const auto r = fidelity(t, x, model, {1000, 2800, 0.002}, 0.0);
    ASSERT_TRUE(r);
    EXPECT_NEAR(r->figure.value, 1 / g, 1e-9);
    EXPECT_NEAR(r->duration, 3 * 2e-3, 2e-4);  // 95 %
  }
}

// papers.md: three times slower gives 1.76 at T = 3 time constants.
TEST(Checks, FidelityOfASlowerSpoolIsThatOfLinearTheory) {
  const auto t = grid(0.3, 1e-5);
  const auto rise = [&](double tau) {
    return of(t, [=](double s) { return s < 0.1 ? 0 : 5e-5 * -std::expm1(-(s - 0.1) / tau); });
  };
  const auto r = fidelity(t, rise(6e-3), rise(2e-3), {10000, 28000, 0.002}, 0.0);
  ASSERT_TRUE(r);
  EXPECT_NEAR(r->figure.value, 1.76, 0.01);
}

TEST(Checks, ASpoolThatDoesNotMoveIsNoResponse) {
  const auto t = grid(0.3, 1e-4);
  const auto model = of(t, [](double s) { return s < 0.1 ? 0 : 5e-5 * -std::expm1(-(s - 0.1) / 2e-3); });
  const auto r = fidelity(t, std::vector<double>(t.size(), 1e-9), model, {1000, 2800, 0.002}, 3e-7);
  ASSERT_TRUE(r);
  EXPECT_TRUE(r->no_response);
  EXPECT_TRUE(std::isnan(r->figure.value));
}

// x = X sin wt, y = -Y cos wt with a drift: E = X Y / 2 whatever the drift.
TEST(Checks, CorrelationIsHalfTheProductOfAmplitudesAndForgetsDrift) {
  const double f = 5.0, w = 2 * pi * f;
  const auto t = grid(1.0);
  const auto x = of(t, [=](double s) { return 12e-6 * std::sin(w * s) + 4e-6; });
  const auto y = of(t, [=](double s) { return -2e-4 * std::cos(w * s) + 0.01 + 0.003 * s; });
  const auto e = correlation(t, x, y, {f, 0.0008, 0.0, 5}, 0.0, 0.0);
  ASSERT_TRUE(e);
  EXPECT_NEAR(e->value, 0.5 * 12e-6 * 2e-4, 0.01 * 0.5 * 12e-6 * 2e-4);
}

TEST(Checks, StandardErrorsAreTheScatterOfNoisyRepeats) {
  const double f = 5.0, w = 2 * pi * f, noise_x = 4e-7, noise_y = 1e-5;
  const auto t = grid(0.8);
  Random random(3);
  double sum_e = 0, square_e = 0, claim_e = 0, sum_r = 0, square_r = 0, claim_r = 0;
  constexpr int n = 300;
  const auto model = of(t, [](double s) { return s < 0.1 ? 0 : 5e-5 * -std::expm1(-(s - 0.1) / 2e-3); });
  for (int k = 0; k < n; ++k) {
    auto x = of(t, [=](double s) { return 12e-6 * std::sin(w * s); });
    auto y = of(t, [=](double s) { return -2e-4 * std::cos(w * s); });
    std::vector<double> step = model;
    for (double& v : x) v += noise_x * random.normal();
    for (double& v : y) v += noise_y * random.normal();
    for (double& v : step) v += noise_x * random.normal();
    const auto e = correlation(t, x, y, {f, 0.0008, 0.0, 4}, noise_x, noise_y);
    const auto r = fidelity(t, step, model, {100, 400, 0.002}, noise_x);
    sum_e += e->value, square_e += e->value * e->value, claim_e += e->std_error;
    sum_r += r->figure.value, square_r += r->figure.value * r->figure.value, claim_r += r->figure.std_error;
  }
  const double scatter_e = std::sqrt(square_e / n - sum_e * sum_e / n / n);
  const double scatter_r = std::sqrt(square_r / n - sum_r * sum_r / n / n);
  EXPECT_NEAR(claim_e / n / scatter_e, 1.0, 0.4);
  EXPECT_NEAR(claim_r / n / scatter_r, 1.0, 0.2);
}

}  // namespace
}  // namespace servodx
