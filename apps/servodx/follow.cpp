#include "follow.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/byte_tail.h"
#include "base/csv.h"
#include "base/progress.h"
#include "base/sha256.h"
#include "fleet_judge.h"
#include "follow_state.h"
#include "online/alarm_limits.h"
#include "online/arrivals.h"
#include "online/constants.h"
#include "online/watched_model.h"
#include "online/watcher.h"
#include "report/shared/json.h"
#include "report/watch/watch_events.h"
#include "servodx/baseline.h"
#include "servodx/diagnose.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/table.h"
#include "signals/growing_log.h"
#include "signals/sample.h"
#include "window_diagnoses.h"

namespace servodx {
namespace {

constexpr double state_every = 1.0;           // [s] of the wall's clock
constexpr double longest_wait = 0.05;         // [s] a signal is answered within it
constexpr double mark_every = 0.25;           // [s] of the log, between places that the window may be read again from
constexpr std::size_t most_in_result = 1000;  // events in the result file: memory does not grow
constexpr double end_of_time = 1e300, nothing_remembered = -end_of_time;  // [s] after and before any sample

double wall_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// The logs that the limits rest on: those named, or the baseline's where they are as they were.
std::vector<Log> healthy_logs(const FollowOptions& options, const Judging& judging, Invocation& invocation) {
  if (!options.healthy.empty()) return invocation.logs(options.healthy, judging.rig);
  std::vector<Log> out;
  std::size_t gone = 0;
  const auto& scores = judging.baseline.scores;
  for (const Baseline::Score& score : scores) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(score.log, ignored) && sha256_of_file(score.log) == score.sha256)
      out.push_back(invocation.log(score.log, judging.rig));
    else
      ++gone;
  }
  if (gone > 0)
    invocation.note(
        {fmt::format("{} of the baseline's {} logs are not where they were: the limits rest on the others; "
                     "name healthy logs with --healthy",
                     gone, scores.size())});
  return out;
}

WindowDiagnoses::Judge judge_by(const Judging& judging, const CommonOptions& common, const std::atomic<bool>& stop) {
  return [&judging, &common, &stop](const Log& window) -> std::optional<Verdict> {
    DiagnoseOptions how{.seed = common.seed, .threads = common.threads};
    how.watch.stop = [&stop] { return stop.load(); };
    Verdict verdict = diagnose_window(window, judging.tuned, judging.rig, judging.baseline, how);
    if (verdict.interrupted) return {};
    return verdict;
  };
}

// Where events go: the result, standard output, and a file that begins with the first sample.
class EventOutput {
 public:
  EventOutput(const std::string& file, bool prints) : file_(file), prints_(prints) {}

  void open() {
    if (stream_.is_open() || file_.empty() || is_standard_stream(file_)) return;
    stream_.open(file_, std::ios::app);
    if (!stream_) throw InputError({.file = file_}, "cannot be written", "name a file in a folder that is there");
  }
  void tell(const report::Json& event, const std::string& text) {
    if (events_.size() < most_in_result)
      events_.push_back(event);
    else
      ++left_out_;
    if (stream_.is_open()) stream_ << event.dump() << std::endl;
    if (!prints_) return;
    std::printf("%s\n", is_standard_stream(file_) ? event.dump().c_str() : text.c_str());
    std::fflush(stdout);
  }
  const report::Json& events() const { return events_; }
  long left_out() const { return left_out_; }

 private:
  const std::string& file_;
  bool prints_;
  std::ofstream stream_;
  report::Json events_ = report::Json::array();
  long left_out_ = 0;
};

// From which byte a log is read again to have a time in it.
class ReadMarks {
 public:
  void begin(double time, std::uint64_t byte) {
    if (marks_.empty()) marks_.push_back({time, byte});
  }
  void pass(double time, std::uint64_t byte) {
    if (time >= marks_.back().first + mark_every) marks_.push_back({time, byte});
  }
  void forget_before(double time) {
    while (marks_.size() > 1 && marks_[1].first < time) marks_.pop_front();
  }
  void clear() { marks_.clear(); }
  std::uint64_t first_or(std::uint64_t otherwise) const { return marks_.empty() ? otherwise : marks_.front().second; }

 private:
  std::deque<std::pair<double, std::uint64_t>> marks_;  // time, and the bytes up to its sample
};

class Following {
 public:
  Following(const FollowOptions& options, const CommonOptions& common, const Judging& judging, WatchLimits limits,
            bool prints)
      : options_(options),
        judging_(judging),
        model_(watched_model(judging.tuned.table, judging.rig)),
        limits_(std::move(limits)),
        by_{options.source, content_hash(judging.tuned.table), judging.tuned.table.sha256, judging.baseline.sha256},
        progress_("watch", {.quiet = common.quiet}),
        log_(options.source, judging.rig),
        diagnoses_(judge_by(judging, common, stop_)),
        events_(options.events, prints) {}

  void go() {
    std::uint64_t from = read_state();
    ByteTail tail(options_.source, from);
    if (tail.position() != from) forget();  // a shorter file is another
    double heard = wall_now(), saved = heard;
    while (!stop_) {
      const ByteTail::Read read = tail.next(longest_wait);
      if (read.began_anew) begin_anew();
      if (!read.bytes.empty()) {
        log_.feed(read.bytes, [this](const Sample& s, std::uint64_t end) { take(s, end); });
        heard = wall_now();  // after the work: what waits in the file meanwhile is no idleness
      }
      while (const auto done = diagnoses_.next_if_ready()) tell(*done);
      show();
      if (wall_now() - saved >= state_every) write_state(), saved = wall_now();
      if (read.ended || (options_.until_idle > 0 && read.bytes.empty() && wall_now() - heard >= options_.until_idle))
        break;
    }
    finish();
  }

  long alarms() const { return alarms_; }
  bool was_stopped() const { return stop_; }
  Verdict::Kind worst() const { return worst_; }
  report::WatchSummary summary() const {
    return {options_.source, seconds_, alarms_, watcher_ ? watcher_->counts() : ArrivalCounts{}, log_.bad_lines()};
  }
  report::Json result() const {
    report::Json out = report::to_json(summary());
    out["limits"] = report::to_json(limits_);
    out["events"] = events_.events();
    out["events_left_out"] = events_.left_out();
    return out;
  }

 private:
  void take(const Sample& sample, std::uint64_t end) {
    if (!watcher_) make_watcher();
    if (sample.time <= remembered_until_) {
      watcher_->remember(sample);
      return make_due_until(sample.time);
    }
    make_due_until(sample.time);
    remembered_until_ = nothing_remembered;
    first_time_ = std::min(first_time_, sample.time);
    marks_.begin(sample.time, end);
    const double before = watcher_->time();
    new_events_.clear();
    watcher_->take(sample, new_events_);
    if (watcher_->time() > before) {
      judged_end_ = end;
      seconds_ = watcher_->time() - first_time_;
      marks_.pass(watcher_->time(), end);
      double needed = watcher_->window_begins();
      for (const DueWindow& due : diagnoses_.due()) needed = std::min(needed, due.begins);
      marks_.forget_before(needed);
    }
    for (const WatchEvent& e : new_events_) tell(e);
  }

  // The windows of a saved state that end by `time`: their samples have come again.
  void make_due_until(double time) {
    while (!resumed_due_.empty() && resumed_due_.front().at <= time) {
      const DueWindow due = resumed_due_.front();
      resumed_due_.pop_front();
      const std::vector<Sample> window = watcher_->window();
      if (!window.empty() && window.front().time <= due.begins + online_constants::part && window.back().time >= due.at)
        add_diagnosis(due, window);
      else
        tell({due, {}, "the samples of its window are gone"});
    }
  }

  void add_diagnosis(const DueWindow& due, const std::vector<Sample>& window) {
    diagnoses_.add(due, log_of(fmt::format("{}@{:.3f}", options_.source, due.at), window));
  }

  void make_watcher() {
    events_.open();
    std::vector<Signal> recorded;
    for (int i = 0; i < n_signals; ++i)
      if (const auto s = static_cast<Signal>(i); s != Signal::time && log_.has(s)) recorded.push_back(s);
    watcher_ = std::make_unique<Watcher>(model_, limits_, recorded);
    if (!resumed_.is_null()) watcher_->resume(std::exchange(resumed_, nlohmann::json()));
  }

  void begin_anew() {
    progress_.say("watch: " + options_.source + " began anew");
    forget();
  }
  // Another log stands under this name. What was told of the first one stays told.
  void forget() {
    watcher_.reset();
    diagnoses_.drop_waiting();
    resumed_ = nlohmann::json();
    resumed_due_.clear();
    marks_.clear();
    remembered_until_ = nothing_remembered, first_time_ = end_of_time;
    judged_end_ = 0, seconds_ = 0;
    log_ = GrowingLog(options_.source, judging_.rig);
  }

  void tell(const WatchEvent& e) {
    alarms_ += e.kind == WatchEventKind::alarm;
    if (e.kind == WatchEventKind::alarm && worst_ != Verdict::Kind::fault)
      worst_ = e.name.empty() ? Verdict::Kind::unknown : Verdict::Kind::fault;
    if (e.kind == WatchEventKind::window) {
      add_diagnosis({e.number, watcher_->window_begins(), e.time}, watcher_->window());
      return;
    }
    events_.tell(report::to_json(e), report::text_of(e));
  }

  void tell(const WindowDiagnoses::Done& done) {
    if (!done.verdict && done.refused.empty()) {  // stopped: a later call makes it
      resumed_due_.push_back(done.due);
      return;
    }
    if (done.verdict && done.verdict->kind == Verdict::Kind::fault) worst_ = Verdict::Kind::fault;
    const report::WindowDiagnosis diagnosis{done.due.of, done.verdict ? done.verdict->whole.get() : nullptr,
                                            done.refused};
    events_.tell(report::to_json(diagnosis), report::text_of(diagnosis));
  }

  void show() {
    progress_.show([this](double) { return fmt::format("watch: {:.1f} s of log, {} alarms", seconds_, alarms_); });
  }

  void finish() {
    if (!stop_) {
      log_.end([this](const Sample& s, std::uint64_t end) { take(s, end); });
      if (!watcher_ && is_standard_stream(options_.source))
        throw InputError({.file = "standard input"}, log_.begun() ? "has no rows" : "has no header row",
                         "send a log: a header of names and units, then its rows");
      if (watcher_) {
        make_due_until(end_of_time);
        new_events_.clear();
        // The state is that of whole parts: what is added to the log later goes on from there.
        const nlohmann::json whole_parts = options_.state.empty() ? nlohmann::json() : watcher_->state();
        write_state(whole_parts);
        watcher_->flush(new_events_);
        for (const WatchEvent& e : new_events_) tell(e);
        while (const auto done = diagnoses_.wait_for_next()) {
          tell(*done);
          if (stop_) break;
        }
        write_state(whole_parts);
      }
    } else if (watcher_) {
      write_state();
    }
  }

  void write_state() {
    if (watcher_ && !options_.state.empty()) write_state(watcher_->state());
  }
  void write_state(const nlohmann::json& watcher) {
    if (options_.state.empty()) return;
    FollowState state{.head = log_.head(),
                      .judged_until = judged_end_,
                      .window_from = marks_.first_or(judged_end_),
                      .first_time = first_time_,
                      .alarms = alarms_,
                      .due = {},
                      .watcher = watcher};
    const auto add = [&](const DueWindow& due) {
      if (due.at <= watcher.at("last")) state.due.push_back(due);
    };
    for (const DueWindow& due : resumed_due_) add(due);
    for (const DueWindow& due : diagnoses_.due()) add(due);
    write_follow_state(options_.state, by_, state);
  }

  // Than what was judged of it: another log of its name.
  bool is_shorter_than(std::uint64_t judged) {
    std::error_code absent;
    const auto size = std::filesystem::file_size(options_.source, absent);
    if (is_standard_stream(options_.source) || absent || size >= judged) return false;
    progress_.say("watch: " + options_.source + " is shorter than what was judged of it: it is watched as another log");
    return true;
  }

  // Where to read on from.
  std::uint64_t read_state() {
    const auto state = options_.state.empty() ? std::nullopt : read_follow_state(options_.state, by_);
    if (!state || is_shorter_than(state->judged_until)) return 0;
    resumed_ = state->watcher;
    remembered_until_ = resumed_.at("last");
    first_time_ = state->first_time, alarms_ = state->alarms, judged_end_ = state->judged_until;
    seconds_ = remembered_until_ - first_time_;
    resumed_due_.assign(state->due.begin(), state->due.end());
    if (is_standard_stream(options_.source)) {  // what was read once does not come again
      remembered_until_ = nothing_remembered;
      return 0;
    }
    log_.begin_with(state->head, state->window_from);
    marks_.begin(nothing_remembered, state->window_from);
    return state->window_from;
  }

  const FollowOptions& options_;
  const Judging& judging_;
  const WatchedModel model_;
  const WatchLimits limits_;
  const FollowedBy by_;
  Progress progress_;
  const std::atomic<bool>& stop_ = stop_on_interrupt(true);
  GrowingLog log_;
  WindowDiagnoses diagnoses_;
  std::unique_ptr<Watcher> watcher_;
  std::vector<WatchEvent> new_events_;
  EventOutput events_;
  nlohmann::json resumed_;
  std::deque<DueWindow> resumed_due_;
  double remembered_until_ = nothing_remembered, first_time_ = end_of_time, seconds_ = 0;  // [s]
  std::uint64_t judged_end_ = 0;                                                           // bytes
  ReadMarks marks_;
  long alarms_ = 0;
  Verdict::Kind worst_ = Verdict::Kind::healthy;
};

}  // namespace

int follow(const FollowOptions& options, const CommonOptions& common) {
  require_option(std::isfinite(options.alarms_per_hour) && options.alarms_per_hour > 0, "--alarms-per-hour",
                 "must be above 0", "--alarms-per-hour 0.1");
  require_option(std::isfinite(options.until_idle) && options.until_idle >= 0, "--until-idle",
                 "must be seconds, 0 or more", "--until-idle 10");
  Invocation invocation("watch", common);
  std::vector<std::string> inputs = {options.params, options.baseline}, outputs;
  if (!is_standard_stream(options.source)) inputs.push_back(options.source);
  if (!options.state.empty()) outputs.push_back(options.state);
  if (!options.events.empty() && !is_standard_stream(options.events)) outputs.push_back(options.events);
  invocation.check_files(inputs, outputs);
  const Judging judging = read_judging(invocation, {options.params, options.baseline});
  report::Header& header = invocation.header();
  header.settings->update({{"source", options.source},
                           {"alarms_per_hour", options.alarms_per_hour},
                           {"until_idle", options.until_idle},
                           {"state", options.state}});
  if (invocation.dry_run()) return ran;
  const WatchLimits limits = learn_limits(healthy_logs(options, judging, invocation),
                                          watched_model(judging.tuned.table, judging.rig), options.alarms_per_hour);
  Following following(options, common, judging, limits, invocation.prints_text());
  following.go();
  invocation.finish(is_standard_stream(options.events) ? "" : report::text_of(following.summary()), following.result());
  if (following.was_stopped()) return interrupted;
  if (!options.exit_code) return ran;
  return following.worst() == Verdict::Kind::fault     ? found_fault
         : following.worst() == Verdict::Kind::unknown ? found_unknown
                                                       : ran;
}

}  // namespace servodx
