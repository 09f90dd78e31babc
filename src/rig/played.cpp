#include "rig/played.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "base/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx::rig {
namespace {

constexpr double even = 0.01;  // of a step: stamps may be off by so much

// Steps a second; stamps that jitter are no command to play.
double rate_of(const Log& log) {
  const double step = (log.time.back() - log.time.front()) / static_cast<double>(log.samples() - 1);
  for (std::size_t n = 0; n < log.samples(); ++n)
    if (std::abs(log.time[n] - log.time.front() - static_cast<double>(n) * step) > even * step)
      throw InputError({log.path, 0, "time"}, "the samples of a command to play are not evenly spaced",
                       "give it at a constant rate");
  constexpr double hundred = 100;  // a rate that was written as rounded stamps
  return std::round(hundred / step) / hundred;
}

double held(const std::vector<double>& value, double at) {
  const auto n = static_cast<long>(std::floor(at + even));
  return value[static_cast<std::size_t>(std::clamp(n, 0L, static_cast<long>(value.size()) - 1))];
}

void require_whole(const Log& log, Signal signal) {
  if (log.channels[static_cast<std::size_t>(index(signal))].missing > 0)
    throw InputError({log.path, 0, std::string(name_of(signal))}, "a command to play has empty cells", "fill them");
}

}  // namespace

PlayedCommand played_command(const std::string& path, const RigModel& model, std::optional<double> loop_gain) {
  RigFile facts;
  facts.facts["valve.rated_current"] = model.driver_rated_current;
  const auto log = std::make_shared<const Log>(
      read_log(path, facts, {.minimum_rows = 2, .require_response = false, .require_drive = !loop_gain}));
  if (loop_gain && !log->has(Signal::setpoint))
    throw InputError({path, 0, ""}, "holds no setpoint, and a position loop needs one",
                     "add a column 'setpoint [mm]', or leave out --loop-gain");
  if (!loop_gain && !log->has(Signal::command))
    throw InputError({path, 0, ""}, "holds no command", "add a column 'command [mA]'");
  const Signal drive = loop_gain ? Signal::setpoint : Signal::command;
  require_whole(*log, drive);
  const double rate = rate_of(*log);
  PlayedCommand out;
  out.rate = rate;
  out.duration = static_cast<double>(log->samples()) / rate;
  out.sha256 = log->sha256;
  if (loop_gain) {
    const auto setpoint = [log, rate](double t) { return held((*log)[Signal::setpoint], t * rate); };
    out.stimulus.command = [setpoint, gain = *loop_gain](double t, double x) { return gain * (setpoint(t) - x); };
    out.stimulus.setpoint = setpoint;
  } else {
    out.stimulus.command = [log, rate](double t, double) { return held((*log)[Signal::command], t * rate); };
  }
  return out;
}

}  // namespace servodx::rig
