// From which level on a healthy valve would be an alarm once in so many hours: learnt from healthy logs.
//
// Each channel and window is one question. The largest level of every half second of healthy data is a figure; what one
// more half second shows is the tail law's (evidence/tail_law.h) at the question's share of the rate. That the tail is
// exponential is an assumption, so a limit is at least some times what healthy data have shown. Data of another kind
// than these logs may have a heavier tail: the logs should hold what the valve does all day.
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "online/evidence.h"
#include "online/watched_model.h"
#include "servodx/log.h"
#include "signals/sample.h"

namespace servodx {

struct ChannelLimits {
  Levels limit{};    // [deviates^2]
  Levels healthy{};  // largest of healthy data
};

// The measured supply needs no model: how far it may stray from its level on healthy logs.
struct SupplyBand {
  double level = 0;    // [Pa] median
  double healthy = 0;  // [Pa] furthest that a short mean of healthy data strays
  double limit = 0;    // [Pa]
};

struct WatchLimits {
  double alarms_per_hour = 0;
  double healthy_seconds = 0;  // that the limits rest on
  int logs = 0;
  std::map<Signal, ChannelLimits> channels;
  std::map<Signal, double> noise;         // [SI] rms
  std::optional<SupplyBand> supply = {};  // none: no healthy log recorded it
};

// Without a log the limits are those of the error model and the usual tail alone.
WatchLimits learn_limits(const std::vector<Log>& healthy, WatchedModel model, double alarms_per_hour);
// Mean supply pressure of the last short while. [Pa] NaN where so much is not there.
double recent_supply(std::span<const Sample> samples);
// Of a channel that no healthy log had: as one whose levels are usual.
ChannelLimits usual_limits(double alarms_per_hour, std::size_t channels);

}  // namespace servodx
