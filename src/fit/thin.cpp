#include "fit/thin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/present.h"
#include "base/tiny.h"
#include "fit/ports_of.h"
#include "fit/recorder.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/drive_of.h"
#include "signals/usual_step.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

// Mean of what is present in [from, to).
double mean_of(const std::vector<double>& x, std::size_t from, std::size_t to) {
  return mean_of_present(from, to, [&](std::size_t k) { return x[k]; });
}

// Fastest change of the command, as means of neighbouring half seconds tell it: readings that toggle between two steps
// of a converter are no motion. [A/s]
double fastest(const std::vector<double>& t, const std::vector<double>& command, double step) {
  const auto half = static_cast<std::size_t>(std::max(1.0, std::round(0.5 / step)));
  double most = 0;
  for (std::size_t k = 0; k + 2 * half <= t.size(); k += std::max<std::size_t>(1, half / 4)) {
    const double rate =
        (mean_of(command, k + half, k + 2 * half) - mean_of(command, k, k + half)) / (t[k + half] - t[k]);
    if (!std::isnan(rate)) most = std::max(most, std::abs(rate));
  }
  return most;
}

// [s] over which the command of a stand's log moves by `thin_travel` at most; 0: not of a stand, or too short.
double creeping_time(const Log& log, const RigFile& rig) {
  const Signal drive = drive_of(log);
  if (ports_of(log, rig) == Ports::actuator || log.samples() < 3 || !log.has(drive)) return 0;
  const double travel = thin_travel * rig.fact("valve.rated_current").value_or(0.02);
  return std::min(thin_time, travel / std::max(fastest(log.time, log[drive], usual_step(log.time)), tiny));
}

}  // namespace

double creep_step_of(const std::vector<Log>& logs, const RigFile& rig) {
  double step = thin_time / 2;
  for (const Log& log : logs)
    if (ports_of(log, rig) != Ports::actuator) step = std::min(step, creeping_time(log, rig) / 2);
  return std::max(step, SimulateOptions{}.creep_step);
}

Log thinned(const Log& log, const RigFile& rig) {
  if (log.samples() < 3) return log;
  const double span = creeping_time(log, rig), step = usual_step(log.time);
  const auto group = static_cast<std::size_t>(span / step * (1 + 1e-9));
  if (group < 2) return log;

  Log out = log;
  out.time.clear();
  for (Channel& c : out.channels) c.value.clear(), c.missing = 0;
  for (std::size_t from = 0, to = 0; from < log.samples(); from = to) {
    // A group ends at a gap: its mean would be of two places.
    for (to = from + 1;
         to < log.samples() && to < from + group && log.time[to] - log.time[to - 1] < gap_over_step * step;)
      ++to;
    out.time.push_back(mean_of(log.time, from, to));
    for (std::size_t c = 0; c < out.channels.size(); ++c) {
      if (log.channels[c].value.empty()) continue;
      out.channels[c].value.push_back(mean_of(log.channels[c].value, from, to));
      out.channels[c].missing += std::isnan(out.channels[c].value.back());
    }
  }
  out.notes.push_back(
      {Note::Kind::resampled, fmt::format("{}: the command creeps; {} samples are taken as {} means over {:.2g} s",
                                          log.path, log.samples(), out.samples(), static_cast<double>(group) * step)});
  return out;
}

LogData prepare_thinned(const Log& log, const RigFile& rig, const Recorder& recorder) {
  const Log taken = thinned(log, rig);
  LogData out = prepare(taken, rig, recorder);
  if (taken.samples() < log.samples()) out.scenario.command_slope = 1.0;
  return out;
}

}  // namespace servodx
