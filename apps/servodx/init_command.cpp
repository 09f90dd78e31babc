// `servodx init LOG`: a commented rig file and a parameter table to begin with, from a log's header.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/sha256.h"
#include "base/trouble.h"
#include "base/units.h"
#include "commands.h"
#include "diagnose/check_log.h"
#include "invocation.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "shipped.h"
#include "signals/column_questions.h"
#include "signals/guess.h"
#include "signals/header.h"
#include "signals/log_formats.h"
#include "signals/mat_file.h"
#include "signals/time_stamp.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, output = "rig.toml", table = "params.csv";
};

struct Header {
  std::vector<ColumnGuess> columns;
  std::vector<ColumnNumbers> numbers;
  std::vector<std::string> spans;  // "0 to 250", as written
};

// The numbers of a CSV log's columns; date-time stamps as such.
std::vector<ColumnNumbers> numbers_of_rows(CsvCursor& csv, bool in_row) {
  std::vector<NumbersCollector> collectors(csv.header().size());
  std::vector<bool> stamps(collectors.size(), false);
  for (; in_row; in_row = csv.next_row())
    for (std::size_t c = 0; c < collectors.size(); ++c) {
      double value = 0;
      const Cell kind = csv.next_number(value);
      if (kind == Cell::none) break;
      if (kind == Cell::text && !stamps[c]) stamps[c] = parse_time_stamp(csv.last_text()).has_value();
      collectors[c].take(kind == Cell::number ? value : std::nan(""));
    }
  std::vector<ColumnNumbers> numbers;
  for (std::size_t c = 0; c < collectors.size(); ++c) {
    numbers.push_back(collectors[c].numbers());
    numbers.back().stamps = stamps[c] && numbers.back().count == 0;
  }
  return numbers;
}

Header read_csv_header(const std::string& path) {
  const std::string bytes = read_file(path);
  CsvCursor csv(bytes, path);
  pass_lines_above_header(csv, path);
  require_names(csv, path);
  bool in_row = csv.next_row();
  const std::vector<std::string> units = in_row ? units_row(csv) : std::vector<std::string>{};
  if (!units.empty()) in_row = csv.next_row();
  return {guess_columns(csv.header(), units), numbers_of_rows(csv, in_row), {}};
}

// A MAT file's vectors of the commonest length, which are its signals.
Header read_mat_header(const std::string& path) {
  std::vector<MatVariable> variables = read_mat_variables(path);
  std::map<std::size_t, std::size_t> lengths;
  for (const MatVariable& v : variables)
    if (v.fault.empty() && v.numbers.size() > 1) ++lengths[v.numbers.size()];
  const auto commonest = std::max_element(lengths.begin(), lengths.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
  if (commonest == lengths.end())
    throw InputError({path, 0, ""}, "holds no vectors of numbers",
                     "save each signal as a vector, or a matrix with a list of its columns' names");
  std::erase_if(variables,
                [&](const MatVariable& v) { return !v.fault.empty() || v.numbers.size() != commonest->first; });
  std::vector<std::string> names;
  Header header;
  for (const MatVariable& v : variables) {
    names.push_back(v.name);
    NumbersCollector collector;
    for (const double x : v.numbers) collector.take(x);
    header.numbers.push_back(collector.numbers());
  }
  header.columns = guess_columns(names);
  for (ColumnGuess& g : header.columns) {
    g.unit_in_brackets = false;                  // a variable has no unit
    if (g.unit.empty()) g.written_unit.clear();  // nor is the index in "run(:,2)" one
  }
  return header;
}

Header read_header(const std::string& path) {
  Header header = is_mat_file(path) ? read_mat_header(path) : read_csv_header(path);
  for (const ColumnNumbers& n : header.numbers)
    header.spans.push_back(n.stamps      ? "time stamps"
                           : n.count > 0 ? report::digits(n.low, 4) + " to " + report::digits(n.high, 4)
                                         : "no numbers");
  ask_by_numbers(header.columns, header.numbers);
  for (ColumnGuess& g : header.columns) {
    const auto same = std::count_if(header.columns.begin(), header.columns.end(),
                                    [&](const ColumnGuess& other) { return other.cell == g.cell; });
    if (g.signal && same > 1) g.ask(fmt::format("the name stands over {} columns: give each its own", same));
  }
  return header;
}

std::string toml_quoted(const std::string& text) {
  std::string safe = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') safe += '\\';
    // TOML wants these by their number.
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7F)
      safe += fmt::format("\\u{:04X}", byte);
    else
      safe += c;
  }
  return safe + "\"";
}

bool is_in_volts(const ColumnGuess& g) {
  const Unit* unit = find_unit(g.unit);
  return unit && unit->dimension == Dimension::voltage;
}

// "pA" = { signal = "pressure_a", unit = "bar" }
std::string mapping_of(const ColumnGuess& g) {
  std::string text = fmt::format("{} = {{ signal = \"{}\"", toml_quoted(g.cell), info(*g.signal).name);
  if (!g.unit_in_brackets || is_in_volts(g)) text += fmt::format(", unit = \"{}\"", g.unit.empty() ? "?" : g.unit);
  if (!g.gain.empty()) text += fmt::format(", gain = \"{}\"", g.gain);
  if (!g.offset.empty()) text += fmt::format(", offset = \"{}\"", g.offset);
  return text + " }";
}

// The reader takes the column by its own name and unit.
bool is_read_as_it_is(const ColumnGuess& g) { return g.canonical && g.unit_in_brackets && !is_in_volts(g); }

// The [columns] line of one column; a comment where nothing need or can be said, or something is to be asked.
std::string column_line(const ColumnGuess& g, const std::string& span) {
  if (!g.signal)
    return fmt::format("# {} = {{ signal = \"?\", unit = \"?\" }}  # not recognised: {}; ignored as it is\n",
                       toml_quoted(g.cell), span);
  std::string note = "  # " + span;
  if (!g.question.empty()) note = "  # ? " + span + ": " + g.question;
  if (g.by_numbers) note += "; no unit in the header: taken by the values";
  note += "\n";
  if (is_read_as_it_is(g) && g.offset.empty()) return fmt::format("# {} is read as it is{}", toml_quoted(g.cell), note);
  // Volts stay active: the reader refuses them until the gain is given.
  return (g.question.empty() || is_in_volts(g) ? "" : "# ") + mapping_of(g) + note;
}

std::string rig_file(const std::string& log, const Header& header) {
  std::string text = "# Rig file, begun by 'servodx init' from " + toml_quoted(log) + ".\n" +
                     std::string(shipped::rig_comments) + "\n[columns]\n";
  text +=
      "# The log's columns. gain = \"-1\" turns a sign: positive command, spool and piston go together; "
      "'servodx list signals' says\n# what each signal is, and which way is positive. Lines with '# ?' are questions: "
      "where the line is right as it\n# stands, take away its first '#'.\n";
  for (std::size_t c = 0; c < header.columns.size(); ++c) text += column_line(header.columns[c], header.spans[c]);
  return text;
}

// Reads the log as if all questions were answered with yes, and asks of the channels what they do to one another.
void ask_by_behaviour(const std::string& log, Header& header) {
  std::string text = "[columns]\n";
  for (const ColumnGuess& g : header.columns) {
    const Unit* unit = find_unit(g.unit);
    if (!g.signal || !unit || is_in_volts(g) || is_read_as_it_is(g)) continue;
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

// How the log reads with the rig file, for the screen.
std::string reading(const Options& options, std::size_t questions) {
  std::string text;
  try {
    const Log log = read_log(options.log, read_rig_file(options.output));
    text = fmt::format("{}: {} samples\n",
                       questions ? "without the columns asked about the log can be read" : "the log reads with it",
                       log.samples());
    for (const Note& note : log.notes)
      if (note.kind != Note::Kind::ignored_columns)
        text += "  beware: " + note.text + "\n";  // the ignored are told below
  } catch (const InputError& open) {
    text = fmt::format("to be mended in {} before the log reads:\n  {}\n", options.output, told(open));
  }
  return text;
}

// Western letters in a row are another alphabet's bytes.
bool is_of_another_alphabet(const std::string& cell) {
  int run = 0;
  for (std::size_t k = 0; k + 1 < cell.size(); ++k) {
    const auto u = static_cast<unsigned char>(cell[k]);
    if (u == 0xC2 || u == 0xC3) {
      if (++run >= 4) return true;
      ++k;
    } else {
      run = 0;
    }
  }
  return false;
}

// What the header does not say.
std::string open_ends(const Options& options, const Header& header) {
  std::vector<std::string> unknown, by_numbers;
  std::string questions;
  bool foreign_letters = false, has_time = false;
  std::string counter;
  std::size_t open = 0;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const ColumnGuess& g = header.columns[c];
    foreign_letters = foreign_letters || is_of_another_alphabet(g.cell);
    has_time = has_time || g.signal == Signal::time;
    if (!g.signal && header.numbers[c].counts && counter.empty()) counter = g.cell;
    if (!g.signal) unknown.push_back("'" + g.cell + "'");
    if (g.by_numbers) by_numbers.push_back("'" + g.cell + "' in " + g.unit);
    if (g.question.empty()) continue;
    ++open;
    questions += fmt::format("  '{}', {} {}: {}\n", g.cell, is_read_as_it_is(g) ? "read as" : "taken for",
                             info(*g.signal).name, g.question);
  }
  std::string text;
  if (open > 0)
    text +=
        fmt::format("{} question{} open, each a line with '# ?' in {}; until it is answered a column is no signal:\n{}",
                    open, open == 1 ? " is" : "s are", options.output, questions);
  text += reading(options, open);
  if (!by_numbers.empty())
    text += fmt::format("no unit in the header, taken by the values: {}\n", report::join(by_numbers));
  if (!has_time && !counter.empty())
    text += fmt::format(
        "'{}' counts rows: {} = {{ signal = \"time\", unit = \"s\", gain = \"...\" }} with the time of a "
        "row as its gain makes it the time\n",
        counter, toml_quoted(counter));
  if (foreign_letters)
    text += "the header is neither UTF-8 nor of a Western alphabet: save the log as UTF-8, and its names can be read\n";
  if (header.columns.size() == 1)
    text +=
        "its first row has one cell only: where the header stands farther down, begin the lines before it with '#'\n";
  if (!unknown.empty())
    text += fmt::format("not recognised, so ignored: {}; 'servodx list signals' has the names for {}\n",
                        report::join(unknown), options.output);
  return text;
}

void run(const Options& options) {
  Invocation invocation("init", options.common);
  require_option(options.common.rig.empty(), "--rig", "is what this command writes", "leave it out");
  invocation.check_files({options.log}, {options.output, options.table});
  for (const std::string& output : {options.output, options.table})
    require_option(!std::filesystem::exists(output), output, "is there already, and may hold your work",
                   "name another file or remove it");
  // Header, fingerprint and trial reading each read it from the beginning.
  std::error_code none;
  if (const auto status = std::filesystem::status(options.log, none);
      std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError({options.log, 0, ""}, "is no file, and can be read but once", "write the log to a file first");
  Header header = read_header(options.log);
  ask_by_behaviour(options.log, header);
  invocation.header().inputs.push_back({options.log, sha256_of_file(options.log)});
  if (invocation.dry_run()) return;
  write_file(options.output, rig_file(options.log, header));
  write_file(options.table, shipped::table);

  report::Columns table("llll", 2);
  table.row({"column", "taken for", "unit", "values"});
  report::Json columns = report::Json::array();
  std::size_t questions = 0;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const ColumnGuess& g = header.columns[c];
    const std::string signal = g.signal ? std::string(info(*g.signal).name) : "";
    const bool open = !g.question.empty();
    questions += open;
    table.row({g.cell, g.signal ? signal + (open ? " ?" : "") : "not recognised",
               g.unit.empty() ? g.written_unit : g.unit, header.spans[c]});
    columns.push_back({{"column", g.cell},
                       {"signal", g.signal ? report::Json(signal) : report::Json(nullptr)},
                       {"unit", g.unit},
                       {"question", open ? report::Json(g.question) : report::Json(nullptr)}});
  }
  std::string text = fmt::format("wrote {} and {}\n{}", options.output, options.table, table.text());
  text += open_ends(options, header);
  text += fmt::format("next: fill in the data sheet in {}, then 'servodx check-log {} --rig {}'\n", options.output,
                      options.log, options.output);
  invocation.finish(
      text, {{"rig", options.output}, {"table", options.table}, {"columns", columns}, {"questions", questions}});
}

}  // namespace

void add_init_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("init", "A commented rig file and a parameter table to begin with, from a log's header");
  command->add_option("LOG", options->log, "a rig log with your own column names, CSV or MAT")->required();
  command->add_option("-o,--output", options->output, "the rig file")->type_name("RIG.toml")->capture_default_str();
  command->add_option("--table", options->table, "the parameter table")->type_name("PARAMS.csv")->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
