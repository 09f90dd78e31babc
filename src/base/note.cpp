#include "servodx/note.h"

#include <cstddef>
#include <iterator>

namespace servodx {

std::string_view name_of(Note::Kind kind) {
  constexpr std::string_view names[] = {
      "left_out",    "preamble",         "ignored_columns",  "unmapped_column", "gaps",
      "implausible", "unguarded",        "resampled",        "test_stand",      "no_supply",
      "oil",         "no_spool",         "redundant_signal", "unlearnt_signal", "earlier_version",
      "poor_tune",   "no_baseline",      "no_causes",        "no_log",          "other_rig",
      "own_log",     "lacking_channels", "interrupted",      "search_end",      "derivatives",
      "profile",     "command_slope",    "told_by_blocks",   "cavitation",      "one_way_sweep",
      "fast_sweep",  "unjudged_limit",   "no_preflight",     "no_response",     "against_command",
      "uncorrected", "few_checks",       "other_table",      "failure_level",   "blind"};
  static_assert(std::size(names) == n_note_kinds);
  return names[static_cast<std::size_t>(kind)];
}

std::vector<std::string> texts_of(const std::vector<Note>& notes) {
  std::vector<std::string> texts;
  for (const Note& note : notes) texts.push_back(note.text);
  return texts;
}

}  // namespace servodx
