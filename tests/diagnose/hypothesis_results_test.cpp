// What fits of hypotheses come to, of fits made by hand: nothing is run.
#include "diagnose/hypothesis_results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/hypotheses.h"
#include "diagnose/onset.h"
#include "diagnose/ready_logs.h"
#include "diagnose/visible.h"
#include "evidence/probabilities.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "servodx/log.h"
#include "servodx/tune.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

const Fault* fault(const char* name) { return *name ? find_fault(name) : nullptr; }

HypothesisFit fit(const char* name, double misfit) {
  HypothesisFit f;
  f.fault = fault(name), f.misfit = misfit, f.ok = true;
  return f;
}

HypothesisFit pair(const char* first, const char* second, double misfit) {
  HypothesisFit f = fit(first, misfit);
  FaultSize beside;
  beside.fault = fault(second);
  f.beside = beside;
  return f;
}

HypothesisFits fits() {
  HypothesisFits out;
  out.degrees = 1000;
  out.fits = {fit("", 3000), fit("null_shift", 2500), fit("clogged_filter", 2000)};
  return out;
}

TEST(HypothesisResults, OfAPairTheFaultThatFitsBetterAloneIsTheFirst) {
  HypothesisFits made = fits();
  made.pairs = {pair("null_shift", "clogged_filter", 1500), pair("clogged_filter", "null_shift", 1200)};
  const std::vector<PairResult> pairs = pair_results(made);
  ASSERT_EQ(pairs.size(), 2u);
  for (const PairResult& p : pairs) {
    EXPECT_EQ(p.first.fault, fault("clogged_filter"));
    EXPECT_EQ(p.second.fault, fault("null_shift"));
  }
  EXPECT_EQ(pairs[0].misfit, 1200) << "the best first";
  EXPECT_DOUBLE_EQ(pairs[0].of_effect, (2000.0 - 1200) / (3000 - 1200));
}

TEST(HypothesisResults, GainsStandBesideWhatTheModelErrsBy) {
  HypothesisFits made = fits();
  made.visible = {{fault("null_shift"), {{0.1, 60.0}, {0.2, 200.0}}}};
  const double inflation = misfit_inflation(2000, 1000);
  ASSERT_GT(inflation, 1);
  const std::vector<VisibleFault> seen = visible_beside_error(made);
  EXPECT_DOUBLE_EQ(seen.front().gains[0].gain, 60 / inflation);
  EXPECT_DOUBLE_EQ(seen.front().gains[1].gain, 200 / inflation);
  const ParameterVector base = candidate_of(shipped_table());
  const std::vector<HypothesisResult> results = hypothesis_results(made, base, shipped_table());
  EXPECT_DOUBLE_EQ(results[0].gain, 0);
  EXPECT_DOUBLE_EQ(results[2].gain, 1000 / inflation);
  made.fits[2].ok = false;
  EXPECT_EQ(hypothesis_results(made, base, shipped_table())[2].gain, 0) << "a fit that failed gains nothing";
}

TEST(HypothesisResults, BeforeAnOnsetHealthSpeaksAndFromItOnTheFaults) {
  const ParameterVector base = candidate_of(shipped_table());
  const auto spoken = [&](const HypothesisFits& of, const std::optional<Onset>& onset) {
    std::vector<std::pair<const Fault*, std::size_t>> out;
    for (const HypothesisPrediction& p : predictions_of(base, of, onset)) out.emplace_back(p.fault, p.from);
    return out;
  };
  using Spoken = std::vector<std::pair<const Fault*, std::size_t>>;
  HypothesisFits made = fits();
  made.fits[1].ok = false;
  EXPECT_EQ(spoken(made, {}), (Spoken{{nullptr, 0}, {fault("clogged_filter"), 0}}));
  Onset onset;
  onset.at = 700, onset.healthy_before = fit("", 100), onset.after = fits();
  EXPECT_EQ(spoken(onset.after, onset),
            (Spoken{{nullptr, 0}, {fault("null_shift"), 700}, {fault("clogged_filter"), 700}}));
}

TEST(HypothesisResults, OfSeveralLogsAChannelsSquaresArePooled) {
  std::vector<Log> logs(2);
  ReadyLogs ready;
  const double noise[] = {1, 7};
  for (std::size_t l = 0; l < 2; ++l) {
    logs[l].channels[index(Signal::piston_position)].unit = "mm";
    LogData data;
    FitChannel piston;
    piston.signal = Signal::piston_position, piston.noise = noise[l];
    data.channels.push_back(piston);
    ready.data.push_back(data);
  }
  HypothesisFit healthy = fit("", 3000);
  healthy.channel_rms = {3, 4};
  const std::vector<ChannelResult> channels = channels_under(healthy, logs, ready);
  ASSERT_EQ(channels.size(), 1u);
  EXPECT_EQ(channels.front().unit, "mm");
  EXPECT_DOUBLE_EQ(channels.front().rms, std::sqrt((9 + 16) / 2.0));
  EXPECT_DOUBLE_EQ(channels.front().noise_rms, std::sqrt((1 + 49) / 2.0));
}

}  // namespace
}  // namespace servodx
