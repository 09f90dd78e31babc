#include "online/watcher.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "faults/gross_finding.h"
#include "online/constants.h"
#include "servodx/error.h"
#include "servodx/log.h"

namespace servodx {

namespace k = online_constants;

namespace {

WatchedModel with_noise(WatchedModel model, const WatchLimits& limits) {
  model.noise = limits.noise;
  return model;
}

}  // namespace

Watcher::Watcher(WatchedModel model, WatchLimits limits, std::vector<Signal> recorded)
    : model_(with_noise(std::move(model), limits)),
      recorded_(std::move(recorded)),
      residuals_(model_, recorded_),
      evidence_(residuals_.channels().size()),
      supply_(limits.supply) {
  for (Signal s : residuals_.channels()) {
    const auto known = limits.channels.find(s);
    limit_.push_back(known == limits.channels.end()
                         ? usual_limits(limits.alarms_per_hour, residuals_.channels().size()).limit
                         : known->second.limit);
  }
}

void Watcher::take(const Sample& sample, std::vector<WatchEvent>& events) {
  // What is there is judged by itself: the run does not go on over a long gap.
  if (sample.time > arrivals_.newest() + k::longest_gap) flush(events);
  if (arrivals_.add(sample)) flush(events);
}

void Watcher::flush(std::vector<WatchEvent>& events) {
  if (arrivals_.empty()) return;
  const std::vector<Sample> part = arrivals_.take();
  judge(part, events);
}

void Watcher::remember(const Sample& sample) {
  if (!window_.empty() && sample.time <= window_.back().time) return;
  window_.push_back(sample);
  while (window_.front().time < sample.time - k::kept) window_.pop_front();
}

void Watcher::judge(std::span<const Sample> part, std::vector<WatchEvent>& events) {
  // A clock that was set back begins another log.
  if (!window_.empty() && part.front().time <= window_.back().time) window_.clear(), gross_asked_ = -1e300;
  for (const Sample& s : part) remember(s);
  const auto residuals = residuals_.take(part);
  if (residuals_.restarts() > restarts_) {
    restarts_ = residuals_.restarts();
    evidence_.restart();
    events.push_back(
        {.number = ++events_, .kind = WatchEventKind::restart, .time = part.front().time, .told_at = part.back().time});
  }
  for (const Residual& r : residuals) {
    evidence_.take(r, limit_);
    if (!alarm_ && r.comparable) judge_level(r, events);
  }
  if (!alarm_) judge_supply(events);
  if (!alarm_) judge_gross(events);
  if (alarm_) follow_alarm(events);
}

// The question that is furthest beyond its limit.
void Watcher::judge_level(const Residual& residual, std::vector<WatchEvent>& events) {
  WatchEvent worst{.time = residual.time};
  double most = 1;
  for (std::size_t c = 0; c < limit_.size(); ++c)
    for (std::size_t w = 0; w < limit_[c].size(); ++w) {
      const double level = evidence_.levels()[c][w];
      if (!(level / limit_[c][w] > most)) continue;
      most = level / limit_[c][w];
      worst.signal = residuals_.channels()[c];
      worst.window = k::windows[w], worst.level = level, worst.limit = limit_[c][w];
      worst.onset = std::max(evidence_.quiet_until(c), window_begins());
    }
  if (most > 1) raise(worst, events);
}

double Watcher::supply_strays() const {
  if (!supply_ || window_.empty()) return 0;
  const double now = recent_supply(since(time() - k::supply_window));
  return std::isnan(now) ? 0 : std::abs(now - supply_->level);
}

void Watcher::judge_supply(std::vector<WatchEvent>& events) {
  const double strays = supply_strays();
  if (!supply_ || !(strays > supply_->limit)) return;
  const double onset = std::max(time() - k::supply_window, window_begins());
  WatchEvent event{.time = time(), .signal = Signal::supply_pressure, .window = k::supply_window};
  event.level = strays, event.limit = supply_->limit, event.supply = true, event.onset = onset;
  raise(event, events);
}

void Watcher::judge_gross(std::vector<WatchEvent>& events) {
  if (time() < gross_asked_ + k::gross_every || window_.empty()) return;
  gross_asked_ = time();
  const auto samples = since(time() - k::gross_window);
  if (samples.back().time - samples.front().time < 0.9 * k::gross_window) return;
  const GrossFinding found = gross_finding_in(model_, samples);
  if (found == GrossFinding::none) return;
  raise({.time = time(), .gross = found, .onset = samples.front().time}, events);
}

void Watcher::raise(WatchEvent event, std::vector<WatchEvent>& events) {
  event.number = ++events_;
  event.kind = WatchEventKind::alarm;
  event.told_at = time();
  event.name = name_now(event);
  alarm_ = Alarm{.event = event, .calm_since = event.time};
  events.push_back(event);
}

std::string Watcher::name_now(const WatchEvent& alarm) const {
  SuddenEvidence evidence;
  evidence.driver = alarm.signal == Signal::coil_current;
  evidence.gross = alarm.gross;
  evidence.supply = alarm.supply;
  if (evidence.gross == GrossFinding::none) evidence.gross = gross_finding_in(model_, since(alarm.onset - k::lead));
  const auto samples = since(alarm.onset - k::lead);
  evidence.samples = samples.size();
  evidence.scores = score_failures(model_, samples, residuals_.channels());
  return name_of(evidence);
}

std::span<const Sample> Watcher::since(double time) const {
  const auto from =
      std::lower_bound(window_.begin(), window_.end(), time, [](const Sample& s, double t) { return s.time < t; });
  span_.assign(from, window_.end());
  return span_;
}

void Watcher::follow_alarm(std::vector<WatchEvent>& events) {
  Alarm& a = *alarm_;
  const double now = time(), after = now - a.event.time;
  if (a.names_asked < k::named_again.size() && after >= k::named_again[a.names_asked]) {
    ++a.names_asked;
    const std::string name = name_now(a.event);
    if (name != a.event.name) {
      a.event.name = name;
      WatchEvent event = a.event;
      event.number = ++events_, event.kind = WatchEventKind::named, event.time = event.told_at = now;
      events.push_back(event);
    }
  }
  if (!a.window_given && after >= k::after_alarm) {
    a.window_given = true;
    WatchEvent event = a.event;
    event.number = ++events_, event.kind = WatchEventKind::window, event.time = event.told_at = now;
    events.push_back(event);
  }
  bool calm = true;
  for (std::size_t c = 0; c < limit_.size(); ++c)
    for (std::size_t w = 0; w < limit_[c].size(); ++w)
      calm = calm && evidence_.levels()[c][w] < k::cleared_part * limit_[c][w];
  calm = calm && !(supply_ && supply_strays() > k::cleared_part * supply_->limit);
  if (!calm) a.calm_since = now;
  if (a.window_given && now - a.calm_since >= k::cleared_time) {
    WatchEvent event{.number = ++events_, .kind = WatchEventKind::cleared, .time = now, .told_at = now};
    alarm_.reset();
    events.push_back(event);
  }
}

nlohmann::json Watcher::state() const {
  nlohmann::json out;
  for (Signal s : recorded_) out["recorded"].push_back(name_of(s));
  out["residuals"] = residuals_.state();
  out["evidence"] = evidence_.state();
  out["last"] = arrivals_.last_taken;
  // What waits for its part to be full comes again to whoever goes on from here.
  out["counts"] = {arrivals_.counts.taken - arrivals_.waiting(), arrivals_.counts.late, arrivals_.counts.repeated};
  out["events"] = events_, out["restarts"] = restarts_, out["gross_asked"] = gross_asked_;
  out["alarm"] = nullptr;
  if (alarm_) {
    const WatchEvent& e = alarm_->event;
    out["alarm"] = {{"number", e.number},
                    {"time", e.time},
                    {"told_at", e.told_at},
                    {"signal", e.signal ? index(*e.signal) : -1},
                    {"window", e.window},
                    {"level", e.level},
                    {"limit", e.limit},
                    {"gross", static_cast<int>(e.gross)},
                    {"supply", e.supply},
                    {"onset", e.onset},
                    {"name", e.name},
                    {"names_asked", alarm_->names_asked},
                    {"window_given", alarm_->window_given},
                    {"calm_since", alarm_->calm_since}};
  }
  return out;
}

namespace {

// Of a list that has so many; a file may hold any number.
int position_in(const nlohmann::json& number, int count) {
  const auto n = number.get<double>();
  if (!(n >= 0 && n < count))
    throw InputError({.file = "--state"}, "the state is damaged", "remove the state file and begin anew");
  return static_cast<int>(n);
}

}  // namespace

void Watcher::resume(const nlohmann::json& state) {
  try {
    std::vector<std::string> names;
    for (Signal s : recorded_) names.emplace_back(name_of(s));
    if (state.at("recorded").get<std::vector<std::string>>() != names)
      throw InputError({.file = "--state"}, "the state is of a log with other signals", "take another state file");
    residuals_.resume(state.at("residuals"));
    evidence_.resume(state.at("evidence"));
    arrivals_.last_taken = state.at("last");
    const auto& counts = state.at("counts");
    arrivals_.counts = {counts.at(0), counts.at(1), counts.at(2)};
    events_ = state.at("events"), restarts_ = state.at("restarts"), gross_asked_ = state.at("gross_asked");
    const auto& a = state.at("alarm");
    if (a.is_null()) return;
    Alarm alarm;
    WatchEvent& e = alarm.event;
    e.number = a.at("number"), e.time = a.at("time"), e.told_at = a.at("told_at");
    if (a.at("signal") != -1) e.signal = static_cast<Signal>(position_in(a.at("signal"), n_signals));
    e.window = a.at("window"), e.level = a.at("level"), e.limit = a.at("limit");
    e.gross = static_cast<GrossFinding>(position_in(a.at("gross"), 1 + static_cast<int>(GrossFinding::no_response)));
    e.supply = a.value("supply", false);
    e.onset = a.at("onset"), e.name = a.at("name");
    alarm.names_asked = a.at("names_asked"), alarm.window_given = a.at("window_given");
    alarm.calm_since = a.at("calm_since");
    alarm_ = alarm;
  } catch (const nlohmann::json::exception&) {
    throw InputError({.file = "--state"}, "the state is damaged", "remove the state file and begin anew");
  }
}

}  // namespace servodx
