// `servodx init LOG`: a commented rig file and a parameter table to begin with, from a log's header.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/sha256.h"
#include "base/toml_quoted.h"
#include "base/trouble.h"
#include "commands.h"
#include "invocation.h"
#include "report/shared/columns.h"
#include "report/shared/json.h"
#include "servodx/draft.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "shipped.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, output = "rig.toml", table = "params.csv";
};

using Columns = std::vector<ColumnDraft>;

std::string rig_file(const std::string& log, const Columns& columns) {
  std::string text = "# Rig file, begun by 'servodx init' from " + toml_quoted(log) + ".\n" +
                     std::string(shipped::rig_comments) + "\n[columns]\n";
  text +=
      "# The log's columns. gain = \"-1\" turns a sign: positive command, spool and piston go together; "
      "'servodx list signals' says\n# what each signal is, and which way is positive. Lines with '# ?' are questions: "
      "where such a line begins with '#'\n# and is right, take that '#' away; where it has a \"?\" or lacks a gain, "
      "write what is asked for.\n";
  for (const ColumnDraft& c : columns) text += c.line;
  return text;
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
std::string open_ends(const Options& options, const Columns& columns) {
  std::vector<std::string> unknown, by_numbers;
  std::string questions;
  bool foreign_letters = false, has_time = false;
  std::string counter;
  std::size_t open = 0;
  for (const ColumnDraft& c : columns) {
    foreign_letters = foreign_letters || is_of_another_alphabet(c.column);
    has_time = has_time || c.signal == Signal::time;
    if (!c.signal && c.counts && counter.empty()) counter = c.column;
    if (!c.signal) unknown.push_back("'" + c.column + "'");
    if (c.by_numbers) by_numbers.push_back("'" + c.column + "' in " + c.unit);
    if (c.question.empty()) continue;
    ++open;
    questions += fmt::format("  '{}', {} {}: {}\n", c.column, c.read_as_it_is ? "read as" : "taken for",
                             name_of(*c.signal), c.question);
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
  if (columns.size() == 1)
    text +=
        "its first row has one cell only: where the header stands farther down, begin the lines before it with '#'\n";
  if (!unknown.empty())
    text += fmt::format("not recognised, so ignored: {}; 'servodx list signals' has the names for {}\n",
                        report::join(unknown), options.output);
  return text;
}

void run(const Options& options) {
  Invocation invocation("init", options.common);
  invocation.check_files({options.log}, {options.output, options.table});
  for (const std::string& output : {options.output, options.table})
    require_option(!std::filesystem::exists(output), output, "is there already, and may hold your work",
                   "name another file or remove it");
  // Header, fingerprint and trial reading each read it from the beginning.
  std::error_code none;
  if (const auto status = std::filesystem::status(options.log, none);
      std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError({options.log, 0, ""}, "is no file, and can be read but once", "write the log to a file first");
  const Columns columns = draft_columns(options.log);
  invocation.header().inputs.push_back({options.log, sha256_of_file(options.log)});
  if (invocation.dry_run()) return;
  write_file(options.output, rig_file(options.log, columns));
  write_file(options.table, shipped::table);

  report::Columns table("llll", 2);
  table.row({"column", "taken for", "unit", "values"});
  report::Json taken = report::Json::array();
  std::size_t questions = 0;
  for (const ColumnDraft& c : columns) {
    const std::string signal = c.signal ? std::string(name_of(*c.signal)) : "";
    const bool open = !c.question.empty();
    questions += open;
    table.row({c.column, c.signal ? signal + (open ? " ?" : "") : "not recognised",
               c.unit.empty() ? c.written_unit : c.unit, c.values});
    taken.push_back({{"column", c.column},
                     {"signal", c.signal ? report::Json(signal) : report::Json(nullptr)},
                     {"unit", c.unit},
                     {"question", open ? report::Json(c.question) : report::Json(nullptr)}});
  }
  std::string text = fmt::format("wrote {} and {}\n{}", options.output, options.table, table.text());
  text += open_ends(options, columns);
  text += fmt::format("next: fill in the data sheet in {}, then 'servodx check-log {} --rig {}'\n", options.output,
                      options.log, options.output);
  invocation.finish(text,
                    {{"rig", options.output}, {"table", options.table}, {"columns", taken}, {"questions", questions}});
}

}  // namespace

void add_init_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("init", "A commented rig file and a parameter table to begin with, from a log's header");
  command->add_option("LOG", options->log, "a rig log with your own column names, CSV or MAT")->required();
  command->add_option("-o,--output", options->output, "the rig file")->type_name("RIG.toml")->capture_default_str();
  command->add_option("--table", options->table, "the parameter table")->type_name("PARAMS.csv")->capture_default_str();
  add_common_options(*command, options->common, RigOption::left_out);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
