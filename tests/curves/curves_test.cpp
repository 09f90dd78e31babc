// Figures read from curves whose figures are known: made here, no model involved.
#include "curves/curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.h"
#include "base/random.h"
#include "curves/sweep.h"
#include "servodx/curves.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"

namespace servodx::curves {
namespace {

constexpr double rated = 0.02;  // [A]

RigFile rig_with(std::map<std::string, double> facts = {}) {
  RigFile rig;
  rig.ports = Ports::blocked;
  rig.facts = std::move(facts);
  rig.facts["valve.rated_current"] = rated;
  return rig;
}

// Two triangles of +-`amplitude`; `output` of the current that a play of full width `loop` lets through.
Log swept(double amplitude, double period, Signal signal, double loop, const std::function<double(double)>& output,
          double step = 0.01) {
  Log log;
  double played = 0;
  for (double t = 0; t < 2.25 * period; t += step) {
    const double turn = t / period + 0.25, i = amplitude * (1 - 4 * std::fabs(turn - std::floor(turn) - 0.5));
    played = std::clamp(played, i - loop / 2, i + loop / 2);
    log.time.push_back(t);
    log.channels[index(Signal::command)].value.push_back(i);
    log.channels[index(signal)].value.push_back(output(played));
  }
  return log;
}

const Figure* find(const Sheet& sheet, const std::string& name) {
  for (const Figure& f : sheet.figures)
    if (f.name == name) return &f;
  return nullptr;
}
double value(const Sheet& sheet, const std::string& name) {
  const Figure* f = find(sheet, name);
  return f ? f->value : std::nan("");
}

TEST(Curves, FlowSheetReadsWhatTheCurveWasMadeOf) {
  constexpr double gain = 1.6e-4 / rated, null = 0.012 * rated, loop = 0.03 * rated, threshold_free = 0.03;
  const Log log = swept(1.02 * rated, 100, Signal::control_flow, loop, [&](double i) { return gain * (i - null); });
  const Sheet sheet = read_curves(log, rig_with());
  EXPECT_NEAR(value(sheet, "rated_flow"), gain * rated, 0.01 * gain * rated);
  EXPECT_NEAR(value(sheet, "null_bias"), 0.012, 5e-4);
  EXPECT_NEAR(value(sheet, "hysteresis"), 0.03, 0.002);
  // A play of that width holds the output for as long after a reversal.
  EXPECT_NEAR(value(sheet, "threshold"), threshold_free, 0.003);
  EXPECT_LT(value(sheet, "linearity"), 0.002);
  EXPECT_LT(value(sheet, "symmetry"), 0.002);
  EXPECT_NEAR(value(sheet, "lap"), 0.0, 0.002);
}

TEST(Curves, UnequalGainsAndOverlapAreTold) {
  constexpr double gain = 0.008, lap = 0.04 * rated;  // dead band of twice 2 %
  const Log log = swept(1.02 * rated, 100, Signal::control_flow, 0, [&](double i) {
    const double beyond = i > lap / 2 ? i - lap / 2 : i < -lap / 2 ? i + lap / 2 : 0;
    return beyond > 0 ? gain * beyond : 0.9 * gain * beyond;
  });
  const Sheet sheet = read_curves(log, rig_with());
  EXPECT_NEAR(value(sheet, "symmetry"), 0.1, 0.005);
  EXPECT_NEAR(value(sheet, "lap"), 0.04, 0.003);
}

TEST(Curves, FlowIsBroughtToTheRatedDrop) {
  Log log = swept(1.02 * rated, 100, Signal::control_flow, 0, [](double i) { return 0.01 * i; });
  log.channels[index(Signal::valve_pressure_drop)].value.assign(log.samples(), 20e6);
  const Sheet sheet = read_curves(log, rig_with({{"valve.rated_pressure_drop", 5e6}, {"valve.rated_flow", 1e-4}}));
  EXPECT_NEAR(value(sheet, "rated_flow"), 0.5 * 0.01 * rated, 1e-6);
}

TEST(Curves, PressureGainIsPartOfSupplyPerCentOfCurrent) {
  constexpr double supply = 20e6, saturates = 0.025 * rated;
  const Log log = swept(0.2 * rated, 400, Signal::load_pressure, 0.01 * rated,
                        [&](double i) { return supply * std::clamp(i / saturates, -1.0, 1.0); });
  const Sheet sheet = read_curves(log, rig_with({{"supply.pressure", supply}}));
  EXPECT_NEAR(value(sheet, "pressure_gain"), 0.4, 0.02);  // 100 % in 2.5 %
  EXPECT_NEAR(value(sheet, "hysteresis"), 0.01, 0.0015);
}

TEST(Curves, LeakagePeaksAtNull) {
  const Log log = swept(0.2 * rated, 400, Signal::leakage_flow, 0,
                        [](double i) { return 1e-5 + 5e-6 / (1 + std::pow((i - 0.01 * rated) / (0.01 * rated), 2)); });
  const Sheet sheet = read_curves(log, rig_with());
  EXPECT_NEAR(value(sheet, "null_leakage"), 1.5e-5, 1e-7);
  EXPECT_NEAR(value(sheet, "pilot_leakage"), 1e-5, 5e-8);
  EXPECT_NEAR(value(sheet, "leakage_peak_at"), 0.01, 0.003);
}

TEST(Curves, LimitsPassAndFailOnTheirSide) {
  const Log log = swept(1.02 * rated, 100, Signal::control_flow, 0.03 * rated, [](double i) { return 0.008 * i; });
  RigFile rig = rig_with();
  rig.limits["hysteresis"].max = 0.04;
  rig.limits["rated_flow"].min = 1e-4;
  rig.limits["pressure_gain"].min = 0.3;  // this log cannot say
  Sheet sheet = read_curves(log, rig);
  EXPECT_EQ(sheet.verdict, AcceptanceSheet::Kind::incomplete);
  EXPECT_EQ(unjudged_limits(sheet.figures), std::vector<std::string>{"pressure_gain"});
  ASSERT_NE(find(sheet, "pressure_gain"), nullptr);
  EXPECT_EQ(find(sheet, "pressure_gain")->remark.kind, Remark::Kind::not_shown);
  EXPECT_EQ(find(sheet, "pressure_gain")->judgement, Judgement::not_judged);
  EXPECT_TRUE(std::any_of(sheet.notes.begin(), sheet.notes.end(), [](const Note& n) {
    return n.kind == Note::Kind::unjudged_limit && n.text.find("pressure_gain") != std::string::npos;
  }));
  rig.limits["hysteresis"].max = 0.02;
  sheet = read_curves(log, rig);
  EXPECT_EQ(sheet.verdict, AcceptanceSheet::Kind::fail);
  EXPECT_EQ(find(sheet, "hysteresis")->pass(), false);
  EXPECT_EQ(find(sheet, "rated_flow")->pass(), true);
  rig.limits.erase("pressure_gain");
  rig.limits["hysteresis"].max = 0.04;
  EXPECT_EQ(read_curves(log, rig).verdict, AcceptanceSheet::Kind::pass);
  rig.limits = {{"pressure_gain", {0.3, {}}}};
  EXPECT_EQ(read_curves(log, rig).verdict, AcceptanceSheet::Kind::not_judged);
  EXPECT_EQ(read_curves(log, rig_with()).verdict, AcceptanceSheet::Kind::not_judged);
}

// A straight flow curve with white noise and a coarse meter.
Log noisy(std::uint64_t seed, double noise, double resolution) {
  Random random(seed);
  Log log = swept(1.02 * rated, 20, Signal::control_flow, 0.02 * rated, [&](double i) {
    const double y = 0.008 * i + random.normal(0, noise);
    return resolution > 0 ? resolution * std::round(y / resolution) : y;
  });
  log.channels[index(Signal::control_flow)].resolution = resolution;
  return log;
}

TEST(Uncertainty, IsTheScatterOfRepeatedReadings) {
  constexpr int repeats = 40;
  for (const char* name : {"rated_flow", "null_bias", "flow_gain", "hysteresis"}) {
    double mean = 0, square = 0, stated = 0;
    for (int k = 0; k < repeats; ++k) {
      const Sheet sheet =
          k < 3 ? read_curves(noisy(100 + k, 2e-6, 0), rig_with()) : read_figures(noisy(100 + k, 2e-6, 0), rig_with());
      if (k < 3) stated += find(sheet, name)->uncertainty / 3;
      mean += value(sheet, name) / repeats, square += value(sheet, name) * value(sheet, name) / repeats;
    }
    const double scatter = std::sqrt(square - mean * mean);
    EXPECT_GT(stated, 2 * 0.6 * scatter) << name;
    EXPECT_LT(stated, 2 * 2.5 * scatter) << name;  // drawn on top of the log's own noise: rather too large
  }
}

TEST(Uncertainty, GrowsWithResolutionAndInstruments) {
  const auto of = [](const Log& log, const SheetOptions& options) {
    return find(read_curves(log, rig_with(), options), "rated_flow")->uncertainty;
  };
  const double fine = of(noisy(1, 1e-7, 0), {});
  EXPECT_GT(of(noisy(1, 1e-7, 5e-6), {}), 1.5 * fine);
  const double flow = 0.008 * rated,
               by_meter = of(noisy(1, 1e-7, 0), {.instruments = {{Signal::control_flow, 0, 0.01}}});
  EXPECT_NEAR(by_meter, 0.01 * flow, 0.004 * flow);
}

TEST(Judgement, AValueOnTheLimitIsNoPass) {
  Sheet sheet;
  RigFile rig = rig_with();
  rig.limits["hysteresis"].max = 0.04;
  rig.limits["rated_flow"].min = 1e-4;
  const auto judged = [&](const char* name, double value, double uncertainty, double guard) {
    sheet.figures = {{.name = name, .value = value, .uncertainty = uncertainty}};
    judge(sheet, rig, guard);
    return sheet.figures[0].judgement;
  };
  EXPECT_EQ(judged("hysteresis", 0.04, 0, 1), Judgement::fail);
  EXPECT_EQ(judged("hysteresis", 0.04, 0, 0), Judgement::fail);
  EXPECT_EQ(judged("hysteresis", 0.039, 0.002, 1), Judgement::too_near);
  EXPECT_EQ(judged("hysteresis", 0.039, 0.002, 0), Judgement::pass);
  EXPECT_EQ(judged("hysteresis", 0.037, 0.002, 1), Judgement::pass);
  EXPECT_EQ(judged("rated_flow", 1.01e-4, 2e-6, 1), Judgement::too_near);
  EXPECT_EQ(judged("rated_flow", -1.03e-4, 2e-6, 1), Judgement::pass);  // by its size
  EXPECT_EQ(judged("rated_flow", 1.03e-4, std::nan(""), 1), Judgement::not_judged);
  judged("hysteresis", 0.039, 0.002, 1);
  EXPECT_EQ(sheet.verdict, AcceptanceSheet::Kind::fail);
}

TEST(Judgement, OneFigureThatDoesNotPassFailsTheSheetAndWhatIsNotJudgedDoesNot) {
  using Kind = AcceptanceSheet::Kind;
  constexpr Judgement pass = Judgement::pass, near = Judgement::too_near, fail = Judgement::fail,
                      none = Judgement::not_judged;
  struct Case {
    std::vector<Judgement> figures;
    Kind verdict;
  };
  for (const Case& c : {Case{{}, Kind::not_judged}, Case{{none, none}, Kind::not_judged}, Case{{pass}, Kind::pass},
                        Case{{none, pass}, Kind::pass}, Case{{pass, near}, Kind::fail}, Case{{near}, Kind::fail},
                        Case{{fail, none}, Kind::fail}, Case{{pass, fail}, Kind::fail}}) {
    std::vector<Figure> figures;
    for (const Judgement j : c.figures) figures.emplace_back().judgement = j;
    EXPECT_EQ(verdict_of(figures), c.verdict) << c.figures.size();
  }
}

TEST(Curves, AFastOrOneWaySweepTellsNoHysteresis) {
  const Log fast = swept(
      1.02 * rated, 3, Signal::control_flow, 0.02 * rated, [](double i) { return 0.008 * i; }, 1e-3);
  EXPECT_TRUE(std::isnan(value(read_curves(fast, rig_with()), "hysteresis")));
  EXPECT_EQ(find(read_curves(fast, rig_with()), "hysteresis")->remark.kind, Remark::Kind::too_fast);
  EXPECT_EQ(find(read_curves(fast, rig_with()), "threshold"), nullptr);
  Log one_way;
  for (int k = -1000; k <= 1000; ++k) {
    one_way.time.push_back(0.05 * k);
    one_way.channels[index(Signal::command)].value.push_back(1.02e-3 * rated * k);
    one_way.channels[index(Signal::control_flow)].value.push_back(0.008 * 1.02e-3 * rated * k);
  }
  const Sheet sheet = read_curves(one_way, rig_with());
  ASSERT_NE(find(sheet, "hysteresis"), nullptr);
  EXPECT_EQ(find(sheet, "hysteresis")->remark.kind, Remark::Kind::one_way);
  EXPECT_TRUE(std::isnan(value(sheet, "hysteresis")));
  EXPECT_GT(value(sheet, "rated_flow"), 0);
}

TEST(Curves, CoarseReadingsTellNoThreshold) {
  const Log log = swept(1.02 * rated, 100, Signal::control_flow, 0.003 * rated,
                        [](double i) { return 1e-5 * std::round(0.008 * i / 1e-5); });
  const Sheet sheet = read_curves(log, rig_with());
  ASSERT_NE(find(sheet, "threshold"), nullptr);
  EXPECT_TRUE(std::isnan(value(sheet, "threshold")));
  EXPECT_EQ(find(sheet, "threshold")->remark.kind, Remark::Kind::coarse_readings);
}

// x'' + 2 z w x' + w^2 x = w^2 u by small steps, driven by a logarithmic sweep.
TEST(Curves, BodeOfASweepFindsLagAndAttenuationOfAKnownSecondOrder) {
  constexpr double w = 2 * std::numbers::pi * 60, z = 0.7, dt = 1e-3;
  Log log;
  double x = 0, v = 0;
  for (double t = 0; t < 20; t += dt) {
    const double k = std::log(150.0) / 20, u = 0.1 * rated * std::sin(2 * std::numbers::pi * (std::exp(k * t) - 1) / k);
    log.time.push_back(t);
    log.channels[index(Signal::command)].value.push_back(u);
    log.channels[index(Signal::spool_position)].value.push_back(x);
    for (int j = 0; j < 50; ++j) {  // the command is held
      v += (w * w * (u - x) - 2 * z * w * v) * dt / 50;
      x += v * dt / 50;
    }
  }
  const Sheet sheet = read_curves(log, rig_with());
  EXPECT_NEAR(value(sheet, "phase_lag_90_frequency"), 60, 1.5);
  EXPECT_NEAR(value(sheet, "amplitude_3db_frequency"), 60 * 1.01, 3);
  EXPECT_EQ(find(sheet, "hysteresis"), nullptr);
}

TEST(Curves, ALogWithoutAFigureIsRefused) {
  Log log;
  for (int k = 0; k < 100; ++k) {
    log.time.push_back(0.01 * k);
    log.channels[index(Signal::command)].value.push_back(0.0);
    log.channels[index(Signal::control_flow)].value.push_back(1e-6);
  }
  EXPECT_THROW(read_curves(log, rig_with()), InputError);
  const Log good = swept(rated, 10, Signal::control_flow, 0, [](double i) { return i; });
  EXPECT_THROW(read_curves(good, RigFile{}), InputError);  // no rated current
}

TEST(Judgement, ALimitThatNoFigureAnswersLeavesTheSheetIncomplete) {
  const Limit limit = {0.3, {}};
  const auto figure = [&](const char* name, Judgement judgement) {
    Figure f;
    f.name = name, f.limit = limit, f.judgement = judgement;
    return f;
  };
  const Figure kept = figure("lap", Judgement::pass), hidden = figure("threshold", Judgement::not_judged);
  EXPECT_EQ(verdict_of({kept}), AcceptanceSheet::Kind::pass);
  EXPECT_EQ(verdict_of({kept, hidden}), AcceptanceSheet::Kind::incomplete);
  EXPECT_EQ(verdict_of({hidden}), AcceptanceSheet::Kind::not_judged);
  EXPECT_EQ(verdict_of({figure("lap", Judgement::fail), hidden}), AcceptanceSheet::Kind::fail);
  // One sweep shows what another does not.
  EXPECT_EQ(verdict_of({hidden, figure("threshold", Judgement::pass)}), AcceptanceSheet::Kind::pass);
}

}  // namespace
}  // namespace servodx::curves
