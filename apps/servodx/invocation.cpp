#include "invocation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/time.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/units.h"
#include "build.h"
#include "manifest.h"
#include "print_page.h"
#include "report/shared/certificate_part.h"
#include "report/shared/columns.h"
#include "report/shared/going_on.h"
#include "report/shared/handy.h"
#include "report/shared/page_head.h"
#include "report/shared/plain_page.h"
#include "servodx/checkpoint.h"
#include "servodx/instruction_set.h"
#include "servodx/pages.h"
#include "servodx/rig.h"

namespace servodx {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> call;
std::atomic<bool> stop{false}, out_of_time{false}, told_to_end{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may store it");

void on_interrupt(int signal) {
  stop.store(true);
  std::signal(signal, SIG_DFL);
}

void on_termination(int signal) {
  told_to_end.store(true);
  on_interrupt(signal);
}

void on_time_limit(int) {
  out_of_time.store(true);
  stop.store(true);
}

// [s]
double duration_of(const std::string& text) {
  constexpr std::pair<std::string_view, double> units[] = {{"ms", 1e-3}, {"s", 1}, {"min", 60}, {"h", 3600}};
  const std::size_t space = text.find(' ');
  const std::string_view number = std::string_view(text).substr(0, space);
  const std::string_view unit = space == std::string::npos ? "" : std::string_view(text).substr(space + 1);
  constexpr double longest = 1e8;  // [s] three years: no timer is wrapped
  for (const auto& [name, seconds] : units)
    if (const auto value = parse_number(number); unit == name && value && *value > 0 && *value * seconds <= longest)
      return *value * seconds;
  throw InputError({"--time-limit", 0, ""}, "'" + text + "' is no duration",
                   "give one such as '90 s', '10 min' or '2 h'");
}

void stop_after(double seconds) {
  std::signal(SIGALRM, on_time_limit);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - std::floor(seconds)) * 1e6);
  if (timer.it_value.tv_sec == 0 && timer.it_value.tv_usec == 0) timer.it_value.tv_usec = 1;  // zero: never
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

// CLI11 would wrap a negative seed round.
CLI::Validator whole_number() {
  const auto check = [](const std::string& text) -> std::string {
    const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    return digits ? "" : "'" + text + "' is not a whole number from 0 up";
  };
  return {check, "", "whole number"};
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw std::runtime_error("standard output cannot be written");
}

void check_output(const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code ignored;
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    throw InputError({path, 0, ""}, "cannot be written: there is no folder '" + folder.string() + "'",
                     "make the folder or name another");
  if (fs::is_directory(path, ignored))
    throw InputError({path, 0, ""}, "cannot be written: it is a folder", "name a file");
  if (!fs::exists(path, ignored)) {
    if (::access(folder.c_str(), W_OK) != 0)
      throw InputError({path, 0, ""}, "cannot be written: the folder may not be written", "name another folder");
    return;
  }
  if (::access(path.c_str(), W_OK) != 0)
    throw InputError({path, 0, ""}, "cannot be written: the file is write-protected", "name another file");
  for (const std::string& input : inputs)
    if (fs::is_regular_file(path, ignored) && fs::equivalent(path, input, ignored))
      throw InputError({path, 0, ""}, "is an input of this call and would be overwritten", "name another output");
}

fs::path resolved(const std::string& path) {
  std::error_code ignored;
  return fs::weakly_canonical(fs::absolute(end_of_links(path)), ignored);
}

bool is_special(const std::string& path) {  // /dev/null, a pipe
  std::error_code ignored;
  return fs::exists(path, ignored) && !fs::is_regular_file(path, ignored);
}

// The manifest stands beside the first output that is a file, under a name that is nobody else's.
void check_manifest(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  const auto first = std::find_if_not(outputs.begin(), outputs.end(), is_special);
  if (first == outputs.end()) return;
  const std::string manifest = *first + manifest_suffix;
  check_output(manifest, inputs);
  for (const std::string& output : outputs)
    if (resolved(output) == resolved(manifest))
      throw InputError({output, 0, ""}, "is the name of the manifest of " + *first, "name another output");
}

}  // namespace

void add_common_options(CLI::App& command, CommonOptions& options, RigOption rig) {
  command.add_option("--json", options.json, "write the result as JSON to FILE; '-': to standard output, without text")
      ->type_name("FILE")
      ->group("Common");
  command
      .add_option("--report", options.report, "write a page that shows the result and why it holds: one file, offline")
      ->type_name("FILE.html")
      ->group("Common");
  command.add_option("--pdf", options.pdf, "the same page on paper, printed by the Chromium of this machine")
      ->type_name("FILE.pdf")
      ->group("Common");
  if (rig == RigOption::taken)
    command.add_option("--rig", options.rig, "rig file: data-sheet facts and names of columns")
        ->type_name("RIG.toml")
        ->group("Common");
  command.add_option("--threads", options.threads, "threads to use, 0: all; the result does not depend on it")
      ->check(whole_number())
      ->type_name("N")
      ->group("Common")
      ->capture_default_str();
  command.add_option("--seed", options.seed, "of everything random")
      ->check(whole_number())
      ->type_name("S")
      ->group("Common")
      ->capture_default_str();
  command
      .add_flag("--dry-run", options.dry_run, "read and check everything, print the effective settings, and end there")
      ->group("Common");
  command.add_flag("--quiet", options.quiet, "no progress and no notices")->group("Common");
}

void add_run_options(CLI::App& command, RunOptions& options) {
  command
      .add_option("--checkpoint", options.checkpoint,
                  "keep what is finished in FILE, so that a call that is broken off can be gone on with")
      ->type_name("FILE")
      ->group("Common");
  command.add_flag("--resume", options.resume, "go on from the checkpoint, to the same bits as an unbroken call")
      ->group("Common");
  command
      .add_option("--time-limit", options.time_limit,
                  "end after so long with the best so far and exit code 130: '90 s', '10 min', '2 h'")
      ->type_name("DURATION")
      ->group("Common");
}

void add_certificate_option(CLI::App& command, std::string& file) {
  command
      .add_option("--certificate", file,
                  "sheet of a test certificate: customer, instruments, guard band; needs --report")
      ->type_name("SHEET.toml");
}

void require_option(bool holds, const std::string& option, const std::string& rule, const std::string& mend) {
  if (!holds) throw InputError({option, 0, ""}, rule, mend);
}

void remember_call(int argc, char** argv) { call.assign(argv + 1, argv + argc); }

const std::atomic<bool>& stop_on_interrupt(bool or_on_termination) {
  std::signal(SIGINT, on_interrupt);
  if (or_on_termination) std::signal(SIGTERM, on_interrupt);
  return stop;
}

int as_ended(int exit_code) { return exit_code == interrupted && told_to_end ? terminated : exit_code; }

std::string shipped_path(const std::string& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) return path;
  const fs::path installed =
      fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path() / "share/servodx" / path;
  return fs::exists(installed, ignored) ? installed.string() : path;
}

bool colour_wanted() { return ::isatty(STDOUT_FILENO) == 1 && !std::getenv("NO_COLOR"); }

Invocation::Invocation(std::string command, CommonOptions options, RunOptions run)
    : options_(std::move(options)), run_(std::move(run)) {
  require_option(!run_.resume || !run_.checkpoint.empty(), "--resume", "there is nothing to resume from",
                 "add --checkpoint FILE");
  require_option(!run_.resume || fs::exists(run_.checkpoint), "--checkpoint",
                 "'" + run_.checkpoint + "' is not there to resume from", "leave out --resume to begin");
  if (!run_.time_limit.empty()) stop_after(duration_of(run_.time_limit));
  header_.version = SERVODX_VERSION;
  header_.command = std::move(command);
  header_.seed = options_.seed;
  header_.call.rig = options_.rig;
}

void Invocation::check_files(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  std::vector<std::string> all_inputs = inputs;
  if (!options_.rig.empty()) all_inputs.push_back(options_.rig);
  std::vector<std::string> all_outputs = outputs;
  if (!options_.json.empty() && options_.json != "-") all_outputs.push_back(options_.json);
  if (!options_.report.empty()) all_outputs.push_back(options_.report);
  require_option(!options_.report.ends_with(".pdf"), "--report", "writes HTML, whatever its name",
                 "name a .html; --pdf FILE prints the page");
  if (!options_.pdf.empty()) all_outputs.push_back(options_.pdf), require_browser();
  std::vector<fs::path> seen;
  for (const std::string& output : all_outputs) {
    require_option(!output.empty(), "--output", "the name is empty", "name a file");
    check_output(output, all_inputs);
    const fs::path place = resolved(output);
    if (!is_special(output) && std::find(seen.begin(), seen.end(), place) != seen.end())
      throw InputError({output, 0, ""}, "is named for two outputs", "give each output its own file");
    seen.push_back(place);
  }
  // A browser draws no page twice to the byte: what it printed is no output that a manifest could promise. No more is a
  // checkpoint, whose stages stand in the order they were finished in.
  if (!options_.pdf.empty()) all_outputs.pop_back();
  if (!run_.checkpoint.empty()) {
    check_output(run_.checkpoint, all_inputs);
    for (const std::string& output : all_outputs)
      if (resolved(output) == resolved(run_.checkpoint))
        throw InputError({output, 0, ""}, "is named for two outputs", "give each output its own file");
  }
  std::vector<std::string> all_files = all_outputs;
  if (!run_.checkpoint.empty()) all_files.push_back(run_.checkpoint);
  check_manifest(all_inputs, all_files);
  outputs_ = std::move(all_outputs);
}

void Invocation::tell_of_long_fits(const std::vector<Log>& logs) const {
  constexpr double least = 0.8e-3, most = 4e-3;  // [s] of a core for a sample, docs/performance.md
  constexpr double long_fit = 600;               // [s]
  double samples = 0;
  for (const Log& log : logs) samples += static_cast<double>(log.samples());
  if (options_.quiet || most * samples < long_fit) return;
  std::fprintf(stderr,
               "%s: %.0f samples, %s to %s of one core. Fits take every sample: logs at 1 or 2 kHz, or cut to the "
               "seconds that matter, take less; two cores half of it.\n",
               header_.command.c_str(), samples, report::duration(least * samples).c_str(),
               report::duration(most * samples).c_str());
}

bool Invocation::dry_run() const {
  if (!options_.dry_run) return false;
  report::Json settings = {{"seed", header_.seed}, {"threads", options_.threads}};
  settings.update(*header_.settings);
  if (options_.json == "-") {
    print(report::Json{{"command", header_.command},
                       {"dry_run", true},
                       {"settings", settings},
                       {"inputs", report::to_json(header_)["inputs"]},
                       {"outputs", outputs_}}
              .dump(2) +
          "\n");
    return true;
  }
  report::Columns table("ll", 2);
  for (const auto& [key, value] : settings.items())
    table.row({key, key == "threads" && value == 0 ? "all"
                    : value.is_string()            ? value.get<std::string>()
                                                   : value.dump()});
  for (const report::InputFile& file : header_.inputs)
    table.row({"input", file.path + "  " + file.sha256.substr(0, 12)});
  for (const std::string& output : outputs_) table.row({"output", output});
  print(header_.command + ", dry run: everything was read and checked, nothing is computed or written\n" +
        table.text());
  return true;
}

RigFile Invocation::rig() {
  if (options_.rig.empty()) return {};
  RigFile rig = read_rig_file(options_.rig);
  header_.head = report::head_of(rig, logo_of(rig));
  header_.inputs.push_back({rig.path, rig.sha256});
  if (const std::size_t open = rig.open_questions.size())
    note({fmt::format(
        "{}: {} question{} of 'servodx init' {} open, line{} {}: until it is answered a column is no signal", rig.path,
        open, open == 1 ? "" : "s", open == 1 ? "is" : "are", open == 1 ? "" : "s",
        fmt::join(rig.open_questions, ", "))});
  return rig;
}

Log Invocation::log(const std::string& path, const RigFile& rig, const ReadOptions& options) {
  Log log = read_log(path, rig, options);
  header_.inputs.push_back({log.path, log.sha256});
  return log;
}

std::optional<Certificate> Invocation::certificate(const std::string& path) {
  if (path.empty()) return {};
  require_option(!options_.report.empty(), "--certificate", "there is no page to put it on", "add --report FILE.html");
  Certificate sheet = read_certificate(path);
  header_.inputs.push_back({sheet.path, sheet.sha256});
  report::add_to_head(header_.head, sheet);
  note(sheet.overdue());
  return sheet;
}

std::string Invocation::manifest() const {
  const auto first = std::find_if_not(outputs_.begin(), outputs_.end(), is_special);
  return first == outputs_.end() ? "" : *first + manifest_suffix;
}

std::vector<Log> Invocation::logs(const std::vector<std::string>& paths, const RigFile& rig) {
  std::vector<Log> all;
  for (const std::string& path : paths) {
    all.push_back(log(path, rig));
    for (std::size_t i = 0; i + 1 < all.size(); ++i)
      if (all[i].sha256 == all.back().sha256)
        throw InputError({path, 0, ""}, "is the same log as " + all[i].path, "name each log once");
  }
  return all;
}

Table Invocation::table(const std::string& path) {
  Table table = read_table(path);
  header_.inputs.push_back({table.path, table.sha256});
  return table;
}

Tuned Invocation::tuned(const std::string& path) {
  Tuned tuned = read_tuned(path);
  header_.inputs.push_back({tuned.table.path, tuned.table.sha256});
  header_.call.table = path;
  note(tuned.notes);
  return tuned;
}

// The line of the work at hand.
struct Invocation::Shown {
  std::mutex mutex;
  std::string work;
  std::optional<Progress> line;

  void update(const WorkDone& done) {
    // Whoever finds another thread here has nothing to add.
    const std::unique_lock lock(mutex, std::try_to_lock);
    if (!lock) return;
    if (work != done.work) work = done.work, line.reset();
    if (!line) line.emplace(work);
    line->update(done.part, done.simulations);
  }
};

Watch Invocation::watch() {
  Watch watch;
  std::signal(SIGTERM, on_termination);
  watch.stop = [&asked = stop_on_interrupt()] { return asked.load(); };
  if (!run_.checkpoint.empty() && !checkpoint_)
    checkpoint_ = open_checkpoint(run_.checkpoint, run_.resume ? CheckpointUse::go_on : CheckpointUse::begin);
  watch.checkpoint = checkpoint_;
  if (options_.quiet) return watch;
  if (!shown_) shown_ = std::make_shared<Shown>();
  watch.progress = [shown = shown_](const WorkDone& done) { shown->update(done); };
  return watch;
}

void Invocation::note_how_to_go_on() {
  note({report::how_to_go_on(out_of_time ? run_.time_limit : "", run_.checkpoint)});
}

void Invocation::note(const std::vector<std::string>& notices) {
  for (const std::string& notice : notices)
    if (std::find(header_.notes.begin(), header_.notes.end(), notice) == header_.notes.end())
      header_.notes.push_back(notice);
}

std::string Invocation::result(const report::Json& body) {
  header_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  return report::dump(header_, body);
}

bool Invocation::prints_text() const { return options_.json != "-"; }

void Invocation::write_report(report::Page page) {
  const std::string html = page.html();
  if (!options_.report.empty()) write_file(options_.report, html);
  if (!options_.pdf.empty()) print_page(html, options_.pdf);
  reported_ = true;
}

void Invocation::write_manifest() const {
  std::error_code ignored;
  std::vector<std::string> files;
  for (const std::string& output : outputs_)
    if (fs::is_regular_file(output, ignored)) files.push_back(output);
  if (files.empty()) return;
  const std::string path = files.front() + manifest_suffix;
  const fs::path beside = fs::absolute(path).parent_path();
  report::Json outputs = report::Json::array();
  for (const std::string& file : files) outputs.push_back({{"path", file}, {"sha256", fingerprint(read_file(file))}});
  const report::Json header = report::to_json(header_);
  const report::Json manifest = {{"manifest", 1},
                                 {"tool", "servodx"},
                                 {"version", header_.version},
                                 {"commit", build_commit},
                                 {"instruction_set", instruction_set()},
                                 {"command", header_.command},
                                 {"directory", fs::proximate(fs::current_path(), beside, ignored).string()},
                                 {"arguments", call},
                                 {"seed", header_.seed},
                                 {"threads", options_.threads},
                                 {"settings", *header_.settings},
                                 {"interrupted", stop.load()},
                                 {"inputs", header["inputs"]},
                                 {"outputs", outputs}};
  write_file(path, manifest.dump(2, ' ', false, report::Json::error_handler_t::replace) + "\n");
}

void Invocation::end_progress() {
  if (shown_) shown_->line.reset();
  if (checkpoint_ && !options_.quiet)
    std::fputs(report::words_of(report_of(*checkpoint_), run_.checkpoint, run_.resume).c_str(), stderr);
}

void Invocation::print_with_notes(std::string text) const {
  if (!options_.quiet)
    for (const std::string& note : header_.notes) text += "note: " + note + "\n";
  print(text);
}

void Invocation::finish_without_result(const std::string& text) {
  end_progress();
  print_with_notes(text);
}

void Invocation::finish(const std::string& text, const report::Json& body) {
  end_progress();
  if (!options_.json.empty() && options_.json != "-") write_file(options_.json, result(body));
  if (wants_report() && !reported_) {
    report::Json shown = body;
    without_wall_time(shown);
    write_report(report::plain_page(header_, text, shown));
  }
  write_manifest();
  if (options_.json == "-") return print(result(body));
  print_with_notes(text);
}

}  // namespace servodx
