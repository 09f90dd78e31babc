// What a baseline refuses and promises; determinism of an assessment. On short pieces of the committed logs.
#include "diagnose/baseline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>

#include "base/error.h"
#include "base/random.h"
#include "diagnose/assessment.h"
#include "diagnose/diagnose.h"
#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_fit.h"
#include "diagnose/moved.h"
#include "diagnose/whitening.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "faults/sizes.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "fit/tuned_state.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/diagnose.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/watch.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

// The first `samples` of a log, as a log.
Log cut(Log log, std::size_t samples) {
  samples = std::min(samples, log.samples());
  log.time.resize(samples);
  for (Channel& c : log.channels)
    if (!c.value.empty()) c.value.resize(samples);
  return log;
}
std::vector<Log> cut_logs(const std::vector<std::string>& names, std::size_t samples) {
  std::vector<Log> out;
  for (const std::string& name : names) out.push_back(cut(shipped_log(name), samples));
  return out;
}

// A table as `tune` would leave it, without the work: an error model, and the hash of a log.
Table as_tuned(const std::string& by, double independent = 0.05) {
  Table t = shipped_table();
  t.path = "tuned.csv";
  ErrorModel error;
  for (Signal s : {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b})
    error.channels.push_back({s, 0.0, 0.2, independent});
  set_tuned_state(t, {error, {}, {{"log.csv", by, ""}}, {}});
  t.has_std_error = true;
  return t;
}

// The words of the refusal; empty if there was none.
template <class F>
std::string refusal(F f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Baseline, RefusesALogThatTunedTheTable) {
  const std::vector<Log> logs = cut_logs({"healthy/h03_sine_2hz", "healthy/h12_mixed", "healthy/h05_prbs"}, 100);
  const Table tuned = as_tuned(logs[1].sha256);
  const std::string said = refusal([&] { make_baseline(logs, tuned, shipped_rig(), 0.01, {}); });
  EXPECT_NE(said.find("h12_mixed"), std::string::npos) << said;
  EXPECT_NE(said.find("tuned"), std::string::npos) << said;
}

TEST(Baseline, RefusesTheSameLogTwice) {
  const std::vector<Log> logs =
      cut_logs({"healthy/h03_sine_2hz", "healthy/h05_prbs", "healthy/h12_mixed", "healthy/h05_prbs"}, 100);
  const std::string said = refusal([&] { make_baseline(logs, as_tuned("0"), shipped_rig(), 0.01, {}); });
  EXPECT_NE(said.find("same log"), std::string::npos) << said;
}

TEST(Baseline, RefusesTwoLogsAndARateThatIsNone) {
  const std::vector<Log> two = cut_logs({"healthy/h03_sine_2hz", "healthy/h05_prbs"}, 100);
  const std::string said = refusal([&] { make_baseline(two, as_tuned("0"), shipped_rig(), 0.01, {}); });
  EXPECT_NE(said.find("2 logs"), std::string::npos) << said;
  for (double rate : {0.0, 1.0, -0.1})
    EXPECT_NE(refusal([&] { make_baseline(two, as_tuned("0"), shipped_rig(), rate, {}); }), "") << rate;
}

TEST(Baseline, RefusesATableThatDoesNotSayHowWrongItIs) {
  Table tuned = as_tuned("0");
  tuned.state.clear();
  const std::vector<Log> logs = cut_logs({"healthy/h03_sine_2hz", "healthy/h12_mixed", "healthy/h05_prbs"}, 100);
  EXPECT_NE(refusal([&] { make_baseline(logs, tuned, shipped_rig(), 0.01, {}); }), "");
}

TEST(Baseline, PromisesTheRatesThatItsNumberOfLogsAllows) {
  const std::vector<Log> logs = cut_logs({"healthy/h02_steps_small", "healthy/h03_sine_2hz", "healthy/h12_mixed"}, 400);
  const DetectionBaseline low = make_baseline(logs, as_tuned("0"), shipped_rig(), 0.01, {});
  EXPECT_EQ(low.logs, 3);
  ASSERT_EQ(low.scores.size(), 3u);
  std::vector<double> scores;
  for (const DetectionBaseline::Score& s : low.scores) scores.push_back(s.score);
  std::sort(scores.begin(), scores.end());
  EXPECT_DOUBLE_EQ(low.promised, 1.0 / (3 + 1));
  EXPECT_DOUBLE_EQ(low.promised_95, 1 - std::pow(0.05, 1.0 / 3));
  EXPECT_GE(low.threshold, scores[2]) << "by rank; a law of the tail may ask for more";
  // One in a hundred takes 99 logs: 96 more.
  EXPECT_EQ(low.logs_needed, 99);
  // A rate that three logs allow: two of four may lie above, so the threshold is the second score.
  const DetectionBaseline high = make_baseline(logs, as_tuned("0"), shipped_rig(), 0.5, {});
  EXPECT_DOUBLE_EQ(high.promised, 2.0 / 4);
  EXPECT_GE(high.threshold, scores[1]);
  EXPECT_LE(high.threshold, low.threshold);
}

TEST(Assess, AFaultsRowsAreItsOwnAndProgressIsToldFitByFit) {
  const Log log = cut(shipped_log("fault/f02_clogged_filter_severe"), 250);
  DiagnoseOptions options;
  std::mutex one;
  std::vector<double> parts;
  options.watch.progress = [&](const WorkDone& done) {
    const std::scoped_lock lock(one);
    parts.push_back(done.part);
  };
  const Assessment a = assess(log, as_tuned("0"), shipped_rig(), options);
  EXPECT_GT(parts.size(), 2 * fault_list().size());
  EXPECT_LE(*std::max_element(parts.begin(), parts.end()), 1.0);
  for (const HypothesisResult& h : a.hypotheses) {
    std::set<std::string> by_fault;
    bool health_began = false;
    for (const MovedRow& row : h.moved) {
      EXPECT_NE(row.estimate, row.nominal) << row.name;
      EXPECT_FALSE(row.std_error <= 0) << row.name << " has moved, and not by nothing";
      const bool of_fault = row.by == MovedRow::By::fault;
      EXPECT_FALSE(of_fault && health_began) << row.name << " is the fault's and comes late";
      health_began |= !of_fault;
      if (of_fault) by_fault.insert(row.name);
    }
    if (!h.fault) {
      EXPECT_TRUE(by_fault.empty());
    } else if (h.fault == find_fault("clogged_filter")) {
      EXPECT_EQ(by_fault, (std::set<std::string>{"filter_blockage_positive", "filter_blockage_negative"}));
    } else if (h.fault == find_fault("plugged_nozzle")) {
      EXPECT_TRUE(by_fault.contains("nozzle_1_blockage") || by_fault.contains("nozzle_2_blockage"));
    }
  }
  // What the log has none of ends where its fault begins, and says so.
  int none_seen = 0;
  for (const HypothesisResult& h : a.hypotheses) {
    if (!h.fault || !h.at_least) continue;
    ++none_seen;
    const Fault& f = *h.fault;
    const FaultSizes of_valve = sizes_of(f, candidate_of(shipped_table()).data());
    EXPECT_NEAR(std::abs(h.severity - f.healthy), std::abs(of_valve.least - f.healthy),
                0.01 * std::abs(of_valve.worst - of_valve.least))
        << f.name;
  }
  EXPECT_GT(none_seen, 0);
  EXPECT_LT(none_seen, static_cast<int>(fault_list().size()));
}

// Healthy until row `at`, and then by `after`, as the model has it: the piston goes on from where it is.
Log stepping_in(Log log, std::size_t at, const ParameterVector& after) {
  Random random(5, 1);
  const auto filled = [&](std::size_t from, const ParameterVector& candidate) {
    Log part = log;
    part.time.erase(part.time.begin(), part.time.begin() + static_cast<long>(from));
    for (Channel& c : part.channels)
      if (!c.value.empty()) c.value.erase(c.value.begin(), c.value.begin() + static_cast<long>(from));
    const LogData data = prepare(part, shipped_rig());
    const Trajectory run = reference_of(data, candidate, 1);
    for (const FitChannel& c : data.channels) {
      std::vector<double> shown = c.shown(run.signals[static_cast<std::size_t>(c.simulated)]);
      for (double& x : shown) x += c.noise * random.normal();
      std::copy(shown.begin(), shown.end(), log.channels[index(c.signal)].value.begin() + static_cast<long>(from));
    }
  };
  filled(0, candidate_of(shipped_table()));
  filled(at, after);
  return log;
}

// A null that had shifted at the beginning would have the piston at its stop, where this one's never is.
TEST(Assess, AFaultThatStepsInIsAskedForTheMotionSinceThen) {
  ParameterVector after = candidate_of(shipped_table());
  after[row::servovalve_null] = 0.3;
  constexpr std::size_t at = 3000;
  const Log log = stepping_in(cut(shipped_log("healthy/h12_mixed"), 4000), at, after);
  const Assessment a = assess(log, as_tuned("0", 50), shipped_rig(), {});
  ASSERT_TRUE(a.onset);
  EXPECT_NEAR(*a.onset, log.time[at], 0.05);
  const auto best = std::min_element(a.hypotheses.begin(), a.hypotheses.end(),
                                     [](const auto& x, const auto& y) { return x.misfit < y.misfit; });
  ASSERT_EQ(best->fault, find_fault("null_shift"));
  std::printf("leaves %.4f of the motion\n", best->motion_left);
  EXPECT_LT(best->motion_left, 0.05);
}

// The shipped table has the clearance of the shipped rig's drawing.
TEST(Assess, AClearanceIsSizedByTheDrawingToo) {
  const Log log = cut(shipped_log("healthy/h12_mixed"), 1000);
  const Table tuned = as_tuned("0", 50);
  const auto sizes_beside = [&](double times) {
    RigFile rig = shipped_rig();
    rig.facts["valve.radial_clearance"] = tuned[row::radial_clearance].nominal / times;
    return assess(log, tuned, rig, {}).hypotheses;
  };
  constexpr double times = 2;
  const std::vector<HypothesisResult> same = sizes_beside(1), other = sizes_beside(times);
  ASSERT_EQ(other.size(), same.size());
  bool wider = false;
  for (std::size_t i = 0; i < same.size(); ++i) {
    FaultSize size;
    size.fault = same[i].fault;
    size.severity_lower = same[i].severity_lower, size.severity_upper = same[i].severity_upper;
    const bool of_clearance = size.fault && size.fault->counted_in == row::radial_clearance;
    FreeValue searched;
    if (of_clearance) searched.lower = size.fault->least, searched.upper = size.fault->worst;
    if (of_clearance) size = counted_in_either(size, times, searched);
    EXPECT_DOUBLE_EQ(other[i].severity_lower, size.severity_lower) << i;
    EXPECT_DOUBLE_EQ(other[i].severity_upper, size.severity_upper) << i;
    wider = wider || other[i].severity_upper > 1.01 * same[i].severity_upper;
  }
  EXPECT_TRUE(wider);
}

TEST(Assess, SameResultAtAnyThreadCount) {
  const Log log = cut(shipped_log("fault/f02_clogged_filter_severe"), 250);
  DiagnoseOptions one, two;
  one.threads = 1, two.threads = 2;
  const Assessment a = assess(log, as_tuned("0"), shipped_rig(), one);
  const Assessment b = assess(log, as_tuned("0"), shipped_rig(), two);
  EXPECT_EQ(score_of(a, {}), score_of(b, {}));
  ASSERT_EQ(a.hypotheses.size(), b.hypotheses.size());
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i) {
    EXPECT_EQ(a.hypotheses[i].fault, b.hypotheses[i].fault);
    EXPECT_EQ(a.hypotheses[i].misfit, b.hypotheses[i].misfit);
    EXPECT_EQ(a.hypotheses[i].severity, b.hypotheses[i].severity);
  }
}

}  // namespace
}  // namespace servodx
