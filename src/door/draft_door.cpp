// The front door of `init`.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "base/toml_quoted.h"
#include "base/units.h"
#include "report/shared/handy.h"
#include "servodx/check_log.h"
#include "servodx/draft.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/column_questions.h"
#include "signals/guess.h"
#include "signals/log_header.h"
#include "signals/rig_keys.h"
#include "signals/signal.h"

namespace servodx {
namespace {

bool is_in_volts(const ColumnGuess& g) {
  const Unit* unit = find_unit(g.unit);
  return unit && unit->dimension == Dimension::voltage;
}

// "pA" = { signal = "pressure_a", unit = "bar" }
std::string mapping_of(const ColumnGuess& g) {
  std::string text = fmt::format("{} = {{ signal = \"{}\"", toml_quoted(g.cell), info(*g.signal).name);
  if (!g.unit_in_brackets || is_in_volts(g)) text += fmt::format(", unit = \"{}\"", g.unit.empty() ? "?" : g.unit);
  if (g.gain_is_open || !g.gain.empty()) text += fmt::format(", gain = \"{}\"", g.gain_is_open ? "?" : g.gain);
  if (g.has_offset()) text += fmt::format(", offset = \"{}\"", g.offset_is_open ? "?" : g.offset);
  return text + " }";
}

// The reader takes the column by its own name and unit.
bool is_read_as_it_is(const ColumnGuess& g) {
  return g.canonical && g.unit_in_brackets && g.gain.empty() && !is_in_volts(g);
}

// The [columns] line of one column; a comment where nothing need or can be said, or something is to be asked.
std::string column_line(const ColumnGuess& g, const std::string& span) {
  if (!g.signal)
    return fmt::format("# {} = {{ signal = \"?\", unit = \"{}\" }}  # not recognised: {}; ignored as it is\n",
                       toml_quoted(g.cell), g.unit.empty() ? "?" : g.unit, span);
  std::string note = "  # " + span;
  if (!g.question.empty()) note = std::string(asks_of_column) + span + ": " + g.question;
  if (g.by_numbers) note += "; no unit in the header: taken by the values";
  note += "\n";
  if (is_read_as_it_is(g) && !g.has_offset()) return fmt::format("# {} is read as it is{}", toml_quoted(g.cell), note);
  // Volts stay active: the reader refuses them until the gain is given.
  return (g.question.empty() || is_in_volts(g) ? "" : "# ") + mapping_of(g) + note;
}

// Reads the log as if all questions were answered with yes, and asks of the channels what they do to one another.
void ask_by_behaviour(const std::string& log, LogHeader& header) {
  std::string text = "[columns]\n";
  for (ColumnGuess g : header.columns) {
    const Unit* unit = find_unit(g.unit);
    g.offset_is_open = false;  // which channels go together does not hang on it
    if (!g.signal || !unit || is_in_volts(g) || g.gain_is_open || is_read_as_it_is(g)) continue;
    if (unit->dimension == Dimension::percent_of_rated || unit->dimension == Dimension::percent_of_stroke) continue;
    text += mapping_of(g) + "\n";
  }
  try {
    const RigFile rig = make_rig("guess.toml", text);
    for (const Finding& found : survey(read_log(log, rig), rig).findings)
      for (ColumnGuess& g : header.columns)
        if (std::count(found.signals.begin(), found.signals.end(), g.signal) > 0) g.ask(found.text);
  } catch (const InputError&) {  // what keeps the log from being read is told of the rig file itself
  }
}

std::string span_of(const ColumnNumbers& n) {
  if (n.stamps) return "time stamps";
  return n.count > 0 ? report::digits(n.low, 4) + " to " + report::digits(n.high, 4) : "no numbers";
}

}  // namespace

std::vector<ColumnDraft> draft_columns(const std::string& log) {
  LogHeader header = read_log_header(log);
  ask_by_behaviour(log, header);
  std::vector<ColumnDraft> out;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const ColumnGuess& g = header.columns[c];
    const std::string span = span_of(header.numbers[c]);
    out.push_back({.column = g.cell,
                   .signal = g.signal,
                   .unit = g.by_numbers && !g.gain.empty() ? g.gain + " " + g.unit : g.unit,
                   .written_unit = g.written_unit,
                   .values = span,
                   .question = g.question,
                   .line = column_line(g, span),
                   .read_as_it_is = is_read_as_it_is(g),
                   .by_numbers = g.by_numbers,
                   .counts = header.numbers[c].counts});
  }
  return out;
}

}  // namespace servodx
