// Logs to a baseline: each assessed alone, then scored by the others.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parts_done.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/constants.h"
#include "diagnose/diagnose.h"
#include "diagnose/judgeable.h"
#include "fit/tuned_state.h"
#include "parameters/table.h"
#include "servodx/data_sheet.h"
#include "servodx/diagnose.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/watch.h"
#include "simulate/side_by_side.h"

namespace servodx {

void require_logs_for_baseline(const std::vector<Log>& logs, const std::vector<Log>& others, const Table& tuned) {
  const TunedState state = tuned_state(tuned);
  std::vector<std::string> content;
  for (const Log& log : logs) content.push_back(content_hash(log));
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (state.is_by(logs[i]))
      throw InputError({.file = logs[i].path},
                       "this log tuned " + tuned.path + ": its residual is smaller than a new log's",
                       "give fault-free logs that the fit has not seen");
    for (std::size_t j = 0; j < i; ++j)
      if (content[j] == content[i])
        throw InputError({.file = logs[i].path}, "the same log as " + logs[j].path,
                         "give each log once: the rate counts independent logs");
  }
  for (const Log& log : others)
    if (std::find(content.begin(), content.end(), content_hash(log)) != content.end())
      throw InputError({.file = log.path}, "is one of the baseline's own logs as well",
                       "give each log once: to the baseline, or as one of other tests");
  if (logs.size() < diagnose_constants::fewest_logs)
    throw InputError({}, fmt::format("{} logs cannot set a threshold", logs.size()),
                     "give at least 3 fault-free logs; the rate that can be promised is 1/(n+1)");
}

namespace {

// Logs assessed alone, side by side. Ended early: those done so far.
class Assessing {
 public:
  Assessing(const Table& tuned, const RigFile& rig, const DiagnoseOptions& options, std::size_t logs)
      : tuned_(tuned), rig_(rig), options_(options), told_(options.watch, "baseline", logs) {}

  std::vector<Assessment> all(const std::vector<Log>& logs) {
    std::vector<std::optional<Assessment>> done(logs.size());
    side_by_side(static_cast<int>(logs.size()), options_.threads, [&](int piece, int threads) {
      const auto at = static_cast<std::size_t>(piece);
      if (!options_.watch.stopped()) done[at] = one(logs[at], before_ + at, threads);
    });
    before_ += logs.size();
    std::vector<Assessment> out;
    for (std::optional<Assessment>& a : done) {
      if (!a) continue;
      simulations += a->simulations, failed += a->failed_simulations;
      out.push_back(std::move(*a));
    }
    return out;
  }
  long simulations = 0, failed = 0;

 private:
  // None where it was stopped on the way. `place`: among all logs.
  std::optional<Assessment> one(const Log& log, std::size_t place, int threads) {
    DiagnoseOptions of_log = options_;
    of_log.threads = threads;
    of_log.watch = told_.of(place);
    Assessment a = assess(log, tuned_, rig_, of_log);
    if (options_.watch.stopped()) return {};
    if (a.unjudgeable != Unjudgeable::no)
      throw InputError({.file = log.path},
                       "no valve answers in this log: its command or its sensors stand still, noise is all, or a "
                       "unit is wrong",
                       "see 'servodx check-log', and mend the rig file or leave the log out");
    told_.tell(place, 1, a.simulations);
    return a;
  }

  const Table& tuned_;
  const RigFile& rig_;
  const DiagnoseOptions& options_;
  PartsDone told_;
  std::size_t before_ = 0;  // logs of earlier calls
};

}  // namespace

DetectionBaseline make_baseline(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                                double false_alarm, const DiagnoseOptions& options, long* simulations, long* failed,
                                const std::vector<Log>& others) {
  options.validate();
  if (!(false_alarm > 0 && false_alarm < 1))
    throw InputError({.file = "--false-alarm"}, fmt::format("{} is not a rate", false_alarm),
                     "give a number between 0 and 1, such as 0.01");
  require_logs_for_baseline(logs, others, tuned);
  Assessing assessing(tuned, rig, options, logs.size() + others.size());
  const std::vector<Assessment> healthy = assessing.all(logs), of_others = assessing.all(others);
  if (simulations) *simulations += assessing.simulations;
  if (failed) *failed += assessing.failed;
  DetectionBaseline b = baseline_of(healthy, false_alarm, of_others);
  b.null_limit = rig.null_limit;
  b.tuned_sha256 = content_hash(tuned);
  return b;
}

}  // namespace servodx
