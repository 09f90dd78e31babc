#include "follow.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/atomic_file.h"
#include "base/byte_tail.h"
#include "base/csv.h"
#include "base/json_text.h"
#include "base/progress.h"
#include "base/sha256.h"
#include "base/trouble.h"
#include "faults/gross_finding.h"
#include "fleet_judge.h"
#include "online/alarm_limits.h"
#include "online/arrivals.h"
#include "online/constants.h"
#include "online/watched_model.h"
#include "online/watcher.h"
#include "report/diagnose/diagnosis_json.h"
#include "report/diagnose/diagnosis_text.h"
#include "report/shared/json.h"
#include "report/shared/text_options.h"
#include "servodx/baseline.h"
#include "servodx/diagnose.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/table.h"
#include "signals/growing_log.h"
#include "signals/sample.h"

namespace servodx {
namespace {

constexpr int state_schema = 1;
constexpr double state_every = 1.0;           // [s] of the wall's clock
constexpr double longest_wait = 0.05;         // [s] a signal is answered within it
constexpr double mark_every = 0.25;           // [s] of the log, between places that the window may be read again from
constexpr std::size_t most_pending = 4;       // windows that wait for their diagnosis
constexpr std::size_t most_in_result = 1000;  // events in the result file: memory does not grow

double wall_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string word_of(GrossFinding gross) {
  switch (gross) {
    case GrossFinding::spool_on_both_stops:
      return "spool_on_both_stops";
    case GrossFinding::spool_on_one_stop:
      return "spool_on_one_stop";
    case GrossFinding::no_response:
      return "no_response";
    case GrossFinding::none:
      break;
  }
  return "";
}

report::Json json_of(const WatchEvent& e) {
  report::Json out{{"number", e.number}, {"event", word_of(e.kind)}, {"time", e.time}, {"told_at", e.told_at}};
  if (e.kind == WatchEventKind::cleared || e.kind == WatchEventKind::restart) return out;
  out["onset_time"] = e.onset;
  out["fault"] = e.name.empty() ? report::Json() : report::Json(e.name);
  if (e.signal) {
    out["signal"] = *e.signal == Signal::coil_current ? "driver" : std::string(name_of(*e.signal));
    out["window"] = e.window, out["level"] = e.level, out["limit"] = e.limit;
  }
  if (e.gross != GrossFinding::none) out["seen"] = word_of(e.gross);
  if (e.supply) out["seen"] = "supply_out_of_band";
  return out;
}

std::string text_of(const WatchEvent& e) {
  const std::string name = e.name.empty() ? "no fault of the list" : e.name;
  switch (e.kind) {
    case WatchEventKind::alarm:
      if (e.gross != GrossFinding::none) return fmt::format("{:.3f} s: ALARM, {}: {}", e.time, word_of(e.gross), name);
      if (e.supply)
        return fmt::format("{:.3f} s: ALARM, supply_pressure {:.3g} bar from its healthy level: looks like {}", e.time,
                           e.level * 1e-5, name);
      return fmt::format("{:.3f} s: ALARM, {} {:.3g} times its limit: looks like {}, since {:.3f} s", e.time,
                         e.signal == Signal::coil_current ? "driver" : std::string(name_of(*e.signal)),
                         e.level / e.limit, name, e.onset);
    case WatchEventKind::named:
      return fmt::format("{:.3f} s: now looks like {}", e.time, name);
    case WatchEventKind::cleared:
      return fmt::format("{:.3f} s: as healthy again", e.time);
    case WatchEventKind::restart:
      return fmt::format("{:.3f} s: the simulation begins anew", e.time);
    case WatchEventKind::window:
      break;
  }
  return "";
}

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

// A window that waits for its diagnosis: what a watch that goes on from a state makes it of again.
struct Due {
  long of = 0;                // number of the window's event
  double begins = 0, at = 0;  // [s]
};

// Diagnoses of windows, one at a time, beside the watch.
class Diagnoses {
 public:
  Diagnoses(const Judging& judging, const CommonOptions& common, const std::atomic<bool>& stop)
      : judging_(judging), common_(common), stop_(stop) {}

  struct Done {
    Due due;
    std::optional<Verdict> verdict;
    std::string refused;  // neither: it was stopped
  };
  void add(const Due& due, Log log) {
    if (waiting_.size() >= most_pending) waiting_.pop_front();
    waiting_.push_back({due, std::move(log)});
  }
  std::vector<Due> due() const {
    std::vector<Due> out;
    if (running_.valid()) out.push_back(running_due_);
    for (const Job& job : waiting_) out.push_back(job.due);
    return out;
  }
  // One that is done; `wait`: for as long as it takes.
  std::optional<Done> next(bool wait) {
    if (!running_.valid() && !waiting_.empty()) {
      running_due_ = waiting_.front().due;
      running_ = std::async(std::launch::async, [this, job = std::move(waiting_.front())] { return judge_one(job); });
      waiting_.pop_front();
    }
    if (!running_.valid()) return {};
    if (!wait && running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    return running_.get();
  }

 private:
  struct Job {
    Due due;
    Log log;
  };
  Done judge_one(const Job& job) const {
    Done out{job.due, {}, ""};
    try {
      DiagnoseOptions how{.seed = common_.seed, .threads = common_.threads};
      how.watch.stop = [this] { return stop_.load(); };
      Verdict verdict = diagnose_window(job.log, judging_.tuned, judging_.rig, judging_.baseline, how);
      if (!verdict.interrupted) out.verdict = std::move(verdict);
    } catch (const InputError& error) {
      out.refused = told(error);
    } catch (const std::exception& error) {
      out.refused = error.what();
    }
    return out;
  }

  const Judging& judging_;
  const CommonOptions& common_;
  const std::atomic<bool>& stop_;
  std::deque<Job> waiting_;
  Due running_due_;
  std::future<Done> running_;
};

class Following {
 public:
  Following(const FollowOptions& options, const CommonOptions& common, const Judging& judging, WatchLimits limits,
            Invocation& invocation)
      : options_(options),
        judging_(judging),
        model_(watched_model(judging.tuned.table, judging.rig)),
        limits_(std::move(limits)),
        invocation_(invocation),
        progress_("watch", {.quiet = common.quiet}),
        log_(options.source, judging.rig),
        diagnoses_(judging, common, stop_) {}

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
      for (auto done = diagnoses_.next(false); done; done = diagnoses_.next(false)) tell(*done);
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
  report::Json result() const {
    report::Json out{{"source", options_.source}, {"alarms", alarms_}, {"seconds_of_log", seconds_}};
    const ArrivalCounts counts = watcher_ ? watcher_->counts() : ArrivalCounts{};
    out["samples"] = {
        {"taken", counts.taken}, {"late", counts.late}, {"repeated", counts.repeated}, {"bad_lines", log_.bad_lines()}};
    out["limits"] = to_json(limits_);
    out["events"] = told_;
    out["events_left_out"] = left_out_;
    return out;
  }
  std::string text() const {
    const ArrivalCounts counts = watcher_ ? watcher_->counts() : ArrivalCounts{};
    return fmt::format("watched {:.1f} s of {}: {} alarm{}; {} samples, {} late, {} repeated, {} lines passed over\n",
                       seconds_, options_.source, alarms_, alarms_ == 1 ? "" : "s", counts.taken, counts.late,
                       counts.repeated, log_.bad_lines());
  }

 private:
  void take(const Sample& sample, std::uint64_t end) {
    if (!watcher_) make_watcher();
    if (sample.time <= remembered_until_) {
      watcher_->remember(sample);
      return make_due_until(sample.time);
    }
    make_due_until(sample.time);
    remembered_until_ = -1e300;
    if (first_time_ > sample.time) first_time_ = sample.time;
    if (marks_.empty()) marks_.push_back({sample.time, end});
    const double before = watcher_->time();
    new_events_.clear();
    watcher_->take(sample, new_events_);
    if (watcher_->time() > before) {
      judged_end_ = end;
      seconds_ = watcher_->time() - first_time_;
      if (watcher_->time() >= marks_.back().first + mark_every) marks_.push_back({watcher_->time(), end});
      double needed = watcher_->window_begins();
      for (const Due& due : diagnoses_.due()) needed = std::min(needed, due.begins);
      while (marks_.size() > 1 && marks_[1].first < needed) marks_.pop_front();
    }
    for (const WatchEvent& e : new_events_) tell(e);
  }

  // The windows of a saved state that end by `time`: their samples have come again.
  void make_due_until(double time) {
    while (!resumed_due_.empty() && resumed_due_.front().at <= time) {
      const Due due = resumed_due_.front();
      resumed_due_.pop_front();
      const std::vector<Sample> window = watcher_->window();
      if (!window.empty() && window.front().time <= due.begins + online_constants::part && window.back().time >= due.at)
        add_diagnosis(due, window);
      else
        tell({due, {}, "the samples of its window are gone"});
    }
  }

  void add_diagnosis(const Due& due, const std::vector<Sample>& window) {
    diagnoses_.add(due, log_of(fmt::format("{}@{:.3f}", options_.source, due.at), window));
  }

  void open_events() {
    if (events_file_.is_open() || options_.events.empty() || is_standard_stream(options_.events)) return;
    events_file_.open(options_.events, std::ios::app);
    if (!events_file_)
      throw InputError({.file = options_.events}, "cannot be written", "name a file in a folder that is there");
  }

  void make_watcher() {
    open_events();
    std::vector<Signal> recorded;
    for (int i = 0; i < n_signals; ++i)
      if (const auto s = static_cast<Signal>(i); s != Signal::time && log_.has(s)) recorded.push_back(s);
    watcher_ = std::make_unique<Watcher>(model_, limits_, recorded);
    if (!resumed_.is_null()) watcher_->resume(std::exchange(resumed_, nlohmann::json()));
  }

  void forget() {
    resumed_ = nlohmann::json();
    resumed_due_.clear();
    remembered_until_ = -1e300;
    log_ = GrowingLog(options_.source, judging_.rig);
  }
  void begin_anew() {
    progress_.say("watch: " + options_.source + " began anew");
    watcher_.reset();
    marks_.clear();
    first_time_ = 1e300;
    forget();
  }

  void tell(const WatchEvent& e) {
    alarms_ += e.kind == WatchEventKind::alarm;
    if (e.kind == WatchEventKind::alarm && worst_ != Verdict::Kind::fault)
      worst_ = e.name.empty() ? Verdict::Kind::unknown : Verdict::Kind::fault;
    if (e.kind == WatchEventKind::window) {
      add_diagnosis({e.number, watcher_->window_begins(), e.time}, watcher_->window());
      return;
    }
    write(json_of(e), text_of(e));
  }

  void tell(const Diagnoses::Done& done) {
    report::Json out{{"number", done.due.of}, {"event", "diagnosis"}};
    std::string text;
    if (done.verdict) {
      const Verdict& v = *done.verdict;
      out["result"] = report::to_json(*v.whole);
      const std::string words = report::text_of(*v.whole, {.colour = false, .written_to = ""});
      text = words.substr(0, words.find('\n'));
      if (v.kind == Verdict::Kind::fault) worst_ = Verdict::Kind::fault;
    } else if (!done.refused.empty()) {
      out["refused"] = done.refused;
      text = "no diagnosis: " + done.refused;
    } else {
      resumed_due_.push_back(done.due);
      return;
    }
    write(out, text);
  }

  void write(const report::Json& event, const std::string& text) {
    if (told_.size() < most_in_result)
      told_.push_back(event);
    else
      ++left_out_;
    if (events_file_.is_open()) events_file_ << event.dump() << std::endl;
    if (!invocation_.prints_text()) return;
    std::printf("%s\n", is_standard_stream(options_.events) ? event.dump().c_str() : text.c_str());
    std::fflush(stdout);
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
        make_due_until(1e300);
        new_events_.clear();
        // The state is that of whole parts: what is added to the log later goes on from there.
        const nlohmann::json whole_parts = options_.state.empty() ? nlohmann::json() : watcher_->state();
        write_state(whole_parts);
        watcher_->flush(new_events_);
        for (const WatchEvent& e : new_events_) tell(e);
        for (auto done = diagnoses_.next(true); done; done = diagnoses_.next(true)) {
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
    auto due = nlohmann::json::array();
    const auto add = [&](const Due& d) {
      if (d.at <= watcher.at("last")) due.push_back({d.of, d.begins, d.at});
    };
    for (const Due& d : resumed_due_) add(d);
    for (const Due& d : diagnoses_.due()) add(d);
    nlohmann::ordered_json out{{"schema", state_schema},
                               {"tool", "servodx"},
                               {"version", SERVODX_VERSION},
                               {"source", options_.source},
                               {"table", content_hash(judging_.tuned.table)},
                               {"baseline", judging_.baseline.sha256},
                               {"head", log_.head()},
                               {"judged_until", judged_end_},
                               {"window_from", marks_.empty() ? judged_end_ : marks_.front().second},
                               {"first_time", first_time_},
                               {"alarms", alarms_},
                               {"due", due},
                               {"watcher", watcher}};
    write_file(options_.state, out.dump() + "\n");
  }

  // Where to read on from.
  std::uint64_t read_state() {
    std::error_code ignored;
    if (options_.state.empty() || !std::filesystem::exists(options_.state, ignored)) return 0;
    const auto json = json_or_discarded<nlohmann::json>(read_file(options_.state));
    const auto refuse = [&](const std::string& rule) {
      throw InputError({.file = options_.state}, rule, "remove the file to begin anew, or name another");
    };
    if (!has_schema(json, state_schema)) refuse("is no state of a watch");
    try {
      if (json.at("source") != options_.source) refuse("is the state of a watch of another log");
      const Table& table = judging_.tuned.table;  // earlier versions kept the hash of its file
      const bool same_table = json.at("table") == content_hash(table) || json.at("table") == table.sha256;
      if (!same_table || json.at("baseline") != judging_.baseline.sha256)
        refuse("was saved with another table or baseline");
      resumed_ = json.at("watcher");
      remembered_until_ = resumed_.at("last");
      first_time_ = json.at("first_time"), alarms_ = json.at("alarms"), judged_end_ = json.at("judged_until");
      seconds_ = remembered_until_ - first_time_;
      for (const auto& d : json.value("due", nlohmann::json::array()))
        resumed_due_.push_back({d.at(0), d.at(1), d.at(2)});
      if (is_standard_stream(options_.source)) {
        remembered_until_ = -1e300;
        return 0;
      }
      const std::uint64_t from = json.at("window_from");
      log_.begin_with(json.at("head"), from);
      marks_.push_back({-1e300, from});
      return from;
    } catch (const nlohmann::json::exception&) {
      refuse("is damaged");
    }
    return 0;
  }

  const FollowOptions& options_;
  const Judging& judging_;
  const WatchedModel model_;
  const WatchLimits limits_;
  Invocation& invocation_;
  Progress progress_;
  const std::atomic<bool>& stop_ = stop_on_interrupt(true);
  GrowingLog log_;
  Diagnoses diagnoses_;
  std::unique_ptr<Watcher> watcher_;
  std::vector<WatchEvent> new_events_;
  std::ofstream events_file_;
  report::Json told_ = report::Json::array();
  nlohmann::json resumed_;
  std::deque<Due> resumed_due_;
  double remembered_until_ = -1e300, first_time_ = 1e300, seconds_ = 0;  // [s]
  std::uint64_t judged_end_ = 0;                                         // bytes
  std::deque<std::pair<double, std::uint64_t>> marks_;                   // time, and the bytes up to its sample
  long alarms_ = 0, left_out_ = 0;
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
  const Judging judging = read_judging(invocation, options.params, options.baseline);
  report::Header& header = invocation.header();
  header.settings->update({{"source", options.source},
                           {"alarms_per_hour", options.alarms_per_hour},
                           {"until_idle", options.until_idle},
                           {"state", options.state}});
  if (invocation.dry_run()) return ran;
  const WatchLimits limits = learn_limits(healthy_logs(options, judging, invocation),
                                          watched_model(judging.tuned.table, judging.rig), options.alarms_per_hour);
  Following following(options, common, judging, limits, invocation);
  following.go();
  invocation.finish(is_standard_stream(options.events) ? "" : following.text(), following.result());
  if (following.was_stopped()) return interrupted;
  if (!options.exit_code) return ran;
  return following.worst() == Verdict::Kind::fault     ? found_fault
         : following.worst() == Verdict::Kind::unknown ? found_unknown
                                                       : ran;
}

}  // namespace servodx
