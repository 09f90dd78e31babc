// A valve under watch: samples in, events out. A state machine; it reads no clock and no file.
//
// Time is the log's. The simulation runs along (residuals.h), the evidence is held against the limits part by part
// (evidence.h, alarm_limits.h), and an alarm names what has begun (sudden.h). A second after an alarm the last window
// is due for a diagnosis, which is the caller's to make.
#pragma once
#include <deque>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "faults/gross_finding.h"
#include "online/alarm_limits.h"
#include "online/arrivals.h"
#include "online/evidence.h"
#include "online/residuals.h"
#include "online/sudden.h"
#include "online/watched_model.h"
#include "servodx/log.h"
#include "signals/sample.h"

namespace servodx {

enum class WatchEventKind {
  alarm,    // the log is not a healthy valve's
  named,    // the alarm's name has become another
  window,   // the last window is due for a diagnosis
  cleared,  // all is as healthy again
  restart,  // the simulation has begun anew: a gap, or it had left the finite numbers
};

struct WatchEvent {
  long number = 0;  // of the watch, from 1: after a restart the same event has the same number
  WatchEventKind kind = WatchEventKind::alarm;
  double time = 0;                          // [s] of the sample that gave the evidence
  double told_at = 0;                       // [s] of the last sample that was known then
  std::optional<Signal> signal = {};        // whose level passed its limit; coil_current: the driver
  double window = 0;                        // [s] of that level
  double level = 0, limit = 0;              // [deviates^2]
  GrossFinding gross = GrossFinding::none;  // seen without a model
  bool supply = false;  // the measured supply is out of its band: level and limit are its distance from the middle [Pa]
  double onset = 0;     // [s] of an alarm: the last time that all was quiet
  std::string name = {};  // label of the fault that the samples since then look like; empty: none
};

class Watcher {
 public:
  Watcher(WatchedModel model, WatchLimits limits, std::vector<Signal> recorded);
  Watcher(const Watcher&) = delete;

  void take(const Sample& sample, std::vector<WatchEvent>& events);
  // What has come of a part that is not full: no more will come for some time.
  void flush(std::vector<WatchEvent>& events);
  // A sample from before a saved state: for the window alone.
  void remember(const Sample& sample);

  std::vector<Sample> window() const { return {window_.begin(), window_.end()}; }
  double time() const { return arrivals_.last_taken; }  // [s] of the last sample that was judged
  double window_begins() const { return window_.empty() ? time() : window_.front().time; }
  const ArrivalCounts& counts() const { return arrivals_.counts; }
  const std::vector<Signal>& recorded() const { return recorded_; }

  nlohmann::json state() const;
  // Throws InputError where the state is another log's or damaged.
  void resume(const nlohmann::json& state);

 private:
  struct Alarm {
    WatchEvent event;
    std::size_t names_asked = 0;
    bool window_given = false;
    double calm_since = 0;  // [s]
  };
  void judge(std::span<const Sample> part, std::vector<WatchEvent>& events);
  void judge_level(const Residual& residual, std::vector<WatchEvent>& events);
  void judge_gross(std::vector<WatchEvent>& events);
  void judge_supply(std::vector<WatchEvent>& events);
  double supply_strays() const;  // [Pa] from the middle of its band
  void follow_alarm(std::vector<WatchEvent>& events);
  void raise(WatchEvent event, std::vector<WatchEvent>& events);
  std::string name_now(const WatchEvent& alarm) const;
  std::span<const Sample> since(double time) const;

  WatchedModel model_;
  std::vector<Signal> recorded_;
  Residuals residuals_;
  SlidingEvidence evidence_;
  std::vector<Levels> limit_;  // of each channel
  std::optional<SupplyBand> supply_;
  Arrivals arrivals_;
  std::deque<Sample> window_;
  mutable std::vector<Sample> span_;
  std::optional<Alarm> alarm_;
  double gross_asked_ = -1e300;  // [s]
  long events_ = 0, restarts_ = 0;
};

}  // namespace servodx
