// The front door of what pages draw.
#include <algorithm>

#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "explain/explain.h"
#include "fit/bode.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/replay.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/diagnose/verdict_words.h"
#include "servodx/baseline.h"
#include "servodx/bode.h"
#include "servodx/diagnose.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/pages.h"
#include "servodx/replay.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "store/baseline_parts.h"
#include "store/logo_file.h"
#include "store/truth_file.h"
#include "tune/tune.h"

namespace servodx {

Replay replay_of(const Log& log, const Table& table, const Rig& rig, const std::string& name) {
  return replay(log, table, rig, {{name, candidate_of(table)}});
}

std::vector<Replay> replays_of(const Tuned& tuned, const std::vector<Log>& logs, const Rig& rig, std::size_t most) {
  std::vector<Replay> out;
  if (!tuned.whole) return out;
  for (std::size_t l = 0; l < std::min(logs.size(), most); ++l)
    out.push_back(replay(logs[l], tuned.whole->table, rig, {{"tuned", tuned.whole->logs[l].candidate}}));
  return out;
}

std::vector<Replay> replays_of(const Baseline& baseline, const std::vector<Log>& logs, const Tuned& tuned,
                               const Rig& rig, std::size_t most) {
  const std::vector<DetectionBaseline::Score>& scores = parts_of(baseline).detection.scores;
  std::vector<Replay> out;
  for (std::size_t i = 0; i < std::min(scores.size(), most); ++i)
    if (const auto& healthy = scores[i].healthy)
      out.push_back(replay(logs[i], tuned.table, rig, report::candidates_of({*healthy})));
  return out;
}

std::vector<Replay> replays_of(const Explanation& explanation, const std::vector<Log>& logs, const Tuned& tuned,
                               const Rig& rig, std::size_t most) {
  std::vector<Replay> out;
  if (!explanation.whole) return out;
  const ExplainResult& result = *explanation.whole;
  for (std::size_t l = 0; l < std::min(logs.size(), most); ++l) {
    std::vector<Candidate> candidates = {{"as tuned", result.before[l]}};
    if (!result.causes.empty()) candidates.push_back({"extended", result.after[l]});
    out.push_back(replay(logs[l], tuned.table, rig, candidates));
  }
  return out;
}

std::vector<Replay> replays_of(const std::vector<Verdict>& verdicts, const std::vector<Log>& logs, const Tuned& tuned,
                               const Rig& rig, std::size_t most) {
  std::vector<const Diagnosis*> worst;
  for (const Verdict& v : verdicts)
    if (v.whole) worst.push_back(v.whole.get());
  std::stable_sort(worst.begin(), worst.end(), [](const auto* a, const auto* b) { return a->error > b->error; });
  if (worst.size() > most) worst.resize(most);
  std::vector<Replay> out;
  for (const Diagnosis* d : worst) {
    const auto log =
        std::find_if(logs.begin(), logs.end(), [&](const Log& l) { return l.path == d->assessment.logs.front(); });
    if (log != logs.end())
      out.push_back(replay(*log, tuned.table, rig, report::candidates_of(d->assessment.explanations)));
  }
  return out;
}

std::vector<Bode> bodes_of(const Verdict& verdict, const Tuned& tuned, const Rig& rig) {
  if (!verdict.whole || verdict.kind == Verdict::Kind::unknown) return {};
  const Diagnosis& d = *verdict.whole;
  for (const HypothesisPrediction& h : d.assessment.explanations)
    if (h.fault == d.fault && !h.candidate.empty())
      return bode_of(
          {{"as tuned", candidate_of(tuned.table)}, {d.fault ? report::label_of(d.fault) : "this log", h.candidate}},
          rig);
  return {};
}

std::string logo_of(const Rig& rig) { return store::read_logo(rig); }

std::string truth_beside(const Log& log) { return store::truth_beside(log.path, log.sha256); }

}  // namespace servodx
