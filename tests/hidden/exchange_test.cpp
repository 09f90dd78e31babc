// Healthy logs and a suspect are weighed alike, or the one's scatter says nothing of the other's.
#include <gtest/gtest.h>

#include "explain/block_replay.h"
#include "explain/cause_score.h"
#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/healthy.h"
#include "explain/learnt_curves.h"
#include "explain/score.h"
#include "explain/score_healthy.h"
#include "explain/valve.h"
#include "hidden/cases.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "temporary_folder.h"

namespace servodx::hidden {
namespace {

class Exchange : public testing::Test {
 protected:
  std::vector<Log> healthy(int count, double seconds) {
    std::vector<Log> logs;
    for (const std::string& path : healthy_logs(bench, count, 4, "healthy", seconds))
      logs.push_back(read_log(path, bench.rig));
    return logs;
  }
  const std::string source = SERVODX_SOURCE_DIR;
  const TemporaryFolder folder;
  const Bench bench{folder.path, source + "/params/rigs/borello2009.toml", read_rig_file(source + "/data/rig.toml"), 1};
  const Table tuned = read_table(source + "/tests/hidden/valve_1.csv");
};

TEST_F(Exchange, HealthyLogIsScoredBesideTheOthersAsASuspectIs) {
  std::vector<Log> logs = healthy(3, 0.4);
  HealthyCounts counts;
  const HealthyLog beside = score_healthy(logs, tuned, bench.rig, 0, counts).logs.back();

  const Log suspect = logs.back();
  logs.pop_back();
  const HealthyReference others = score_healthy(logs, tuned, bench.rig, 0, counts);
  ValveSubject subject({suspect}, tuned, bench.rig, 0, others.known());
  const std::vector<Curve> curves = add_curves(subject);
  const ExplainedFit fit = fit_base(subject, EngineOptions{}.iterations);
  guess_curves(subject, curves, fit.point);
  std::vector<CauseScore> scores = score_causes(subject, fit);
  ReplaySubject blocks(subject, fit.point, others.known());
  const ExplainedFit replayed = fit_base(blocks, EngineOptions{}.iterations);
  for (CauseScore& s : score_causes(blocks, replayed))
    if (!s.probes.empty()) scores.push_back(std::move(s));  // looked at
  ASSERT_EQ(scores.size(), beside.scores.size());
  for (std::size_t c = 0; c < scores.size(); ++c)
    EXPECT_DOUBLE_EQ(scores[c].gain, beside.scores[c].gain) << beside.scores[c].effect;
  EXPECT_EQ(subject.misses(fit.residual).front().size, beside.misses.front().size);
}

// How sizes scatter from test to test is not seen in repeats of one.
TEST_F(Exchange, OtherTestsAreScoredWhereTheLogsAreOfTooFew) {
  std::vector<Log> logs = healthy(4, 0.3);
  HealthyCounts counts;
  const std::vector<Log> others = {logs[1]};
  const HealthyReference repeats = score_healthy({logs[0], logs[0]}, tuned, bench.rig, 0, counts, {}, others);
  ASSERT_EQ(repeats.logs.size(), 3u);
  EXPECT_FALSE(repeats.logs[1].other);
  EXPECT_TRUE(repeats.logs[2].other);
  EXPECT_EQ(repeats.promising(), 2);
  EXPECT_EQ(score_healthy({logs[0], logs[2], logs[3]}, tuned, bench.rig, 0, counts, {}, others).promising(), 3);
}

}  // namespace
}  // namespace servodx::hidden
