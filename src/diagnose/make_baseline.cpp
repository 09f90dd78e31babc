// Logs to a baseline: each assessed alone, then scored by the others.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/diagnose.h"
#include "diagnose/judgeable.h"
#include "fit/nominal.h"
#include "fit/tuned_state.h"
#include "parameters/table.h"
#include "servodx/diagnose.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/watch.h"

namespace servodx {
namespace {

constexpr std::size_t fewest_logs = 3;

void check(const std::vector<Log>& logs, const Table& tuned, double false_alarm) {
  if (!(false_alarm > 0 && false_alarm < 1))
    throw InputError({.file = "--false-alarm"}, fmt::format("{} is not a rate", false_alarm),
                     "give a number between 0 and 1, such as 0.01");
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
  if (logs.size() < fewest_logs)
    throw InputError({}, fmt::format("{} logs cannot set a threshold", logs.size()),
                     "give at least 3 fault-free logs; the rate that can be promised is 1/(n+1)");
}

}  // namespace

DetectionBaseline make_baseline(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                                double false_alarm, const DiagnoseOptions& options, long* simulations, long* failed) {
  options.validate();
  check(logs, tuned, false_alarm);
  const auto logs_in_all = static_cast<double>(logs.size());
  long total = 0;
  std::vector<Assessment> assessed;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    DiagnoseOptions of_log = options;
    if (options.watch.progress)
      of_log.watch.progress = [&](const WorkDone& of_one) {
        options.watch.tell("baseline", (static_cast<double>(i) + of_one.part) / logs_in_all,
                           total + of_one.simulations);
      };
    Assessment a = assess(logs[i], tuned, rig, of_log);
    if (options.watch.stopped()) break;
    if (a.unjudgeable != Unjudgeable::no)
      throw InputError({.file = logs[i].path},
                       "no valve answers in this log: its command or its sensors stand still, noise is all, or a unit "
                       "is wrong",
                       "see 'servodx check-log', and mend the rig file or leave the log out");
    total += a.simulations;
    if (simulations) *simulations += a.simulations;
    if (failed) *failed += a.failed_simulations;
    options.watch.tell("baseline", static_cast<double>(i + 1) / logs_in_all, total);
    assessed.push_back(std::move(a));
  }
  DetectionBaseline b = baseline_of(assessed, false_alarm);
  b.null_limit = rig.null_limit;
  b.tuned_sha256 = tuned.sha256;
  return b;
}

}  // namespace servodx
