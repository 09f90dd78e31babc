// The front door of `tune`: a table in memory gets the hash that its file will have, so that a baseline binds to it.
#include <memory>
#include <utility>

#include "base/atomic_file.h"
#include "base/sha256.h"
#include "door/require_samples.h"
#include "fit/tuned_state.h"
#include "parameters/table_text.h"
#include "report/tune/tune_words.h"
#include "servodx/check_log.h"
#include "servodx/checkpoint.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/trouble.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx {

namespace {

TuneOptions with_checkpoint(TuneOptions options) {
  if (!options.watch.checkpoint && !options.checkpoint.empty())
    options.watch.checkpoint =
        open_checkpoint(options.checkpoint, options.resume ? CheckpointUse::go_on : CheckpointUse::begin);
  return options;
}

// Columns that do what another's should, or the reverse of what theirs should. A fit takes them for a valve's.
std::vector<Note> mistaken_columns(const std::vector<Log>& logs, const Rig& rig) {
  std::vector<Note> out;
  for (const Log& log : logs)
    for (const Finding& found : survey(log, rig).findings)
      if (found.kind == FindingKind::swapped || found.kind == FindingKind::sign)
        out.push_back({Note::Kind::implausible, log.path + ": " + found.text + mark_of(Trouble::implausible)});
  return out;
}

}  // namespace

Tuned tune(const std::vector<Log>& logs, const Table& nominal, const Rig& rig, const TuneOptions& options) {
  options.validate();
  door::require_samples(logs, rig);
  auto result = std::make_shared<TuneResult>(tune_table(logs, nominal, rig, with_checkpoint(options)));
  Tuned out;
  out.table = result->table;
  out.table.path = "the table in memory";  // for messages
  out.table.sha256 = sha256(table_text(out.table));
  out.channels = result->channels;
  out.parameters = result->parameters;
  out.notes = report::notes_of(*result);
  for (Note& note : mistaken_columns(logs, rig)) out.notes.push_back(std::move(note));
  out.simulations = result->simulations, out.failed_simulations = result->failed_simulations;
  out.interrupted = result->interrupted;
  out.whole = std::move(result);
  return out;
}

Tuned read_tuned(const std::string& path) {
  Tuned out;
  out.table = read_table(path);
  if (!out.table.has_std_error)
    throw DocumentedError(Trouble::untuned, {path, 0, "std_error"}, "the table is not tuned: it has no such column",
                          "tune it with 'servodx tune LOG... --params " + path + " -o TUNED.csv' and give TUNED.csv");
  if (has_old_state(out.table))
    out.notes.push_back(
        {Note::Kind::earlier_version,
         path + ": a tuned table of an earlier version, which kept its model's error in comments; it is read "
                "as it is, and a new tune writes the new form"});
  if (const std::vector<Unfollowed> channels = tuned_state(out.table).unfollowed; !channels.empty())
    out.notes.push_back({Note::Kind::poor_tune, path + ": its tune was not good enough (" +
                                                    report::unfollowed_in_words(channels) +
                                                    "): what follows by this table is in doubt"});
  return out;
}

void write_tuned(const std::string& path, const Tuned& tuned) { write_table(path, tuned.table); }

}  // namespace servodx
