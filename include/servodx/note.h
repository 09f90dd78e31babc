// Notes: what a result has to say beside its figures.
//
// A program acts on a note's kind, people read its text; no code decides by the text. One list of kinds for all
// results, as a log's notes are also those of what is made of it.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace servodx {

struct Note {
  enum class Kind {
    // A log, as it was read.
    left_out,         // rows, samples or a last line that do not count
    preamble,         // of the recorder, above the header
    ignored_columns,  // of no known name
    unmapped_column,  // the rig file maps it, and the log lacks it
    gaps,             // in time
    implausible,      // a value, or its course in time, that is hardly possible; of a history too
    unguarded,        // a MAT file was read without a filter of system calls
    // A log, as it was made ready.
    resampled,         // compared at points or means, fewer than the rows
    test_stand,        // taken as of a valve on a test stand
    no_supply,         // logged: the data sheet's drop stands for it
    oil,               // its temperature is not logged: what stands for it, taken or estimated
    no_spool,          // position logged: what cannot be told without
    redundant_signal,  // left out: it is an input, or another signal says it
    unlearnt_signal,   // left out: no tuning log held it
    // What was given to the call, and what was not.
    earlier_version,   // a file that an earlier version wrote
    poor_tune,         // the table's tune was not good enough: what follows is in doubt
    no_baseline,       // given: a finding rests on less
    no_causes,         // in the baseline: explain was not asked
    no_log,            // of the rig given: sensors and oil are assumed
    other_rig,         // file than the baseline's
    own_log,           // of the baseline, judged by it
    lacking_channels,  // that every log of the baseline holds
    interrupted,       // the result rests on a part of what was given
    // A tune.
    search_end,     // why the local search ended
    derivatives,    // were not to be trusted: the search went on without
    profile,        // of a row: an interval by refits beside that by curvature
    command_slope,  // whether the command holds between samples
    // An explanation, a planned test, an acceptance sheet.
    told_by_blocks,  // a cause that the simulation by itself does not follow better with
    cavitation,      // a chamber may fall to where oil cavitates
    one_way_sweep,   // of the command: no hysteresis
    fast_sweep,      // of the command: lag is in the hysteresis
    unjudged_limit,  // the log does not show its figure
    // Checks of a valve and their trend.
    no_preflight,     // test in the log: checks that rest on one are missing
    no_response,      // to the preflight step
    against_command,  // the spool moved so: is its sign right?
    uncorrected,      // to the reference state: the model's run failed
    few_checks,       // too few for a word on a trend
    other_table,      // checks that rest on one are left out
    failure_level,    // takes no hold, is passed already, or is not taken as it may be meant
    blind,            // a healthy check scatters beyond failure: only a trend can warn
  };
  Kind kind = {};
  std::string text;

  bool operator==(const Note&) const = default;
};
inline constexpr int n_note_kinds = static_cast<int>(Note::Kind::blind) + 1;

std::string_view name_of(Note::Kind kind);  // "left_out"
std::vector<std::string> texts_of(const std::vector<Note>& notes);

}  // namespace servodx
