// `servodx help`, `servodx completion SHELL` and `servodx man`: made from what the commands say of themselves, as
// --help is. The examples are given to the commands here.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "base/error.h"
#include "base/nearest.h"
#include "commands.h"
#include "examples.h"
#include "invocation.h"
#include "report/list/trouble_words.h"

namespace servodx {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

// "--json", "-o": as typed.
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : between) + word;
  return all;
}

// What help shows; a kept name that is refused has no group.
std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

// With those of its own commands, as `history` has some.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> all;
  const auto add = [&](std::string name) {
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(std::move(name));
  };
  for (const CLI::Option* option : options_of(command))
    for (const std::string& name : names_of(*option)) add(name);
  for (const CLI::App* part : commands_of(command))
    for (const std::string& name : option_names(*part)) add(name);
  return all;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
  return names;
}

// What may follow a command: its own commands; after `help`, the program's.
std::string part_names(const CLI::App& command) {
  return joined(command_names(command.get_name() == "help" ? *command.get_parent() : command), " ");
}

// "Example: servodx watch ..." and further ones below it; empty where the list has none.
std::string examples_of(const std::string& command) {
  std::string text;
  for (const Example& example : examples)
    if (example.call.starts_with("servodx " + command + " "))
      text += (text.empty() ? "Example: " : "\n         ") + std::string(example.call);
  return text;
}

void give_examples(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    if (const std::string given = examples_of(command->get_name()); !given.empty())
      command->footer(command->get_footer().empty() ? given : command->get_footer() + "\n" + given);
}

std::string bash(const CLI::App& app) {
  std::string cases;
  for (const CLI::App* command : commands_of(app)) {
    const std::string parts = part_names(*command);
    cases += fmt::format("    {}) options=\"{}\"{} ;;\n", command->get_name(), joined(option_names(*command), " "),
                         parts.empty() ? "" : " parts=\"" + parts + "\"");
  }
  return fmt::format(R"(# bash completion of servodx; from 'servodx completion bash'
_servodx() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} options="" parts=""
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "{} --help --version" -- "$word")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif ((COMP_CWORD == 2)) && [[ $parts ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$parts" -- "$word")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}}
complete -F _servodx servodx
)",
                     joined(command_names(app), " "), cases);
}

// A text between single quotes, for fish and zsh.
std::string single_quoted(std::string text) {
  std::string safe;
  for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + safe + "'";
}

// The options of a command, where `seen` are the words before; then its own commands.
std::string fish_options(const CLI::App& command, const std::string& seen) {
  std::string text;
  for (const CLI::App* part : commands_of(command)) {
    text += fmt::format("complete -c servodx -n '{}; and not __fish_seen_subcommand_from {}' -f -a {} -d {}\n", seen,
                        part_names(command), part->get_name(), single_quoted(part->get_description()));
    text += fish_options(*part, seen + "; and __fish_seen_subcommand_from " + part->get_name());
  }
  if (!text.empty()) return text;
  for (const CLI::Option* option : options_of(command)) {
    if (option->get_positional()) continue;
    text += fmt::format("complete -c servodx -n '{}'", seen);
    for (const std::string& name : option->get_snames()) text += " -s " + name;
    for (const std::string& name : option->get_lnames()) text += " -l " + name;
    text += (option->get_expected_max() > 0 ? " -r -d " : " -d ") + single_quoted(option->get_description()) + "\n";
  }
  return text;
}

std::string fish(const CLI::App& app) {
  std::string text = "# fish completion of servodx; from 'servodx completion fish'\n";
  for (const CLI::App* command : commands_of(app))
    text += fmt::format("complete -c servodx -n __fish_use_subcommand -f -a {} -d {}\n", command->get_name(),
                        single_quoted(command->get_description())) +
            fish_options(*command, "__fish_seen_subcommand_from " + command->get_name());
  return text;
}

std::string zsh(const CLI::App& app) {
  std::string names, cases, parts;
  for (const CLI::App* command : commands_of(app)) {
    names += fmt::format("    {}\n", single_quoted(command->get_name() + ":" + command->get_description()));
    cases += fmt::format("    {}) compadd -- {} ;;\n", command->get_name(), joined(option_names(*command), " "));
    if (const std::string those = part_names(*command); !those.empty())
      parts += fmt::format("  elif ((CURRENT == 3)) && [[ $words[2] == {} ]]; then\n    compadd -- {}\n",
                           command->get_name(), those);
  }
  return fmt::format(R"(#compdef servodx
# zsh completion of servodx; from 'servodx completion zsh'
_servodx() {{
  local -a commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe command commands
  elif [[ $words[CURRENT] == -* ]]; then
    case $words[2] in
{}    esac
{}  else
    _files
  fi
}}
_servodx "$@"
)",
                     names, cases, parts);
}

// Text for roff: no line may begin with a dot, and a hyphen must stay one.
std::string roff(const std::string& text) {
  std::string safe;
  bool at_start = true;
  for (const char c : text) {
    if (at_start && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else {
      safe += c;
    }
    at_start = c == '\n';
  }
  return safe;
}

std::string man_option(const CLI::Option& option) {
  std::string head;
  if (option.get_positional()) {
    head = "\\fI" + roff(option.get_name(true)) + "\\fR" + (option.get_expected_max() > 1 ? " ..." : "");
  } else {
    std::vector<std::string> names;
    for (const std::string& name : names_of(option)) names.push_back("\\fB" + roff(name) + "\\fR");
    head = joined(names, ", ");
    if (option.get_expected_max() > 0) head += " \\fI" + roff(option.get_type_name()) + "\\fR";
  }
  std::string tail = option.get_required() ? " Required." : "";
  if (!option.get_default_str().empty()) tail += " Default: " + option.get_default_str() + ".";
  return fmt::format(".TP\n{}\n{}.{}\n", head, roff(option.get_description()), roff(tail));
}

bool is_common(const CLI::Option& option) { return option.get_group() == "Common"; }

// One command; the options that all share have a section of their own.
void add_man(std::string& text, const CLI::App& command, const std::string& called) {
  text += fmt::format(".SS {}\n{}.\n", roff(called), roff(command.get_description()));
  for (const CLI::Option* option : options_of(command))
    if (!is_common(*option) && option->get_name(false, true).find("--help") == std::string::npos)
      text += man_option(*option);
  if (!command.get_footer().empty()) text += ".PP\n.nf\n" + roff(command.get_footer()) + "\n.fi\n";
}

std::string man_common() {
  CLI::App command;
  CommonOptions options;
  add_common_options(command, options);
  std::string text;
  for (const CLI::Option* option : options_of(command))
    if (is_common(*option)) text += man_option(*option);
  return text;
}

std::string man(const CLI::App& app) {
  std::string text = fmt::format(".TH SERVODX 1 \"\" \"servodx {}\" \"User Commands\"\n", SERVODX_VERSION);
  text += ".SH NAME\nservodx \\- " + roff(app.get_description()) +
          "\n.SH SYNOPSIS\n.B servodx\n\\fICOMMAND\\fR [\\fIOPTION\\fR ...]\n";
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) {
    add_man(text, *command, command->get_name());
    for (const CLI::App* part : commands_of(*command))
      add_man(text, *part, command->get_name() + " " + part->get_name());
  }
  text += ".SH COMMON OPTIONS\n" + man_common();
  text += ".SH EXAMPLES\n";
  for (const Example& example : examples)
    text += fmt::format(".PP\n{}:\n.nf\n.RS\n{}\n.RE\n.fi\n", roff(std::string(example.purpose)),
                        roff(std::string(example.call)));
  text +=
      ".SH EXIT STATUS\n.TP\n0\nit ran, whatever the verdict\n.TP\n1\nit failed inside\n.TP\n2\nthe call or an input "
      "was "
      "refused; nothing is written\n.TP\n3\nof many inputs some were set aside with the reason, the others are "
      "done\n.TP\n10, 11\nwith \\fBdiagnose \\-\\-exit\\-code\\fR: a fault; "
      "unknown\n.TP\n130\ninterrupted; "
      "the best so far is written\n.TP\n143\nthe same, by SIGTERM\n";
  return text;
}

// The command that `words` lead to, as in "history event".
const CLI::App& command_at(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* at = &app;
  for (const std::string& word : words) {
    const auto commands = commands_of(*at);
    const auto found = std::find_if(commands.begin(), commands.end(),
                                    [&](const CLI::App* command) { return command->get_name() == word; });
    if (found == commands.end()) {
      const auto near = near_words(word, command_names(*at));
      throw InputError({}, "no command is called '" + word + "'",
                       (near.empty() ? "" : "did you mean '" + joined(near, "' or '") + "'? ") +
                           "'servodx help' lists what there is");
    }
    at = *found;
  }
  return *at;
}

// The section of docs/errors.md that a code stands for; of `errors` the codes; of all else nothing.
std::string help_of_code(const std::vector<std::string>& words) {
  if (words.size() != 1) return "";
  if (words[0] == "errors") return report::table_of_troubles();
  if (const auto trouble = report::trouble_called(words[0])) return report::section_of(*trouble);
  if (report::looks_like_code(words[0]))
    throw InputError({}, "no refusal and no warning has the code '" + words[0] + "'",
                     "there are " + report::codes_of_troubles() + "; 'servodx help errors' says what they mean");
  return "";
}

// As --help prints it. The app's own help() would be that of the command `help`, which was called.
std::string help(const CLI::App& app, const std::vector<std::string>& words) {
  if (const std::string told = help_of_code(words); !told.empty()) return told;
  const CLI::App& command = command_at(app, words);
  const std::string called = words.empty() ? app.get_name() : app.get_name() + " " + joined(words, " ");
  return command.get_formatter()->make_help(&command, called, CLI::AppFormatMode::Normal);
}

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

}  // namespace

void add_manual_commands(CLI::App& app) {
  give_examples(app);
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* helped =
      app.add_subcommand("help", "What there is, the help of a command, or what a code such as E02 means");
  helped->add_option("COMMAND", *words,
                     "a command, and its own one where it has some; or a code such as E02, or errors");
  helped->callback([words, &app] { print(help(app, *words)); });
  auto shell = std::make_shared<std::string>();
  CLI::App* completion = app.add_subcommand("completion", "Print a completion script: bash, zsh or fish");
  completion->add_option("SHELL", *shell, "bash, zsh or fish")->required();
  completion->callback([shell, &app] {
    if (*shell == "bash") return print(bash(app));
    if (*shell == "zsh") return print(zsh(app));
    if (*shell == "fish") return print(fish(app));
    throw InputError({}, "there is no completion for '" + *shell + "'", "use bash, zsh or fish");
  });
  app.add_subcommand("man", "Print the manual page (roff)")->callback([&app] { print(man(app)); });
}

}  // namespace servodx
