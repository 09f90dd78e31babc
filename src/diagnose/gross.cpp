#include "diagnose/gross.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "diagnose/constants.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

struct Range {
  double lowest = 1e300, highest = -1e300;
  void take(double x) { lowest = std::min(lowest, x), highest = std::max(highest, x); }
  double width() const { return highest - lowest; }
};

struct SpoolLook {
  long samples = 0;
  long quiet = 0, up = 0, down = 0;  // samples at small current; of them on the upper and on the lower stop
  Range spool, command;              // [m], [A]
};

SpoolLook look_at(const FitChannel& spool, const LogData& log, const ParameterVector& base) {
  SpoolLook look;
  const double stop = k::near_stop * base[row::spool_stop], small = k::small_current * log.scenario.rated_current;
  for (std::size_t i = 0; i < spool.measured.size(); ++i) {
    const double x = spool.measured[i];
    const double current = log.scenario.command[i] + base[row::servovalve_null] * log.scenario.rated_current;
    if (std::isnan(x)) continue;
    ++look.samples;
    look.spool.take(x), look.command.take(current);
    if (std::abs(current) > small) continue;
    ++look.quiet;
    look.up += x > stop;
    look.down += x < -stop;
  }
  return look;
}

}  // namespace

GrossFinding gross_finding(const LogData& log, const ParameterVector& base) {
  const auto spool = std::find_if(log.channels.begin(), log.channels.end(),
                                  [](const FitChannel& c) { return c.signal == Signal::spool_position; });
  if (spool == log.channels.end()) return GrossFinding::none;
  const SpoolLook look = look_at(*spool, log, base);
  if (look.samples == 0) return GrossFinding::none;
  const auto beyond = [&](long on_stop, long one_in) { return on_stop > look.quiet / one_in; };
  if (beyond(look.up, k::both_stops_one_in) && beyond(look.down, k::both_stops_one_in))
    return GrossFinding::spool_on_both_stops;
  if (beyond(look.up, k::one_stop_one_in) || beyond(look.down, k::one_stop_one_in))
    return GrossFinding::spool_on_one_stop;
  const double asked = look.command.width() / log.scenario.rated_current * base[row::spool_stop];
  if (asked > k::least_asked * base[row::spool_stop] && look.spool.width() < k::response_missing * asked)
    return GrossFinding::no_response;
  return GrossFinding::none;
}

GrossFinding gross_finding(const ReadyLogs& logs, const ParameterVector& base) {
  GrossFinding plainest = GrossFinding::none;
  for (std::size_t l = 0; l < logs.data.size(); ++l) {
    const GrossFinding found = gross_finding(logs.every_sample(l), base);
    if (found == GrossFinding::none) continue;
    plainest = plainest == GrossFinding::none ? found : std::min(plainest, found);
  }
  return plainest;
}

}  // namespace servodx
