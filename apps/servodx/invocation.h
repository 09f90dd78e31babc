// One call of the program: the options every command has, the files it read, and how it ends.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/certificate.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "servodx/watch.h"

namespace CLI {
class App;
}

namespace servodx {

class Checkpoint;

// some_set_aside: of many inputs some were refused, the others done.
enum ExitCode {
  ran = 0,
  failed_inside = 1,
  refused = 2,
  some_set_aside = 3,
  found_fault = 10,
  found_unknown = 11,
  asks_abuse = 12,  // of --exit-by-action
  asks_abnormal = 13,
  asks_critical = 14,
  interrupted = 130,
  terminated = 143  // by SIGTERM, where no list says 130
};

struct CommonOptions {
  std::string json;    // result file; "-": standard output, and no text there; empty: none
  std::string report;  // page, HTML; empty: none
  std::string pdf;     // the same page on paper; empty: none
  std::string rig;     // rig.toml; empty: none
  int threads = 0;     // 0: all
  std::uint64_t seed = 1;
  bool quiet = false;
  bool dry_run = false;
};
// left_out: of a command that writes the rig file, or has a definition in its place.
enum class RigOption { taken, left_out };
void add_common_options(CLI::App& command, CommonOptions& options, RigOption rig = RigOption::taken);

// Of commands that take long: how they may end early and be gone on with.
struct RunOptions {
  std::string checkpoint;  // empty: none
  bool resume = false;
  std::string time_limit;  // "90 s"; empty: none
};
void add_run_options(CLI::App& command, RunOptions& options);
void add_certificate_option(CLI::App& command, std::string& file);

// Throws InputError naming the option, unless `holds`.
void require_option(bool holds, const std::string& option, const std::string& rule, const std::string& mend);

// The call as typed, for the manifest.
void remember_call(int argc, char** argv);

// Set by the first SIGINT from now on, and by SIGTERM where asked; a second one ends the program at once. A limit of
// time sets it too.
const std::atomic<bool>& stop_on_interrupt(bool or_on_termination = false);
// What the program ends with: of a call that was interrupted, by which signal.
int as_ended(int exit_code);

class Invocation {
 public:
  // From here on the limit of time counts.
  Invocation(std::string command, CommonOptions options, RunOptions run = {});

  // Before any work: refuses outputs whose folder is missing or closed, that are a folder, an input, or the same file
  // twice. The --json and --report files are among the outputs.
  void check_files(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

  // Between reading and working, the settings being set: true where the call is a rehearsal. It then has printed the
  // effective settings, and the command ends without computing or writing.
  bool dry_run() const;

  // Readers that note what they read among the result's inputs.
  RigFile rig();
  Log log(const std::string& path, const RigFile& rig, const ReadOptions& options = {});
  std::vector<Log> logs(const std::vector<std::string>& paths, const RigFile& rig);  // refuses the same log twice
  // Where fits of so many samples take long: how long, and what makes it shorter; to standard error.
  void tell_of_long_fits(const std::vector<Log>& logs) const;
  // The sheet beside the result, into the page's head too; nothing where no file is named.
  std::optional<Certificate> certificate(const std::string& path);
  std::string manifest() const;          // where it will stand; empty where no file is written
  Table table(const std::string& path);  // as the file says
  Tuned tuned(const std::string& path);  // refuses one that is not tuned

  // Progress on standard error, unless quiet, the first SIGINT or SIGTERM or the limit of time as a wish to end,
  // and the checkpoint, which is opened at the first call. The line goes at the next kind of work and at finish().
  Watch watch();
  // For the end of a result that was cut short.
  void note_how_to_go_on();

  // Notes for the end of the result; one that is there already is not repeated.
  void note(const std::vector<std::string>& notices);
  void note(const std::vector<Note>& notes) { note(texts_of(notes)); }
  report::Header& header() { return header_; }
  const report::Header& header() const { return header_; }
  const CommonOptions& options() const { return options_; }

  // Header and body as a result file's bytes; the time so far is filled in.
  std::string result(const report::Json& body);
  bool prints_text() const;  // standard output is not for the JSON
  bool wants_report() const { return !options_.report.empty() || !options_.pdf.empty(); }
  void write_report(report::Page page);  // without it, `finish` writes a plain one
  // The result to --json and the text to standard output, each where it is asked for; then the notes. Beside the first
  // file that the call wrote goes its manifest, FILE.manifest.json: all that `rerun` needs.
  void finish(const std::string& text, const report::Json& body);
  // Where there is no result to write: the text and the notes alone.
  void finish_without_result(const std::string& text);

 private:
  struct Shown;
  CommonOptions options_;
  RunOptions run_;
  std::shared_ptr<Checkpoint> checkpoint_;
  void write_manifest() const;
  void end_progress();
  void print_with_notes(std::string text) const;
  report::Header header_;
  bool reported_ = false;
  std::shared_ptr<Shown> shown_;
  std::vector<std::string> outputs_;  // checked; the command's own first
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// A file that comes with the program ("params/..."): the path itself where it is there, else where it was installed.
std::string shipped_path(const std::string& path);

bool colour_wanted();  // standard output is a terminal and NO_COLOR is not set

}  // namespace servodx
