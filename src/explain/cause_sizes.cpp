#include "explain/cause_sizes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "explain/block_replay.h"
#include "explain/drive.h"
#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/score.h"
#include "servodx/log.h"

namespace servodx {

HealthyScore summarise(const Subject& subject, const CauseScore& score) {
  const Cause& cause = subject.causes()[static_cast<std::size_t>(score.cause)];
  HealthyScore out{cause.effect, place_key(cause), {}, score.gain, cause.prior, subject.thickness()};
  if (cause.curve) {  // knots that the log does not reach are loose: what they gain together is what counts
    out.sizes.push_back({std::log1p(score.gain), 1.0});
    return out;
  }
  std::size_t k = 0;
  for (const auto& alternative : cause.probes) {
    if (alternative.size() == 1) {
      out.sizes.push_back(score.probes[k++]);
      ProbeScore& size = out.sizes.back();
      size.std_error = std::hypot(size.std_error, subject.error_beside(score.cause, out.sizes.size() - 1));
      if (cause.atop.empty()) continue;
      const double off = cause.numbers.front().off, move = alternative.front().front() - off;
      size = {score.of * (off + move * size.size), score.of * std::abs(move) * size.std_error};
      continue;
    }
    double size = 0, error = 0;
    for (std::size_t j = 0; j < alternative.size(); ++j, ++k)
      size += score.probes[k].size * score.probes[k].size,
          error += score.probes[k].std_error * score.probes[k].std_error;
    const auto n = static_cast<double>(alternative.size());
    out.sizes.push_back({std::sqrt(size / n), std::sqrt(error / n)});
  }
  return out;
}

std::vector<HealthyScore> score_drive(const Log& log, const KnownRig& known) {
  std::vector<HealthyScore> out;
  DriveSubject drive({log}, known);
  if (drive.empty()) return out;
  const ExplainedFit fit = fit_base(drive, EngineOptions{}.iterations);
  if (!fit.ok) return out;
  for (const CauseScore& s : score_causes(drive, fit)) out.push_back(summarise(drive, s));
  return out;
}

ScoredBlocks score_blocks(const ValveSubject& valve, const Point& at, const KnownRig& known) {
  ScoredBlocks out;
  ReplaySubject blocks(valve, at, known);
  if (blocks.empty()) return out;
  const ExplainedFit fit = fit_base(blocks, EngineOptions{}.iterations);
  if (!fit.ok) return out;
  for (const CauseScore& s : score_causes(blocks, fit))
    if (!s.probes.empty()) out.scores.push_back(summarise(blocks, s));
  out.misses = blocks.misses(fit.residual);
  return out;
}

}  // namespace servodx
