// One log of a fleet judged into a folder: `diagnose --list` and `watch` go log by log through it.
//
// The result is what `diagnose LOG --json` writes, whole or absent. A log that is refused leaves its reason instead.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "fleet/fleet_verdict.h"
#include "fleet/gather.h"
#include "fleet/run.h"
#include "invocation.h"
#include "report/shared/json.h"
#include "result_folder.h"
#include "servodx/actions.h"
#include "servodx/baseline.h"
#include "servodx/diagnose.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/tune.h"

namespace servodx {

// What logs are judged with; read once, before any work.
struct Judging {
  RigFile rig;
  Tuned tuned;
  Baseline baseline;
  Actions actions = default_actions();
  bool explain_unknown = true;
  // Of the call's inputs, the last: those that a result names behind its log.
  std::vector<report::InputFile> behind_log = {};
};
struct JudgingFiles {
  std::string params, baseline;
  std::string actions = {};  // empty: the program's
};
// Notes the files among the inputs of the call and what was asked for among its settings, and refuses a baseline of
// another table.
Judging read_judging(Invocation& invocation, const JudgingFiles& files, bool explain_unknown = true);

// The program's where no file is named.
inline Actions actions_of(const std::string& file) { return file.empty() ? default_actions() : read_actions(file); }

class FleetJudge {
 public:
  FleetJudge(const Invocation& invocation, const Judging& judging, const std::string& out);

  struct Outcome {
    RowEnd end = RowEnd::made;
    FleetVerdict verdict = FleetVerdict::none;  // made or stood
    std::optional<SetAside> refusal = {};       // set aside
    std::optional<Verdict> judged = {};         // made
  };
  // `name`: of its files in the folder, without ending. Actions and `explain_unknown` are those of the judging. Throws
  // only where a result cannot be written.
  Outcome judge(const std::string& log, const std::string& name, DiagnoseOptions options);
  bool pages = false;  // a page a log beside its result; a result without it does not stand
  // The header of a judged log's result.
  const report::Header& header() const { return header_; }

 private:
  void begin(const std::string& log);
  void complete_header(const Verdict& verdict);
  bool stands(const std::string& name, Outcome& outcome) const;
  void write_page(const std::string& name, const Verdict& verdict, const Log& log) const;
  Outcome set_aside(const std::string& log, const std::string& name, const InputError& error);

  const Judging& judging_;
  report::Header of_call_, header_;
  ResultFolder folder_;
};

// Counts an outcome; says which log was set aside, and adds a judged one's simulations to the call's.
void add(FleetRun& run, const FleetJudge::Outcome& outcome, Progress& progress, report::Header& of_call,
         const report::Header& of_log);
// Of the whole run; 10 and 11 only where asked for.
int code_of(const FleetRun& run, bool exit_code);

}  // namespace servodx
