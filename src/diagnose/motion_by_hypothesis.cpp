#include "diagnose/motion_by_hypothesis.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "diagnose/motion.h"
#include "diagnose/whitening.h"

namespace servodx {
namespace {

// What hypotheses that speak of all of a log leave of what moves in it. Gives the run of health there.
Trajectory leave_motion(const LogData& log, const std::vector<const HypothesisPrediction*>& by,
                        const ParameterVector& base, int threads, std::vector<MotionByHypothesis::Left>& left) {
  std::vector<const ParameterVector*> candidates = {&base};
  for (const HypothesisPrediction* e : by) candidates.push_back(&e->candidate);
  std::vector<Trajectory> runs = references_of(log, candidates, threads);
  for (std::size_t i = 0; i < by.size(); ++i)
    left.push_back({by[i]->fault, mean_left(motion_left(log, runs.front(), runs[i + 1]), 0)});
  return std::move(runs.front());
}

}  // namespace

// A fault that steps in is simulated from there on, as it was fitted: from the beginning it would drive the piston to
// where the log's never was.
MotionByHypothesis motion_by_hypothesis(const LogData& data, const ParameterVector& base,
                                        const std::vector<HypothesisPrediction>& predictions,
                                        const std::vector<BrokenSensor>& broken, int threads) {
  MotionByHypothesis out;
  std::vector<const HypothesisPrediction*> whole, since;
  for (const HypothesisPrediction& e : predictions) (e.from > 0 ? since : whole).push_back(&e);
  const Trajectory healthy = leave_motion(data, whole, base, threads, out.left);
  if (!since.empty())
    leave_motion(slice(data, since.front()->from, data.scenario.time.size()), since, base, threads, out.left);
  std::vector<MotionLeft> left = motion_left(data, healthy, healthy);
  std::erase_if(left, [&](const MotionLeft& m) {
    return std::any_of(broken.begin(), broken.end(), [&](const auto& b) { return b.signal == m.signal; });
  });
  out.others = mean_left(left, 0);
  return out;
}

MotionByHypothesis motion_by_hypothesis(const std::vector<LogData>& data, const ParameterVector& base,
                                        const std::vector<HypothesisPrediction>& predictions,
                                        const std::vector<BrokenSensor>& broken, int threads) {
  MotionByHypothesis out = motion_by_hypothesis(data.front(), base, predictions, broken, threads);
  for (std::size_t l = 1; l < data.size(); ++l) {
    const MotionByHypothesis of_log = motion_by_hypothesis(data[l], base, predictions, broken, threads);
    for (std::size_t i = 0; i < out.left.size(); ++i) out.left[i].part += of_log.left[i].part;
    out.others += of_log.others;
  }
  const auto n = static_cast<double>(data.size());
  for (MotionByHypothesis::Left& left : out.left) left.part /= n;
  out.others /= n;
  return out;
}

}  // namespace servodx
