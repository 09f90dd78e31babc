// `servodx init LOG`: a commented rig file and a parameter table to begin with, from a log's header.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/sha256.h"
#include "base/units.h"
#include "commands.h"
#include "invocation.h"
#include "report/columns.h"
#include "report/handy.h"
#include "report/json.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "shipped.h"
#include "signals/guess.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, output = "rig.toml", table = "params.csv";
};

struct Header {
  std::vector<ColumnGuess> columns;
  std::vector<std::string> spans;  // "0 to 250", as written; empty where no number was seen
};

Header read_header(const std::string& path) {
  const std::string bytes = read_file(path);
  CsvCursor csv(bytes, path);
  pass_lines_above_header(csv);
  bool in_row = csv.next_row();
  const std::vector<std::string> units = in_row ? units_row(csv) : std::vector<std::string>{};
  Header header{guess_columns(csv.header(), units), {}};
  std::vector<double> low(csv.header().size(), HUGE_VAL), high(csv.header().size(), -HUGE_VAL);
  for (; in_row; in_row = csv.next_row())
    for (std::size_t c = 0; c < low.size(); ++c) {
      double value = 0;
      if (csv.next_number(value) == Cell::number) low[c] = std::min(low[c], value), high[c] = std::max(high[c], value);
    }
  for (std::size_t c = 0; c < low.size(); ++c)
    header.spans.push_back(low[c] <= high[c] ? report::digits(low[c], 4) + " to " + report::digits(high[c], 4)
                                             : "no numbers");
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

// The [columns] line of one column; a comment where nothing need or can be said.
std::string column_line(const ColumnGuess& g, const std::string& span) {
  const std::string note = "  # " + span + "\n";
  if (!g.signal)
    return fmt::format("# {} = {{ signal = \"?\", unit = \"?\" }}  # not recognised: {}; ignored as it is\n",
                       toml_quoted(g.cell), span);
  const std::string signal(info(*g.signal).name);
  if (g.canonical && g.unit_in_brackets) return fmt::format("# {} is read as it is{}", toml_quoted(g.cell), note);
  const Unit* unit = find_unit(g.unit);
  const bool volts = unit && unit->dimension == Dimension::voltage;
  if (volts)
    return fmt::format(
        "{} = {{ signal = \"{}\", unit = \"{}\", gain = \"1 {}/V\", offset = \"0 {}\" }}  # {}; give the sensor's "
        "gain\n",
        toml_quoted(g.cell), signal, g.unit, info(*g.signal).si_unit, info(*g.signal).si_unit, span);
  if (g.unit_in_brackets) return fmt::format("{} = {{ signal = \"{}\" }}{}", toml_quoted(g.cell), signal, note);
  if (g.unit.empty())
    return fmt::format("{} = {{ signal = \"{}\", unit = \"{}\" }}  # {}; the header has no unit: check this one\n",
                       toml_quoted(g.cell), signal, info(*g.signal).si_unit, span);
  return fmt::format("{} = {{ signal = \"{}\", unit = \"{}\" }}{}", toml_quoted(g.cell), signal, g.unit, note);
}

std::string rig_file(const std::string& log, const Header& header) {
  std::string text = "# Rig file, begun by 'servodx init' from " + toml_quoted(log) + ".\n" +
                     std::string(shipped::rig_comments) + "\n[columns]\n";
  text +=
      "# The log's columns. gain = \"-1\" turns a sign: positive command, spool and piston go together; "
      "'servodx list signals' says\n# what each signal is, and which way is positive.\n";
  for (std::size_t c = 0; c < header.columns.size(); ++c) text += column_line(header.columns[c], header.spans[c]);
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
  const Header header = read_header(options.log);
  invocation.header().inputs.push_back({options.log, sha256_of_file(options.log)});
  if (invocation.dry_run()) return;
  write_file(options.output, rig_file(options.log, header));
  write_file(options.table, shipped::table);

  report::Columns table("llll", 2);
  table.row({"column", "taken for", "unit", "values"});
  report::Json columns = report::Json::array();
  std::vector<std::string> unknown, without_unit;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const ColumnGuess& g = header.columns[c];
    const std::string signal = g.signal ? std::string(info(*g.signal).name) : "";
    if (!g.signal) unknown.push_back("'" + g.cell + "'");
    const bool guessed = g.signal && g.unit.empty();
    if (guessed) without_unit.push_back("'" + g.cell + "'");
    table.row({g.cell, g.signal ? signal : "not recognised",
               guessed ? std::string(info(*g.signal).si_unit) + "?" : g.unit, header.spans[c]});
    columns.push_back(
        {{"column", g.cell}, {"signal", g.signal ? report::Json(signal) : report::Json(nullptr)}, {"unit", g.unit}});
  }
  std::string text = fmt::format("wrote {} and {}\n{}", options.output, options.table, table.text());
  try {
    const Log log = read_log(options.log, read_rig_file(options.output));
    text += fmt::format("the log reads with it: {} samples\n", log.samples());
    for (const std::string& note : log.notes)
      if (note.find(": ignored ") == std::string::npos)
        text += "  beware: " + note + "\n";  // the ignored are told below
  } catch (const InputError& open) {
    text += fmt::format("to be mended in {} before the log reads:\n  {}\n", options.output, open.what());
  }
  if (!without_unit.empty())
    text += fmt::format("the header has no unit for {}: SI was taken; give the right one in {}\n",
                        report::join(without_unit), options.output);
  if (header.columns.size() == 1)
    text +=
        "its first row has one cell only: where the header stands farther down, begin the lines before it with '#'\n";
  if (!unknown.empty())
    text += fmt::format("not recognised, so ignored: {}; 'servodx list signals' has the names for {}\n",
                        report::join(unknown), options.output);
  text += fmt::format("next: fill in the data sheet in {}, then 'servodx check-log {} --rig {}'\n", options.output,
                      options.log, options.output);
  invocation.finish(text, {{"rig", options.output}, {"table", options.table}, {"columns", columns}});
}

}  // namespace

void add_init_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("init", "A commented rig file and a parameter table to begin with, from a log's header");
  command->add_option("LOG", options->log, "a rig log with your own column names, CSV")->required();
  command->add_option("-o,--output", options->output, "the rig file")->type_name("RIG.toml")->capture_default_str();
  command->add_option("--table", options->table, "the parameter table")->type_name("PARAMS.csv")->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
