// The front door of `baseline`: both halves of it, what faults gain and what causes score on healthy logs, and its
// file.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/key_error.h"
#include "base/require_setting.h"
#include "base/sha256.h"
#include "base/stages.h"
#include "diagnose/baseline.h"
#include "diagnose/diagnose.h"
#include "explain/healthy.h"
#include "explain/score_healthy.h"
#include "parameters/table_text.h"
#include "report/baseline/baseline_json.h"
#include "report/explain/explain_report.h"
#include "report/shared/json.h"
#include "servodx/baseline.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/trouble.h"
#include "servodx/tune.h"
#include "servodx/watch.h"
#include "signals/fingerprint.h"
#include "signals/rig_content.h"
#include "signals/signal.h"
#include "store/baseline_file.h"
#include "store/baseline_parts.h"
#include "store/healthy_file.h"

namespace servodx {
namespace {

Baseline of_parts(BaselineParts parts) {
  const DetectionBaseline& d = parts.detection;
  Baseline out;
  out.threshold = d.threshold;
  out.asked = d.asked, out.promised = d.promised, out.promised_95 = d.promised_95;
  out.logs = d.logs, out.logs_needed = d.logs_needed;
  for (const DetectionBaseline::Score& s : d.scores) {
    out.scores.push_back({s.log, s.sha256, s.score, s.adequacy, {}, s.content});
    for (const auto& [fault, gain] : s.gains) out.scores.back().gains[std::string(fault->name)] = gain;
  }
  out.tuned_sha256 = d.tuned_sha256;
  out.sha256 = parts.sha256, out.rig_file = parts.rig_file;
  out.parts = std::make_shared<BaselineParts>(std::move(parts));
  return out;
}

// A note that is there already is not repeated.
void add(std::vector<Note>& notes, const Note& note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

// The header of a result file of the program.
report::Header header_of(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig,
                         const BaselineOptions& options) {
  report::Header header;
  header.version = SERVODX_VERSION;
  header.command = "baseline";
  header.seed = options.seed;
  *header.settings = {{"false_alarm", options.false_alarm}};
  if (!rig.path.empty()) header.inputs.push_back({rig.path, rig.sha256});
  header.inputs.push_back({tuned.table.path, tuned.table.sha256});
  for (const Log& log : logs) header.inputs.push_back({log.path, log.sha256});
  for (const Log& log : options.others) header.inputs.push_back({log.path, log.sha256});
  return header;
}

Stages stages_of_causes(const Tuned& tuned, const Rig& rig, const BaselineOptions& options) {
  if (!options.watch.checkpoint) return {};
  return {options.watch, "healthy causes", content_hash(tuned.table), content_bytes(rig)};
}

// Of the whole work, the part of what faults gain; the rest is of what causes score. Each log counts as the simulations
// that it takes, counted on the logs of scripts/demo. Results do not depend on it.
double share_of_gains(std::size_t gains, std::size_t scores) {
  constexpr double gains_a_log = 750, scores_a_log = 1330;
  const double of_gains = gains_a_log * static_cast<double>(gains);
  return of_gains / (of_gains + scores_a_log * static_cast<double>(scores));
}

// That every log holds.
std::vector<std::string> signals_of_all(const std::vector<Log>& logs) {
  std::vector<std::string> out;
  for (const SignalInfo& s : signal_list)
    if (s.signal != Signal::time &&
        std::all_of(logs.begin(), logs.end(), [&](const Log& l) { return l.has(s.signal); }))
      out.emplace_back(s.name);
  return out;
}

bool is_own(const Baseline& baseline, const Log& log) {
  const std::string content = content_hash(log);
  return std::any_of(baseline.scores.begin(), baseline.scores.end(), [&](const Baseline::Score& s) {
    return is_same_log({s.sha256, s.content}, {log.sha256, content});
  });
}

// Keys that either says and the other does not, or says otherwise.
std::vector<std::string> told_apart(const RigStatements& a, const RigStatements& b) {
  std::set<std::string> out;
  for (const auto& [from, to] : {std::pair{&a, &b}, std::pair{&b, &a}})
    for (const auto& [key, value] : *from)
      if (const auto other = to->find(key); other == to->end() || other->second != value) out.insert(key);
  return {out.begin(), out.end()};
}

// Whether the table says what the bytes say that its `sha256` is of: rows can be changed in memory.
bool is_as_read(const Table& table) {
  if (sha256(table_text(table)) == table.sha256) return true;
  std::error_code none;
  if (!std::filesystem::is_regular_file(table.path, none)) return false;
  const std::string text = read_file(table.path);
  return sha256(text) == table.sha256 && content_hash(parse_table(text, table.path)) == content_hash(table);
}

}  // namespace

void BaselineOptions::validate() const {
  require_setting(false_alarm > 0 && false_alarm < 1, "--false-alarm", "is a rate between 0 and 1",
                  "0.01 is one false alarm in a hundred fault-free logs");
  require_threads(threads);
}

void require_baseline_logs(const std::vector<Log>& logs, const Tuned& tuned, const BaselineOptions& options) {
  options.validate();
  require_logs_for_baseline(logs, options.others, tuned.table);
}

Baseline make_baseline(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig,
                       const BaselineOptions& options) {
  options.validate();
  const auto start = std::chrono::steady_clock::now();
  report::Header header = header_of(logs, tuned, rig, options);
  const double gains = share_of_gains(logs.size() + options.others.size(), logs_to_score(logs, options.others));
  Watch of_gains = options.watch;
  if (of_gains.progress)
    of_gains.progress = [&](const WorkDone& w) { options.watch.tell(w.work, gains * w.part, w.simulations); };
  BaselineParts parts;
  parts.detection = make_baseline(logs, tuned.table, rig, options.false_alarm,
                                  {.seed = options.seed, .threads = options.threads, .watch = of_gains},
                                  &header.simulations, &header.failed_simulations, options.others);
  std::vector<Note> notes;
  for (const Note& note : tuned.notes)
    if (!tuned.whole) add(notes, note);  // of its reader; what a tune has noted is not this result's
  for (const Log& log : logs)
    for (const Note& note : log.notes) add(notes, note);
  const std::size_t scored = parts.detection.scores.size();
  if (scored < logs.size())
    add(notes, {Note::Kind::interrupted, fmt::format("interrupted: rests on {} of {} logs", scored, logs.size())});
  header.notes = texts_of(notes);

  HealthyCounts counts{header.simulations, header.failed_simulations};
  parts.causes = score_healthy(
      logs, tuned.table, rig, options.threads, counts,
      [&](double done) {
        options.watch.tell("baseline", gains + (1 - gains) * done, counts.simulations);
        return !options.watch.stopped();
      },
      options.others, stages_of_causes(tuned, rig, options));
  header.simulations = counts.simulations, header.failed_simulations = counts.failed;
  header.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  parts.of = BaselineOf{statements_of(rig), signals_of_all(logs)};
  parts.text = report::dump(header, report::baseline_json(parts));
  parts.sha256 = sha256(parts.text);
  Baseline out = of_parts(std::move(parts));
  out.notes = std::move(notes);
  out.simulations = header.simulations, out.failed_simulations = header.failed_simulations;
  out.interrupted = options.watch.stopped();
  return out;
}

Baseline read_baseline(const std::string& path) {
  BaselineParts parts;
  store::BaselineFile file = store::read_baseline(path);
  parts.detection = std::move(file.baseline);
  parts.sha256 = file.sha256;
  parts.rig_file = file.rig_file;
  parts.of = std::move(file.of);
  parts.text = read_file(path);
  try {
    parts.causes = store::read_healthy(path);
  } catch (const InputError& refused) {
    if (file.has_causes) throw;  // what is there must be right
    parts.causes_refused = refused;
  }
  Baseline out = of_parts(std::move(parts));
  out.path = path;
  out.notes = std::move(file.notes);
  return out;
}

void require_causes(const Baseline& baseline) { causes_of(baseline); }

void write_baseline(const std::string& path, const Baseline& baseline) { write_file(path, parts_of(baseline).text); }

std::vector<Note> notes_beside(const Baseline& baseline, const Rig& rig, const std::vector<Log>& logs) {
  const std::optional<BaselineOf>& of = parts_of(baseline).of;
  std::vector<Note> notes;
  if (!of) return notes;
  if (std::vector<std::string> keys = told_apart(of->rig, statements_of(rig)); !keys.empty() && !rig.path.empty()) {
    constexpr std::size_t most = 6;
    const std::size_t more = keys.size() - std::min(most, keys.size());
    keys.resize(keys.size() - more);
    notes.push_back({Note::Kind::other_rig,
                     fmt::format("{} SAYS OTHER THINGS OF THE RIG THAN THE FILE THAT THE BASELINE WAS MADE WITH: {}{}; "
                                 "what follows is in doubt: give that file, or make table and baseline anew{}",
                                 rig.path, fmt::join(keys, ", "), more ? fmt::format(" and {} more", more) : "",
                                 mark_of(Trouble::other_rig))});
  }
  for (const Log& log : logs) {
    if (is_own(baseline, log))
      notes.push_back({Note::Kind::own_log, log.path + ": is one of the baseline's own logs, and helped to set the "
                                                       "threshold that it is judged by"});
    std::vector<std::string> lacking;
    for (const SignalInfo& s : signal_list)
      if (!log.has(s.signal) && std::find(of->signals.begin(), of->signals.end(), s.name) != of->signals.end())
        lacking.emplace_back(s.name);
    if (!lacking.empty())
      notes.push_back(
          {Note::Kind::lacking_channels,
           fmt::format("{}: lacks {}, which every log of the baseline holds: the verdict sees less, and the "
                       "baseline's rate is not promised for it; map its columns in the rig file",
                       log.path, fmt::join(lacking, ", "))});
  }
  return notes;
}

std::optional<Note> require_same_table(const Baseline& baseline, const Tuned& tuned) {
  parts_of(baseline);
  if (baseline.tuned_sha256 == content_hash(tuned.table)) return {};
  if (baseline.tuned_sha256 == tuned.table.sha256 && is_as_read(tuned.table))
    return Note{
        Note::Kind::earlier_version,
        baseline.path +
            ": a baseline of an earlier version, bound to the bytes of the table's file: a comment added there will "
            "refuse it; make it again with 'servodx baseline'"};
  const InputError other =
      key_error({baseline.path, 0, "tuned_sha256"}, "was made with another table than " + tuned.table.path,
                "give the table it was made with, or make a baseline with this one");
  throw DocumentedError(Trouble::other_table, other.where, other.rule, other.mend);
}

}  // namespace servodx
