#include "report/shared/going_on.h"

#include <fmt/format.h>

namespace servodx::report {

std::string how_to_go_on(const std::string& limit, const std::string& checkpoint) {
  const std::string ended = limit.empty() ? "interrupted" : fmt::format("ended by the time limit of {}", limit);
  if (checkpoint.empty())
    return ended + ": what was finished is lost; with --checkpoint FILE it would be kept, to go on with --resume";
  return fmt::format("{}: to go on, give the same call with --resume; what is finished is in {}", ended, checkpoint);
}

std::string words_of(const CheckpointReport& report, const std::string& checkpoint, bool resumed) {
  std::string text = report.trouble.empty() ? "" : fmt::format("{}: {}\n", checkpoint, report.trouble);
  if (resumed && report.taken > 0)
    text +=
        fmt::format("{}: {} finished stages were taken from it, {} were made\n", checkpoint, report.taken, report.kept);
  else if (resumed)
    text +=
        fmt::format("{}: nothing in it is of this call, by these logs, table, options and program; all was made anew\n",
                    checkpoint);
  return text;
}

std::string too_few_for_a_baseline(std::size_t scored, std::size_t logs) {
  return fmt::format("{} of {} logs were scored, too few for a baseline: none is written", scored, logs);
}

}  // namespace servodx::report
