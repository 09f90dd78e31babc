#include "list_run.h"

#include <atomic>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/trouble.h"
#include "report/fleet/fleet.h"
#include "servodx/log.h"

namespace servodx {

std::optional<InputError> refusal_of(const std::string& log, const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const InputError& error) {
    return error;
  } catch (const std::exception& failure) {
    return InputError({log, 0, ""}, std::string("failed inside: ") + failure.what(), "report it");
  }
}

void count(ListRun& run, RowEnd end, const std::optional<SetAside>& refusal, Progress& progress) {
  switch (end) {
    case RowEnd::made:
      ++run.made;
      break;
    case RowEnd::stood:
      ++run.stood;
      break;
    case RowEnd::set_aside:
      run.set_aside.push_back(*refusal);
      progress.say("set aside: " + report::words_of(*refusal));
      break;
    case RowEnd::interrupted:
      run.interrupted = true;
      break;
  }
}

void run_list(const std::string& label, ListRun& run, bool quiet,
              const std::function<void(std::size_t place, Progress& progress, const Tell& tell)>& row) {
  const std::atomic<bool>& stop = stop_on_interrupt(true);
  Progress progress(label, {.quiet = quiet});
  const Tell tell = [&] { progress.update_logs(run.done(), run.logs, run.made); };
  for (std::size_t place = 0; place < run.logs; ++place) {
    if (stop) run.interrupted = true;
    if (run.interrupted) break;
    row(place, progress, tell);
    tell();
  }
}

void rehearse_list(const std::vector<std::string>& logs, const RigFile& rig, report::Header& header) {
  std::size_t refused_logs = 0;
  for (const std::string& path : logs) try {
      read_log(path, rig);
    } catch (const InputError& error) {
      std::fprintf(stderr, "%s: would be set aside: %s\n", header.command.c_str(), told(error).c_str());
      ++refused_logs;
    }
  (*header.settings)["logs"] = logs.size();
  (*header.settings)["would_be_set_aside"] = refused_logs;
}

std::vector<std::string> interrupt_notice(const ListRun& run) {
  if (!run.interrupted) return {};
  return {"interrupted: what is done is kept, and the same call goes on from there"};
}

ExitCode code_of(const ListRun& run) {
  if (run.interrupted) return interrupted;
  return run.set_aside.empty() ? ran : some_set_aside;
}

}  // namespace servodx
